import { smoothstep } from 'three/tsl'
import type { CloudField } from '../../density/CloudField'
import type { Bool, Float } from '../../tsl-types'

/** Night of a place: the sun's own light reaches no cloud there, and the moon's is computed. */
export const isNight = ({ night }: CloudField, cosLight: Float): Bool =>
  night.isVisible.greaterThan(0).and(cosLight.lessThan(night.nightfall))

/** Share of moonlight and night sky that counts, from 0 where the sun has sunk to 1 a little later. */
export const nightShare = ({ night }: CloudField, cosLight: Float): Float =>
  smoothstep(night.deepNight, night.nightfall, cosLight).oneMinus()

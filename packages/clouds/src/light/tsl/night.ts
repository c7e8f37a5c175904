import { smoothstep } from 'three/tsl'
import type { CloudField } from '../../density/CloudField'
import type { Bool, Float } from '../../tsl-types'

/** Whether a place is lit by the moon: the sun's own light reaches no cloud there. */
export const isNight = ({ night }: CloudField, cosSun: Float): Bool =>
  night.isSeen.greaterThan(0).and(cosSun.lessThan(night.sunk))

/** How much of moonlight and night sky counts, from 0 where the sun has sunk to 1 a little later. */
export const nightShare = ({ night }: CloudField, cosSun: Float): Float =>
  smoothstep(night.dark, night.sunk, cosSun).oneMinus()

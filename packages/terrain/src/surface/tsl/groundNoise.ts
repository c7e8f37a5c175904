import { fractalSum } from '../../noise/tsl/fractalSum'
import type { Float, Vec3 } from '../../tsl-types'
import { BROAD, BROAD_PATCHES, CLIMATE, PATCHES } from '../cpu/surfaceNoise'

const finePatches = /*#__PURE__*/ fractalSum('welkinPatches', PATCHES)
const broadPatches = /*#__PURE__*/ fractalSum('welkinBroadPatches', BROAD_PATCHES)

/** Patches of one material and another, about 0; see `fractalSum` for parameters. */
export const patches = (reference: Vec3, offset: Vec3, shortest: Float, seed: Float): Float =>
  finePatches(reference, offset, shortest, seed).w.add(
    broadPatches(reference, offset, shortest, seed).w.mul(BROAD)
  )

/** Dry and wet country. */
export const climates = /*#__PURE__*/ fractalSum('welkinClimate', CLIMATE)

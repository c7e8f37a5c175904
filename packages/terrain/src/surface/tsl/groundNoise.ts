import { fractalSum } from '../../noise/tsl/fractalSum'
import { CLIMATE, PATCHES } from '../cpu/surfaceNoise'

/** Patches of one material and another; see `fractalSum` for parameters and result. */
export const patches = /*#__PURE__*/ fractalSum('welkinPatches', PATCHES)

/** Dry and wet country. */
export const climates = /*#__PURE__*/ fractalSum('welkinClimate', CLIMATE)

import { smoothstep } from 'three/tsl'
import { anvilForm } from '../formConstants'
import type { Float } from '../../tsl-types'
import type { LayerNodes } from './layer'

/** A height in a layer, and what the layer is like there. */
export interface LayerHeight {
  /** ĥ, from 0 at the base to 1 at the top. */
  height: Float
  /** Share of an anvil, in [0, 1]. */
  anvil: Float
  /** Height profile, in [0, 1]. */
  profile: Float
}

/** Share of a layer's anvil that is there at a height, in [0, 1]. */
const anvilAt = (layer: LayerNodes, height: Float): Float =>
  layer.anvil.mul(smoothstep(...anvilForm.heights, height)).toConst()

/**
 * Height profile ρ_h: how much of a layer's air cloud may fill at a height, in [0, 1].
 *
 * 1 − (2 ĥ^t − 1)² with t the layer's `profileExponent`; anvils are full up to the top. It may depend on
 * the layer and the height alone: `profileMean` of tsl/unresolved.ts is its integral in closed form.
 *
 */
function heightProfile(layer: LayerNodes, height: Float, anvil: Float): Float {
  const x = height.clamp(1e-4, 1).pow(layer.profileExponent).mul(2).sub(1)
  return anvil.mix(x.mul(x).oneMinus(), smoothstep(1, 0.9, height)).toConst()
}

/** What a layer is like at a height in it, in [0, 1]. */
export function layerHeight(layer: LayerNodes, height: Float): LayerHeight {
  const anvil = anvilAt(layer, height)
  return { height, anvil, profile: heightProfile(layer, height, anvil) }
}

/**
 * Dimensional profile: what a column of a given strength fills at a height before noise erodes it.
 *
 * Below their anvils, towers are narrower than what they cover. It may depend on the layer, the column's
 * strength and the height; it must grow with the strength and never exceed it, or else the empty distance
 * (tsl/emptyDistance.ts) promises too much.
 *
 * @param strength - `CloudWeather.strength`.
 * @param profile - `heightProfile` at the same height.
 * @returns In [0, 1.3].
 * @see Schneider 2022, "Nubis, evolved", where the name is from.
 */
export const dimensionalProfile = (
  layer: LayerNodes,
  strength: Float,
  { anvil, profile }: LayerHeight
): Float =>
  strength.sub(layer.anvil.sub(anvil).mul(anvilForm.narrowing)).clamp(0, 1.3).mul(profile).toConst()

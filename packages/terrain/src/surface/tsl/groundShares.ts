import { float } from 'three/tsl'
import type { Float } from '../../tsl-types'
import type { OfKinds } from '../maps/groundKinds'
import type { GroundLayers } from './groundRules'

/** Share of the ground that is left to a layer below which it has none of it. */
const NOTHING = 1e-5

/** Shares of materials of the ground, and of desert, which is sand inland; all with it have a sum of 1. */
export interface GroundShares extends OfKinds<Float> {
  readonly desert: Float
}

/** Shares of materials, sand at the shore alone. */
export function sharesOf(layers: GroundLayers): GroundShares {
  const { snow, bare, inland, bareness, dryness, woods } = layers
  let left: Float = float(1)
  const part = (share: Float): Float => {
    const taken = left.mul(share).toConst() as Float
    left = left.sub(taken).toConst()
    return taken
  }
  return {
    snow: part(snow),
    rock: part(bare),
    sand: part(inland.oneMinus()),
    scree: part(bareness),
    desert: part(dryness),
    forest: part(woods),
    grass: left
  }
}

/**
 * Layers where a mask has painted some of the ground.
 *
 * @param painted - Shares of materials with a sum of 1 at most; the rest is as it was.
 */
export function paintedLayers(layers: GroundLayers, painted: OfKinds<Float>): GroundLayers {
  const before = sharesOf(layers)
  const rest = Object.values(painted)
    .reduce((sum, share) => sum.sub(share), float(1) as Float)
    .toConst() as Float
  let left: Float = float(1)
  const layer = (share: Float, paint: Float | null): Float => {
    const taken = paint === null ? share.mul(rest) : share.mul(rest).add(paint)
    const layered = taken.div(left.max(NOTHING)).clamp(0, 1).toConst() as Float
    left = left.sub(taken).toConst()
    return layered
  }
  return {
    snow: layer(before.snow, painted.snow),
    bare: layer(before.rock, painted.rock),
    inland: layer(before.sand, painted.sand).oneMinus(),
    bareness: layer(before.scree, painted.scree),
    dryness: layer(before.desert, null),
    woods: layer(before.forest, painted.forest)
  }
}

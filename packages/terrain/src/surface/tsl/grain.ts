import { Fn, If, dFdx, dFdy, float, vec4 } from 'three/tsl'
import type { Texture } from 'three'
import type { Float, Vec3, Vec4 } from '../../tsl-types'
import { GRAIN_SLOPE } from '../grainTexture'
import { frameOf, stochasticTiling, type TilingPlace } from './stochasticTiling'

/** Sides of the picture on the ground [m], cells that it is moved in per 256 m, and longer side of a pixel's footprint at which nothing is left [m]. */
const COARSE = { side: 17, cells: 24, gone: 2 }
const FINE = { side: 2.1, cells: 192, gone: 0.3 }

/** Part of `gone` at which a picture begins to go. */
const FADE = 0.5

/** Place in a face's plane, and the ground there. */
export interface GrainPlace {
  readonly grain: Texture
  /** As of `latticeNoise`. */
  readonly reference: Vec3
  readonly offset: Vec3
  /** The face's axes. */
  readonly first: Vec3
  readonly second: Vec3
  /** Normal of the ground. */
  readonly normal: Vec3
}

/** Stones and blades of grass at a place. */
export interface Grain {
  /** Gradient of stones, those of centimetres and of metres by a factor each, along the ground [–]. */
  readonly gradient: (fine: Float, coarse: Float) => Vec3
  /** Height of stones of centimetres, and light of blades, about 0. */
  readonly stone: Float
  readonly blade: Float
  /** Height of stones of metres, and light of tufts, about 0. */
  readonly boulder: Float
  readonly tuft: Float
  /** Longer side of the pixel on the ground [m]. */
  readonly footprint: Float
  /** The second of two vectors along the ground that pictures are laid by. */
  readonly frame: Vec3
  /** Share of the slopes that are smaller than a pixel. */
  readonly lost: Float
}

type Variable = Vec4 & { assign(value: Vec4): void }

/** Stones and grass from 3 m to 1 cm; 0 where they are smaller than pixels. */
export function grainAt(place: GrainPlace): Grain {
  const { grain, offset, first, second, normal } = place
  // Derivatives are taken out of branches.
  const across = dFdx(offset).toConst() as Vec3
  const along = dFdy(offset).toConst() as Vec3
  const footprint = across.length().max(along.length()).toConst('footprint')
  const { tangent, bitangent } = frameOf(normal, first, second)
  const tiling: TilingPlace = {
    reference: place.reference,
    offset,
    across,
    along,
    tangent,
    bitangent
  }
  const layer = ({ side, cells, gone }: typeof FINE, name: string): Vec4 =>
    Fn(() => {
      const total = vec4(0).toVar(name) as unknown as Variable
      const kept = float(1).sub(footprint.div(gone)).div(FADE).min(1).toConst()
      If(kept.greaterThan(0), () => {
        total.assign(stochasticTiling(grain, tiling, side, cells).mul(kept))
      })
      return total
    })().toConst(`${name}Layer`)
  const coarse = layer(COARSE, 'coarseGrain')
  const fine = layer(FINE, 'fineGrain')
  return {
    gradient(fineGain, coarseGain) {
      const slope = fine.xy.mul(fineGain).add(coarse.xy.mul(coarseGain)).mul(GRAIN_SLOPE).toConst()
      return tangent.mul(slope.x).add(bitangent.mul(slope.y))
    },
    stone: fine.z,
    blade: fine.w,
    boulder: coarse.z,
    tuft: coarse.w,
    footprint,
    frame: bitangent,
    lost: footprint.div(FINE.gone / 4).min(1)
  }
}

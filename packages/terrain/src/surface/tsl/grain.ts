import { Fn, If, dFdx, dFdy, float, mat4, smoothstep, vec3, vec4 } from 'three/tsl'
import type { Texture } from 'three'
import type { Float, Variable, Vec3, Vec4 } from '../../tsl-types'
import { GRAIN_SLOPE } from '../grainTexture'
import { LONGEST_KEPT } from './seaSurface'
import { frameNear, pieceOf, tilingVertices } from './stochasticTiling'

/** Sides of the picture on the ground [m], and longer side of a pixel's footprint at which nothing is left [m]. */
const COARSE_SIDE = 17
const COARSE_GONE = 1
const FINE_SIDE = 2.1
const FINE_GONE = 0.14

/** Brush and outcrops, where single stones are too small to be seen: footprints between which they come, and go [m]. */
const CANOPY_SIDE = 150
const CANOPY_COMES = [0.35, 0.8] as const
const CANOPY_GOES = [5, 10] as const

/**
 * Shorter sides of a footprint between which crowns come [m]. By the longer ones, as brush: at eye height crowns lie on the meadow from 40 m on, as flat
 * black spots (*Terrain*, still grass).
 */
const CROWNS = [0.2, 0.45] as const

/** Footprint at which the slopes of all stones are smaller than a pixel [m]. */
const LOST = 0.075

/** Least size of what a picture's level shows, to the longer side of a pixel. */
const LEAST_SIZE = 0.6

/** Slope that no crown exceeds [–]. */
const STEEPEST_CROWN = 0.4

/** Cells of the lattice in 256 m that pieces of stones and grass are moved by, and those of crowns. */
const CELLS = 36
const CANOPY_CELLS = 3

/** Part of `gone` at which a picture begins to go. */
const FADE = 0.5

/** Code that a material of the ground has: with stones and blades (2), with crowns, outcrops and waves alone (1), or with none of these (0). */
export type GroundDetail = 0 | 1 | 2

/** Least side of pixels on the ground that each is for: beyond it the others show the same [m]. */
export const LEAST_FOOTPRINTS = [Math.max(CANOPY_GOES[1], LONGEST_KEPT), COARSE_GONE, 0] as const

/** Place in a face's plane, and the ground there. */
export interface GrainPlace {
  readonly grain: Texture
  /** As of `latticeNoise`. */
  readonly reference: Vec3
  readonly offset: Vec3
  /** An axis of the face. */
  readonly first: Vec3
  /** Normal of the ground, and geodetic up. */
  readonly normal: Vec3
  readonly up: Vec3
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
  /** Gradient of crowns and outcrops of 2 m to 15 m seen from afar, their height, and light of what is less high, about 0. */
  readonly canopySlope: Vec3
  readonly crown: Float
  readonly brush: Float
  /** Longer side of the pixel on the ground [m]. */
  readonly footprint: Float
  /** Share of the slopes that are smaller than a pixel. */
  readonly lost: Float
}

/** Stones and grass from 3 m to 1 cm, and crowns from afar; 0 where they are smaller than pixels. */
export function grainAt(place: GrainPlace, detail: GroundDetail): Grain {
  const { grain, offset, first, normal } = place
  // Derivatives are taken out of branches.
  const across = dFdx(offset).toConst() as Vec3
  const along = dFdy(offset).toConst() as Vec3
  const [width, height] = [across.length().toConst(), along.length().toConst()] as Float[]
  const footprint = width.max(height).toConst() as Float
  // Between both sides of a pixel, nearer to the longer one where it is much longer: one look-up a picture, of little blur and little shimmer.
  const size = width.mul(height).sqrt().max(footprint.mul(LEAST_SIZE))
  const share = (gone: number): Float =>
    float(1).sub(footprint.div(gone)).div(FADE).min(1).toConst()
  const near = share(FINE_GONE)
  const far = share(COARSE_GONE)
  const canopy = smoothstep(...CANOPY_COMES, footprint)
    .mul(smoothstep(...CANOPY_GOES, footprint).oneMinus())
    .toConst() as Float
  // Several vectors in one value: what the branches of both need is found once, and none of it far away.
  const layers = Fn(() => {
    const fine = vec4(0).toVar() as unknown as Variable<Vec4>
    const coarse = vec4(0).toVar() as unknown as Variable<Vec4>
    const fineSlope = vec3(0).toVar() as unknown as Variable<Vec3>
    const coarseSlope = vec3(0).toVar() as unknown as Variable<Vec3>
    const crowns = vec4(0).toVar() as unknown as Variable<Vec4>
    const crownSlope = vec3(0).toVar() as unknown as Variable<Vec3>
    const find = (): void => {
      const logSize = size.max(1e-6).log2().toConst() as Float
      const frame = { ...frameNear(normal, place.up, first), logSize }
      const inSpace = ({ x, y }: Vec4): Vec3 =>
        frame.tangent.mul(x).add(frame.bitangent.mul(y)).mul(GRAIN_SLOPE)
      If(canopy.greaterThan(0), () => {
        tilingVertices(place.reference, offset, CANOPY_CELLS).each(({ away, random }, share) => {
          const piece = pieceOf(grain, frame, CANOPY_SIDE, away, random.xy)
          crowns.addAssign(piece.mul(share.mul(canopy)))
        })
        const raised = smoothstep(...CROWNS, width.min(height)).toConst()
        crowns.mulAssign(vec4(vec3(raised), 1))
        crownSlope.assign(inSpace(crowns))
      })
      if (detail < 2) return
      If(far.greaterThan(0), () => {
        tilingVertices(place.reference, offset, CELLS).each(({ away, random }, share) => {
          const boulders = pieceOf(grain, frame, COARSE_SIDE, away, random.xy)
          coarse.addAssign(boulders.mul(share.mul(far)))
          If(near.greaterThan(0), () => {
            const stones = pieceOf(grain, frame, FINE_SIDE, away, random.zx)
            fine.addAssign(stones.mul(share.mul(near)))
          })
        })
        fineSlope.assign(inSpace(fine))
        coarseSlope.assign(inSpace(coarse))
      })
    }
    // Seen from afar there are none of them.
    if (detail > 0) If(footprint.lessThan(CANOPY_GOES[1]), find)
    return mat4(
      vec4(fineSlope, fine.z),
      vec4(coarseSlope, coarse.z),
      vec4(fine.w, coarse.w, crowns.z, crowns.w),
      vec4(crownSlope, 0)
    )
  })().toConst() as unknown as { element(i: number): Vec4 }
  const [fine, coarse, light, crowns] = [0, 1, 2, 3].map(i => layers.element(i))
  return {
    gradient: (fineGain, coarseGain) => fine.xyz.mul(fineGain).add(coarse.xyz.mul(coarseGain)),
    stone: fine.w,
    blade: light.x,
    boulder: coarse.w,
    tuft: light.y,
    canopySlope: crowns.xyz,
    crown: light.z,
    brush: light.w,
    footprint,
    lost: footprint.div(LOST).min(1)
  }
}

/**
 * Slopes of crowns, no more than {@link STEEPEST_CROWN}: leaves let light through to the shaded side. As steep as they are: crowns that stand alone are black
 * wedges with edges like a saw, and crests are dotted (*Terrain*, stills grass and scree).
 */
export function leaning(slope: Vec3): Vec3 {
  const most = STEEPEST_CROWN
  return slope.mul(
    slope
      .dot(slope)
      .div(most * most)
      .add(1)
      .inverseSqrt()
  )
}

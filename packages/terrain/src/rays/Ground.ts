import { Vector3 } from 'three'
import type { GroundBounds, HeightSample } from '../heights/HeightSource'
import { sampleGround } from '../heights/sampleGround'
import { figureOf, type GroundSpace } from '../tiles/cpu/figure'

/** Water above the sea, such as a lake. */
export interface GroundWater {
  /** Surface of the water [m]. */
  readonly level: number
  /** True where ground below its level is under water. @param subpoint - On the ellipsoid, ECEF [m]. */
  covers(subpoint: Vector3): boolean
}

/** Ground of a planet that rays hit and feet stand on; a `Terrain` is one. */
export interface Ground {
  /** Ellipsoid and its place in the world, or that the world is flat. */
  readonly atmosphere: GroundSpace
  /** Heights over the ellipsoid, or in a flat world over y = 0. */
  readonly source: GroundBounds
  /** Surface of the sea [m]; −Infinity for none. */
  readonly seaLevel: number
  /** Water above the sea; none if left out. */
  readonly lakes?: readonly GroundWater[]
}

/** Surface of the sea or a lake over a place, wherever the ground is; −Infinity for none [m]. @param subpoint - On the ellipsoid, ECEF [m]. */
export const waterLevel = ({ seaLevel, lakes = [] }: Ground, subpoint: Vector3): number =>
  lakes.reduce(
    (highest, lake) => (lake.covers(subpoint) ? Math.max(highest, lake.level) : highest),
    seaLevel
  )

const sample: HeightSample = { height: 0, gradient: new Vector3() }

/**
 * Unit normal of the surface, that of water where it covers the ground.
 *
 * @param subpoint - On the ellipsoid, ECEF [m].
 * @returns ECEF.
 */
export function groundNormal(ground: Ground, subpoint: Vector3, target: Vector3): Vector3 {
  const { atmosphere, source } = ground
  figureOf(atmosphere).surfaceNormal(subpoint, target)
  const { height, gradient } = sampleGround(source, subpoint, sample)
  if (height <= waterLevel(ground, subpoint)) return target
  gradient.addScaledVector(target, -gradient.dot(target))
  return target.sub(gradient).normalize()
}

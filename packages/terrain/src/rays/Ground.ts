import { Vector3 } from 'three'
import type { GroundBounds, HeightSample } from '../heights/HeightSource'
import { sampleGround } from '../heights/sampleGround'
import { figureOf, type GroundSpace } from '../tiles/cpu/figure'

/** Ground of a planet that rays hit and feet stand on; a `Terrain` is one. */
export interface Ground {
  /** Ellipsoid and its place in the world, or that the world is flat. */
  readonly atmosphere: GroundSpace
  /** Heights over the ellipsoid, or in a flat world over y = 0. */
  readonly source: GroundBounds
  /** Surface of the sea [m]; −Infinity for none. */
  readonly seaLevel: number
}

const sample: HeightSample = { height: 0, gradient: new Vector3() }

/**
 * Unit normal of the surface, that of the sea where it covers the ground.
 *
 * @param subpoint - On the ellipsoid, ECEF [m].
 * @returns ECEF.
 */
export function groundNormal(
  { atmosphere, source, seaLevel }: Ground,
  subpoint: Vector3,
  target: Vector3
): Vector3 {
  figureOf(atmosphere).surfaceNormal(subpoint, target)
  const { height, gradient } = sampleGround(source, subpoint, sample)
  if (height <= seaLevel) return target
  gradient.addScaledVector(target, -gradient.dot(target))
  return target.sub(gradient).normalize()
}

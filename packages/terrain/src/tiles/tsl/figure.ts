import { vec3 } from 'three/tsl'
import type { Vec3 } from '../../tsl-types'
import { unitDifference } from './cubeSphere'

/** Figure that ground lies on, in shaders. Twin: ../cpu/figure.ts */
export interface ShaderFigure {
  readonly isFlat: boolean
  /** Place above a point of the cube and a difference from it, relative to the place above the point [m]. */
  readonly difference: (cube: Vec3, delta: Vec3, radii: Vec3) => Vec3
  /** Up at the displaced point minus up at the point. */
  readonly turnOfUp: (cube: Vec3, delta: Vec3, stretch: Vec3) => Vec3
  /** Up above a point of the cube. */
  readonly upOfCube: (cube: Vec3, stretch: Vec3) => Vec3
  /** Up at a place, from the figure's centre [m]; `stretch` by any factor. */
  readonly upAt: (position: Vec3, stretch: Vec3) => Vec3
}

/** An ellipsoid. */
export const ellipsoidInShader: ShaderFigure = {
  isFlat: false,
  difference: (cube, delta, radii) => unitDifference(cube, delta).mul(radii),
  turnOfUp: (cube, delta, stretch) => unitDifference(cube.mul(stretch), delta.mul(stretch)),
  upOfCube: (cube, stretch) => cube.mul(stretch).normalize(),
  // Normalised it may be of any size: what has no division costs least.
  upAt: (position, stretch) => position.mul(stretch).mul(stretch).normalize()
}

/** The plane of a flat world. */
export const planeInShader: ShaderFigure = {
  isFlat: true,
  difference: (_, delta, radii) => delta.mul(radii),
  turnOfUp: () => vec3(0),
  upOfCube: () => vec3(0, 1, 0),
  upAt: () => vec3(0, 1, 0)
}

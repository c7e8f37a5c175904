import { Matrix4, Vector3 } from 'three'
import type { Atmosphere } from '@welkin/atmosphere'
import type { Ellipsoid } from '@welkin/geo'
import { cubeToEllipsoid } from './cubeSphere'

/** Half width of the ground of a flat world [m]: a power of two, so that places on it are exact. */
const HALF_WIDTH = 2 ** 20

/** Level plane of a flat world, in place of an ellipsoid: y is height [m]. */
export class FlatFigure {
  readonly isFlat = true
  /** Half width of the ground along each axis [m]. */
  readonly radii = new Vector3().setScalar(HALF_WIDTH)
  readonly maximumRadius = HALF_WIDTH
  /** It does not bend. */
  readonly minimumRadius = Infinity

  footPoint({ x, z }: Vector3, target: Vector3): Vector3 {
    return target.set(x, 0, z)
  }

  surfaceNormal(_position: Vector3, target = new Vector3()): Vector3 {
    return target.set(0, 1, 0)
  }

  heightAt({ y }: Vector3): number {
    return y
  }
}

/** Figure that ground lies on. */
export type Figure = Ellipsoid | FlatFigure

/** World that ground is in. */
export type GroundSpace = Pick<Atmosphere, 'ellipsoid' | 'worldToECEF'> &
  Partial<Pick<Atmosphere, 'flat' | 'metersPerUnit'>>

const PLANE = new FlatFigure()
const scaling = new Matrix4()
const rotation = new Matrix4()

/** Figure of a world's ground. */
export const figureOf = ({ flat, ellipsoid }: GroundSpace): Figure =>
  flat === true ? PLANE : ellipsoid

/** True of the plane of a flat world. */
export const isFlat = (figure: Figure): figure is FlatFigure => 'isFlat' in figure

/**
 * World units to metres in the ground's own axes: those of ECEF, or of a flat world those of the world.
 *
 * @returns One matrix for all flat worlds, good until the next call.
 */
export const worldToGround = ({ flat, metersPerUnit = 1, worldToECEF }: GroundSpace): Matrix4 =>
  flat === true ? scaling.makeScale(metersPerUnit, metersPerUnit, metersPerUnit) : worldToECEF

/** Unit vector to the north pole, in the ground's own axes. */
export function poleOf(space: GroundSpace, target: Vector3): Vector3 {
  target.set(0, 0, 1)
  return space.flat === true
    ? target.transformDirection(rotation.copy(space.worldToECEF).invert())
    : target
}

/** Faces of the cube that have ground: all, or the one whose outward axis is y. */
export const facesOf = (figure: Figure): readonly number[] =>
  isFlat(figure) ? [2] : [0, 1, 2, 3, 4, 5]

/** Place of a point of the cube on the figure [m]. */
export function cubeToFigure(cube: Vector3, figure: Figure, target: Vector3): Vector3 {
  if (isFlat(figure)) return target.set(cube.x, 0, cube.z).multiplyScalar(HALF_WIDTH)
  return cubeToEllipsoid(cube, figure.radii, target)
}

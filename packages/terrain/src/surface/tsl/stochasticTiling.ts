import {
  If,
  bitAnd,
  bitOr,
  floatBitsToUint,
  ivec3,
  max,
  min,
  mix,
  step,
  texture,
  uint,
  uintBitsToFloat,
  uvec3,
  uvec4,
  vec2,
  vec4
} from 'three/tsl'
import type { Texture } from 'three'
import { latticeGradient } from '../../noise/tsl/latticeNoise'
import type { Float, UInt, UVec4, Variable, Vec2, Vec3, Vec4 } from '../../tsl-types'

/** Directions in which pictures are laid, and the level of detail that they are read at. */
export interface TilingFrame {
  /** Orthonormal vectors along the surface. */
  readonly tangent: Vec3
  readonly bitangent: Vec3
  /** Binary logarithm of the size of what a pixel shows [m]. */
  readonly logSize: Float
}

/** Vertex of the lattice that counts at a place. */
export interface TilingVertex {
  /** Place relative to it [m]. */
  readonly away: Vec3
  /** Three random numbers of it, in [−1, 1). */
  readonly random: Vec3
}

/** The two vertices that count at a place, each found when it is asked for. */
export interface TilingVertices {
  readonly nearest: () => TilingVertex
  readonly next: () => TilingVertex
  /** Factors on their pictures; the second is often 0, the sum of the squares is 1. */
  readonly shares: Vec2
  /** Calls with the nearest, and in a branch with the next where it counts. */
  readonly each: (add: (vertex: TilingVertex, share: Float) => void) => void
}

/** Part of the nearest vertex's weight that the next must exceed to count. */
const LEAST = 0.55

const sum = ({ x, y, z }: Vec3): Float => x.add(y).add(z)

/** Two numbers, the larger first. */
const sorted = (a: Float, b: Float): [Float, Float] => [max(a, b).toConst(), min(a, b).toConst()]

/**
 * The two vertices that count at a place, of a lattice of tetrahedra that is fixed to the planet and fills space.
 *
 * Of the four about a place the two nearest count, by how much their weights exceed the third's: what is left out had no share. Where the next is
 * much farther than the nearest it does not count. As in Heitz and Neyret's by-example noise (2018), the blend keeps the variance. Weights are sorted with the number of their vertex in
 * their two lowest bits.
 *
 * @param reference - As of `latticeNoise`, like `offset`.
 * @param cells - Cells of the lattice in 256 m, a multiple of 3.
 */
export function tilingVertices(reference: Vec3, offset: Vec3, cells: number): TilingVertices {
  const size = 256 / cells
  const place = offset.div(size).toConst() as Vec3
  const skewed = place.add(sum(place).div(3)).toConst() as Vec3
  const corner = skewed.floor().toConst() as Vec3
  const part = skewed.sub(corner).toConst() as Vec3
  const [high, low] = sorted(part.x, part.y)
  const [most, other] = sorted(high, part.z)
  const [middle, least] = sorted(other, low)

  const weights = vec4(most.oneMinus(), most.sub(middle), middle.sub(least), least)
  const bits = floatBitsToUint(weights) as unknown as UVec4
  const cleared = bitAnd(bits as never, uvec4(0xfffffffc) as never)
  const numbered = bitOr(cleared as never, uvec4(0, 1, 2, 3) as never)
  const keys = (uintBitsToFloat(numbered) as unknown as Vec4).toConst() as Vec4
  const [a, b] = sorted(keys.x, keys.y)
  const [c, d] = sorted(keys.z, keys.w)
  const [nearest, second] = sorted(a, c)
  const [next, left] = sorted(second, max(b, d))

  // A vertex is 1 along the axes of as many of the largest parts as its number says.
  const vertexOf = (key: Float): Vec3 => {
    const number = (floatBitsToUint(key) as unknown as UInt).bitAnd(uint(3)).toFloat().toConst()
    const [isOne, isTwo, isThree] = [1, 2, 3].map(n => step(n - 0.5, number))
    const threshold = mix(mix(2, most, isOne), mix(middle, 0, isThree), isTwo)
    return step(threshold, part)
  }
  // Whole numbers, exact in float32: so is their sum with a vertex.
  const origin = reference
    .mul(3)
    .add(sum(reference))
    .mul(cells / 3)
    .toConst()
  const first = nearest.sub(left).toConst() as Float
  const weight = vec2(first, next.sub(left).sub(first.mul(LEAST)).max(0)).toConst() as Vec2
  const square = weight.mul(weight).toConst() as Vec2
  const vertexAt = (key: Float) => (): TilingVertex => {
    const vertex = corner.add(vertexOf(key)).toConst() as Vec3
    const away = skewed.sub(vertex).toConst() as Vec3
    return {
      away: away.sub(sum(away).div(6)).mul(size).toConst(),
      random: latticeGradient(uvec3(ivec3(vertex.add(origin)))).toConst()
    }
  }
  const shares = square.mul(square.dot(square).max(1e-9).inverseSqrt()).toConst() as Vec2
  return {
    nearest: vertexAt(nearest),
    next: vertexAt(next),
    shares,
    each(add) {
      add(this.nearest(), shares.x)
      If(shares.y.greaterThan(0), () => {
        add(this.next(), shares.y)
      })
    }
  }
}

/** Vector along a surface in the directions of its frame. */
const alongFrame = ({ tangent, bitangent }: TilingFrame, vector: Vec3): Vec2 =>
  vec2(vector.dot(tangent), vector.dot(bitangent))

/**
 * Piece of a picture that a vertex of the lattice has, moved at random and laid along the surface through the vertex: nothing is stretched
 * on cliffs, and no plane meets another. Two of them, by their shares, have no visible repetition.
 *
 * @param picture - Repeats; its mean is half of its bytes' range.
 * @param side - Length of its side [m].
 * @param moved - Random numbers of the vertex.
 * @returns Its four channels in about [−1, 1].
 */
export function pieceOf(
  picture: Texture,
  frame: TilingFrame,
  side: number,
  away: Vec3,
  moved: Vec2
): Vec4 {
  const place = alongFrame(frame, away).div(side).add(moved)
  const node = texture(picture, place) as unknown as { level(level: Float): Vec4 }
  const { width } = picture.image as { width: number }
  const level = frame.logSize.add(Math.log2(width / side)).max(0)
  return node.level(level).mul(2).sub(1)
}

/** Sine of the slope from which on pictures lie on a tilted plane, and sine and cosine of its tilt: of 55°. */
const STEEP = 0.53
const SIN_TILT = 0.82
const COS_TILT = 0.57

/** Factor by which rounding finds the nearest of eight azimuths, each 45° wide to 2°. */
const EIGHTHS = 1.2

/**
 * Orthonormal vectors of a plane near to a surface: level where it is flat, else tilted to the nearest of eight azimuths.
 *
 * They do not turn with every pixel's normal: at some distance from a vertex of the lattice that would bend and stretch the picture. A
 * surface is stretched by 1.2 at most, on cliffs too.
 *
 * @param normal - Unit normal of the surface.
 * @param up - Geodetic up.
 * @param axis - Unit vector that is not along up, such as a face's.
 */
export function frameNear(normal: Vec3, up: Vec3, axis: Vec3): { tangent: Vec3; bitangent: Vec3 } {
  const east = axis
    .sub(up.mul(axis.dot(up)))
    .normalize()
    .toConst() as Vec3
  const north = up.cross(east).toConst() as Vec3
  const level = vec2(normal.dot(east), normal.dot(north)).toConst() as Vec2
  const sine = level.length().toConst() as Float
  const tangent = east.toVar() as unknown as Variable<Vec3>
  const bitangent = north.toVar() as unknown as Variable<Vec3>
  If(sine.greaterThan(STEEP), () => {
    const azimuth = level.mul(sine.reciprocal().mul(EIGHTHS)).round().normalize().toConst() as Vec2
    const downhill = east.mul(azimuth.x).add(north.mul(azimuth.y)).toConst() as Vec3
    tangent.assign(downhill.cross(up))
    bitangent.assign(downhill.mul(COS_TILT).sub(up.mul(SIN_TILT)))
  })
  return { tangent, bitangent }
}

import { ivec3, mix, step, texture, uvec3, vec2, vec4 } from 'three/tsl'
import type { Texture } from 'three'
import { latticeGradient } from '../../noise/tsl/latticeNoise'
import type { Float, Vec2, Vec3, Vec4 } from '../../tsl-types'

/** Place of a pixel, and the frame that pictures are laid in. */
export interface TilingPlace {
  /** As of `latticeNoise`. */
  readonly reference: Vec3
  readonly offset: Vec3
  /** Change of the offset from a pixel to the next, across and along [m]. */
  readonly across: Vec3
  readonly along: Vec3
  /** Orthonormal vectors along the surface. */
  readonly tangent: Vec3
  readonly bitangent: Vec3
}

const sum = ({ x, y, z }: Vec3): Float => x.add(y).add(z)

/**
 * Picture on a surface of any slope, with no visible repetition, by two reads.
 *
 * Space is filled with tetrahedra of a lattice fixed to the planet. Each vertex has a piece of the picture, moved at random and laid
 * along the surface through the vertex: so nothing is stretched on cliffs, and no plane meets another. Of the four vertices about a place the two
 * nearest count, by how much they exceed the third: what is left out had no share. As in Heitz and Neyret's by-example noise (2018), the blend keeps
 * the variance.
 *
 * @param picture - Repeats; its mean is half of its bytes' range.
 * @param side - Length of its side [m].
 * @param cells - Cells of the lattice in 256 m, a multiple of 3.
 * @returns Its four channels in about [−1, 1].
 */
export function stochasticTiling(
  picture: Texture,
  { reference, offset, across, along, tangent, bitangent }: TilingPlace,
  side: number,
  cells: number
): Vec4 {
  const size = 256 / cells
  const place = offset.div(size).toConst() as Vec3
  const skewed = place.add(sum(place).div(3)).toConst() as Vec3
  const corner = skewed.floor().toConst() as Vec3
  const part = skewed.sub(corner).toConst() as Vec3
  // Vertices in the order of the path from the cell's first corner to its last, along the longest part first.
  const isMore = step(part.yzx, part).toConst() as Vec3
  const isLess = isMore.oneMinus()
  const second = isMore.min(isLess.zxy)
  const third = isMore.max(isLess.zxy)
  const most = part.x.max(part.y).max(part.z).toConst()
  const least = part.x.min(part.y).min(part.z).toConst()
  const middle = sum(part).sub(most).sub(least).toConst()
  const vertices = [
    vec4(0, 0, 0, most.oneMinus()),
    vec4(second, most.sub(middle)),
    vec4(third, middle.sub(least)),
    vec4(1, 1, 1, least)
  ].map(vertex => vertex.toConst()) as unknown as Vec4[]
  const sorted = (a: Vec4, b: Vec4): [Vec4, Vec4] => {
    const isFirst = step(b.w, a.w).toConst()
    return [mix(b, a, isFirst).toConst(), mix(a, b, isFirst).toConst()]
  }
  const [a, b] = sorted(vertices[0], vertices[1])
  const [c, d] = sorted(vertices[2], vertices[3])
  const [nearest, other] = sorted(a, c)
  const [next, left] = sorted(other, sorted(b, d)[0])

  const along2 = (vector: Vec3): Vec2 => vec2(vector.dot(tangent), vector.dot(bitangent))
  const [dx, dy] = [across, along].map(change => along2(change).div(side).toConst() as Vec2)
  const cellsOfReference = reference.mul(cells)
  const origin = ivec3(cellsOfReference.add(sum(cellsOfReference).div(3)).round()).toConst()
  const read = ({ xyz }: Vec4): Vec4 => {
    const vertex = corner.add(xyz).toConst() as Vec3
    const away = skewed.sub(vertex).toConst() as Vec3
    const meters = away.sub(sum(away).div(6)).mul(size)
    const moved = latticeGradient(uvec3(ivec3(vertex).add(origin)))
    const node = texture(picture, along2(meters).div(side).add(moved.xy)) as unknown as {
      grad(dx: Vec2, dy: Vec2): Vec4
    }
    return node.grad(dx, dy).mul(2).sub(1)
  }
  const share = ({ w }: Vec4): Float => w.sub(left.w).pow(2).toConst()
  const [first, other2] = [share(nearest), share(next)]
  const scale = first.mul(first).add(other2.mul(other2)).max(1e-9).inverseSqrt()
  return read(nearest).mul(first).add(read(next).mul(other2)).mul(scale).toConst()
}

/** Orthonormal vectors along a surface: the first follows an axis, or a spare one where that points out of the surface. */
export function frameOf(normal: Vec3, axis: Vec3, spare: Vec3): { tangent: Vec3; bitangent: Vec3 } {
  const isAlong = step(normal.dot(axis).abs(), 0.9)
  const guide = mix(spare, axis, isAlong).toConst() as Vec3
  const tangent = guide
    .sub(normal.mul(guide.dot(normal)))
    .normalize()
    .toConst() as Vec3
  return { tangent, bitangent: normal.cross(tangent).toConst() }
}

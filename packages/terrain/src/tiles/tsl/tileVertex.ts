import {
  Fn,
  attribute,
  float,
  ivec2,
  mix,
  positionGeometry,
  smoothstep,
  step,
  texture,
  vec2,
  vec3,
  vec4
} from 'three/tsl'
import type { Texture } from 'three'
import type { PageAtlas } from '../../pages/PageAtlas'
import type { TerrainUniforms } from '../../TerrainUniforms'
import type { Float, Vec2, Vec3, Vec4 } from '../../tsl-types'
import { unpacked } from '../../pages/tsl/packing'
import { faceAxes } from './cubeSphere'
import type { ShaderFigure } from './figure'

/** Part of a level's range at which its tiles begin to morph: beyond it no finer neighbour is. */
export const morphStart = (detail: number): number => (detail + 1) / (2 * detail)

/**
 * Height of a vertex over the line between its neighbours, to its distance, up to which it moves to one of them, and from which it stays [–]: half a
 * pixel and one at 1080 lines. Where ground is flat triangles are twice as large then: pixels along their edges cost double (4.9 for 4.2 ms at eye height).
 */
export const FLAT = [0.0005, 0.001] as const

/** Distance within which the ceiling holds; beyond, it rises by as much as distance does [cells]. */
const CLOSE = 3

/**
 * Width of skirts, which lean outwards under the ground of the neighbour [cells]. Less: between two tiles a ray along their edge sees
 * the gap that rounding leaves, which is a part of a pixel wide. Greater: they stand out of ground steeper than they are.
 */
export const SKIRT_WIDTH = 0.4

/** Depth of skirts that are deeper than a cell, at most [m]. */
export const DEEPEST_SKIRT = 2e4

/** Vertex of a tile. */
export interface TileVertex {
  /** Viewer to the vertex, ECEF axes [m]. */
  readonly position: Vec3
  /** Reference to the vertex's subpoint on the ellipsoid, ECEF axes [m]. */
  readonly place: Vec3
  /** Texels from the first one of a page for pixels. */
  readonly texels: Vec2
  /** Geodetic up there. */
  readonly up: Vec3
  /** Share of the parent's page (x), climate (y), face of the cube (z), and share of the sky (w). */
  readonly blend: Vec4
}

/**
 * Vertex of a tile on the ground, morphed by distance between its own grid and that of half its resolution, and between its own
 * page and its parent's: wholly morphed it is where the coarser neighbour has it.
 *
 * Positions come from differences to the tile's centre, and heights from the difference to the ground below the
 * viewer, which are small where the viewer stands: float32 keeps millimetres there on a planet.
 *
 * @param resolution - Cells along a tile's edge.
 * @param detail - As of `TileTree`.
 * @see Strugar 2010, "Continuous distance-dependent level of detail for rendering heightmaps", §3.4
 */
export function tileVertex(
  { heights, columns, heightSide, density }: PageAtlas,
  uniforms: TerrainUniforms,
  figure: ShaderFigure,
  resolution: number,
  detail: number
): TileVertex {
  const instance = (name: string): Vec4 => attribute(name, 'vec4')
  const base = instance('tileBase')
  const tileOffset = instance('tileOffset')
  const tileCube = instance('tileCube')
  const { x: own, y: parent, z: quarter, w: fade } = instance('tilePage')
  const { radii, stretch, datum, groundHeight, seaLevel, ceiling, flatUntil } = uniforms
  const { first, second } = faceAxes(tileCube.w)
  const cube = tileCube.xyz
  const extent = tileOffset.w

  const alongCube = (cells: Vec2): Vec3 => {
    const place = cells.mul(2 / resolution).sub(1)
    return first.mul(place.x).add(second.mul(place.y)).mul(extent).toConst()
  }
  const fromCenter = (delta: Vec3): Vec3 => figure.difference(cube, delta, radii).toConst()

  const cells = positionGeometry.xy as unknown as Vec2
  const even = cells.mul(0.5).floor().mul(2).toConst() as Vec2
  const start = morphStart(detail)
  // That of the vertex to which an odd one moves: wholly moved it must be there, height and all, or slivers are left between them.
  const distance = tileOffset.xyz
    .add(fromCenter(alongCube(even)))
    .sub(datum)
    .length()
    .toConst()
  const morph = distance
    .div(base.w)
    .sub(start)
    .div(1 - start)
    .clamp(0, 1)
    .max(fade)
    .toConst()

  const inParent = quarterOf(quarter).mul(resolution).toConst()
  const vertexAt = (slot: Float, cell: Vec2): Vec3 =>
    load(heights.texture, firstTexel(slot, columns, heightSide).add(cell)).toConst()
  const odd = cells.sub(even).toConst() as Vec2
  // Between two vertices that stay: on the grid's diagonal if it is odd both ways.
  const [fine, before, after] = [cells, even, cells.add(odd)].map(cell => vertexAt(own, cell))
  // The globe bends, too: by the sagitta over two cells, or over their diagonal.
  const cell = extent
    .mul(radii.x)
    .mul(2 / resolution)
    .toConst() as Float
  const sagitta = figure.isFlat ? float(0) : cell.mul(cell).div(radii.x.mul(2)).mul(odd.dot(odd))
  const [middle, left, right] = [fine, before, after].map(({ x }) => x.max(seaLevel))
  const bend = middle.sub(left.add(right).mul(0.5)).add(sagitta).abs()
  const flatness = smoothstep(...FLAT, bend.div(distance))
    .oneMinus()
    .mul(smoothstep(flatUntil, flatUntil.mul(2), distance).oneMinus())
    .toConst() as Float
  const mixed = mix(
    mix(fine, before, flatness),
    vertexAt(parent, even.add(inParent).mul(0.5)),
    morph
  ).toConst() as Vec3

  const moved = mix(cells, even, morph.max(flatness)).toConst() as Vec2
  const skirtShare = positionGeometry.z as unknown as Float
  const outwards = step(vec2(resolution - 0.5), cells).sub(step(cells, vec2(0.5)))
  const delta = alongCube(moved.add(outwards.mul(skirtShare.mul(SKIRT_WIDTH))))
  const subpoint = fromCenter(delta)
  // Vertices of the triangle under the viewer are within three cells, morphed or not.
  const room = distance.sub(cell.mul(CLOSE)).max(0)
  const height = mixed.x.min(ceiling.add(room)).max(seaLevel)
  const up = figure.upOfCube(cube.add(delta), stretch).toConst() as Vec3
  const tilt = figure.turnOfUp(cube, delta, stretch)
  const skirt = skirtShare.mul(cell.mul(uniforms.skirt).min(cell.max(DEEPEST_SKIRT)))
  const position = base.xyz
    .add(subpoint)
    .add(tilt.mul(groundHeight))
    .add(up.mul(height.sub(groundHeight).sub(skirt)))
  return {
    position,
    place: tileOffset.xyz.add(subpoint),
    texels: moved.mul(density),
    up,
    blend: vec4(morph, mixed.y, tileCube.w, mixed.z)
  }
}

/**
 * First texels of a tile's page for pixels (xy), and of its quarter of the parent's (zw): the same for all of an instance.
 *
 * @param resolution - Cells along a tile's edge.
 */
export const tilePages = ({ columns, surfaceSide, density }: PageAtlas, resolution: number): Vec4 =>
  Fn(() => {
    const { x: own, y: parent, z: quarter } = attribute('tilePage', 'vec4')
    const inParent = quarterOf(quarter).mul((resolution * density) / 2)
    return vec4(
      firstTexel(own, columns, surfaceSide),
      firstTexel(parent, columns, surfaceSide).add(inParent)
    )
  })()

/** First texel of a page. */
function firstTexel(slot: Float, columns: number, side: number): Vec2 {
  const row = slot.add(0.5).div(columns).floor().toConst()
  return vec2(slot.sub(row.mul(columns)), row)
    .mul(side)
    .toConst()
}

/** Column and row of a quarter of a tile. */
const quarterOf = (quarter: Float): Vec2 => vec2(quarter.mod(2), quarter.mul(0.5).floor())

/** Height, climate and share of the sky at a texel. */
function load(heights: Texture, texel: Vec2): Vec3 {
  const node = texture(heights) as unknown as { load(at: unknown): Vec4 }
  const { x, y } = node.load(ivec2(texel as never)).toConst() as Vec4
  return vec3(x, unpacked(y))
}

import { attribute, positionGeometry } from 'three/tsl'
import type { HeightSource } from '../../heights/HeightSource'
import type { TerrainUniforms } from '../../TerrainUniforms'
import type { Float, Vec2, Vec3, Vec4 } from '../../tsl-types'
import { faceAxes, unitDifference } from './cubeSphere'

/** Part of a level's range at which its tiles begin to morph: beyond it no finer neighbour is. */
export const morphStart = (detail: number): number => (detail + 1) / (2 * detail)

/** Vertex of a tile. */
export interface TileVertex {
  /** Viewer to the vertex, ECEF axes [m]. */
  readonly position: Vec3
  /** Reference to the vertex's subpoint on the ellipsoid, ECEF axes [m]. */
  readonly offset: Vec3
}

/**
 * Vertex of a tile on the ground, morphed by distance between its own grid and that of half its resolution.
 *
 * Positions come from differences to the tile's centre, and heights from the difference to the ground below the
 * viewer, which are small where the viewer stands: float32 keeps millimetres there on a planet.
 *
 * @param resolution - Cells along a tile's edge.
 * @param detail - As of `TileTree`.
 * @see Strugar 2010, "Continuous distance-dependent level of detail for rendering heightmaps", §3.4
 */
export function tileVertex(
  source: HeightSource,
  uniforms: TerrainUniforms,
  resolution: number,
  detail: number
): TileVertex {
  const base = attribute('tileBase', 'vec4') as unknown as Vec4
  const tileOffset = attribute('tileOffset', 'vec4') as unknown as Vec4
  const tileCube = attribute('tileCube', 'vec4') as unknown as Vec4
  const { radii, stretch, reference, datum, groundHeight, seaLevel } = uniforms
  const { first, second } = faceAxes(tileCube.w)
  const cube = tileCube.xyz
  const extent = tileOffset.w

  const alongCube = (cells: Vec2): Vec3 => {
    const place = cells.mul(2 / resolution).sub(1)
    return first.mul(place.x).add(second.mul(place.y)).mul(extent).toConst()
  }
  const fromCenter = (delta: Vec3): Vec3 => unitDifference(cube, delta).mul(radii).toConst()
  const distance = (fromTile: Vec3): Float =>
    tileOffset.xyz.add(fromTile).sub(datum).length().toConst()

  const cells = positionGeometry.xy as unknown as Vec2
  const odd = cells.sub(cells.mul(0.5).floor().mul(2))
  const start = morphStart(detail)
  const range = base.w
  const morph = distance(fromCenter(alongCube(cells)))
    .div(range)
    .sub(start)
    .div(1 - start)
    .clamp(0, 1)

  const delta = alongCube(cells.sub(odd.mul(morph)))
  const subpoint = fromCenter(delta)
  const offset = tileOffset.xyz.add(subpoint).toConst('offset')
  // Two cells of the coarsest tile at that distance.
  const shortest = distance(subpoint).mul(shortestPerDistance(resolution, detail))
  const height = source.sample({ reference, offset }, shortest).w.max(seaLevel)
  const up = cube.add(delta).mul(stretch).normalize().toConst('up')
  const tilt = unitDifference(cube.mul(stretch), delta.mul(stretch))
  const skirt = positionGeometry.z
    .mul(extent)
    .mul(radii.x)
    .mul(2 / resolution)
  const position = base.xyz
    .add(subpoint)
    .add(tilt.mul(groundHeight))
    .add(up.mul(height.sub(groundHeight).sub(skirt)))
  return { position, offset }
}

/** Shortest wavelength that vertices show, per distance: two cells where they are the largest [–]. */
export const shortestPerDistance = (resolution: number, detail: number): number =>
  Math.SQRT2 / (detail * resolution)

import { Fn, dFdx, dFdy, transformNormalToView, varyingProperty, vec4 } from 'three/tsl'
import { MeshStandardNodeMaterial } from 'three/webgpu'
import type { NodeBuilder } from 'three/webgpu'
import type { HeightSource } from '../heights/HeightSource'
import { REFERENCE_STEP } from '../noise/tsl/latticeNoise'
import type { TerrainUniforms } from '../TerrainUniforms'
import { tileVertex } from '../tiles/tsl/tileVertex'
import type { Float, Vec3, Vec4 } from '../tsl-types'
import { groundSurface } from './tsl/groundSurface'

/** Shortest wavelength of the ground that is shown [pixels]. */
const SHORTEST_PIXELS = 2

/** True of the material that three draws shadow maps with. */
const isShadowPass = (material: object): boolean =>
  (material as { isShadowPassMaterial?: boolean }).isShadowPassMaterial === true

/** Part of a gradient along the ellipsoid. */
const gradientAlong = (gradient: Vec3, up: Vec3): Vec3 => gradient.sub(up.mul(gradient.dot(up)))

/**
 * Material of a terrain: vertices on the ground, normals from the height's own gradient at every pixel.
 *
 * @param resolution - Cells along a tile's edge.
 * @param detail - As of `TileTree`.
 */
export function terrainMaterial(
  source: HeightSource,
  uniforms: TerrainUniforms,
  resolution: number,
  detail: number
): MeshStandardNodeMaterial {
  const material = new MeshStandardNodeMaterial()
  material.name = 'Welkin.Terrain'
  material.metalness = 0
  const { reference, radii, stretch, seaLevel } = uniforms

  const offset = varyingProperty('vec3', 'welkinTerrainOffset') as unknown as Vec3
  material.positionNode = Fn(() => {
    const vertex = tileVertex(source, uniforms, resolution, detail)
    ;(offset as unknown as { assign(value: Vec3): void }).assign(vertex.offset)
    return vertex.position
  })()

  const point = { reference, offset }
  // Footprint: the geometric mean of a pixel's sides, on the ellipsoid.
  const footprint = dFdx(offset).length().mul(dFdy(offset).length()).sqrt().toConst('footprint')
  const shortest = footprint.mul(SHORTEST_PIXELS).toConst('shortest') as Float
  const ground = source.sample(point, shortest).toConst('ground') as Vec4
  const place = reference.mul(REFERENCE_STEP).add(offset)
  const up = place.div(radii).mul(stretch).normalize().toConst('up') as Vec3
  const isLand = ground.w.greaterThan(seaLevel).select(1, 0) as unknown as Float
  const gradient = gradientAlong(ground.xyz, up).mul(isLand).toConst('gradient') as Vec3
  const cosSlope = gradient.dot(gradient).add(1).inverseSqrt().toConst('cosSlope') as Float
  const surface = groundSurface(point, ground.w, up, cosSlope, shortest, seaLevel)
  // Shadow maps ask for its alpha, and need not wait for the rest.
  material.colorNode = Fn(({ material: drawn }: NodeBuilder) =>
    isShadowPass(drawn) ? vec4(1) : vec4(surface.color, 1)
  )()
  material.roughnessNode = surface.roughness
  const tilt = gradient.add(gradientAlong(surface.grain, up))
  material.normalNode = transformNormalToView(up.sub(tilt).normalize())
  return material
}

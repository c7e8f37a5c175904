import { Fn, If, mix, texture, transformNormalToView, varyingProperty, vec2, vec4 } from 'three/tsl'
import type { Texture } from 'three'
import { MeshStandardNodeMaterial } from 'three/webgpu'
import type { Node, NodeBuilder } from 'three/webgpu'
import type { PageAtlas } from '../pages/PageAtlas'
import { REFERENCE_STEP } from '../noise/tsl/latticeNoise'
import type { TerrainUniforms } from '../TerrainUniforms'
import { faceAxes } from '../tiles/tsl/cubeSphere'
import { tileVertex, type TileVertex } from '../tiles/tsl/tileVertex'
import type { Float, Vec2, Vec3, Vec4 } from '../tsl-types'
import { groundSurface } from './tsl/groundSurface'

/** True of the material that three draws shadow maps with. */
const isShadowPass = (material: object): boolean =>
  (material as { isShadowPassMaterial?: boolean }).isShadowPassMaterial === true

/** A value that vertices assign and pixels read. */
const handedOn = <T extends Node>(type: string, name: string): T & { assign(value: T): void } =>
  varyingProperty(type as never, `welkinTerrain${name}`) as unknown as T & {
    assign(value: T): void
  }

/**
 * Material of a terrain: vertices on the ground and normals at every pixel, by pages.
 *
 * @param grain - As of `grainTexture`.
 * @param resolution - Cells along a tile's edge.
 * @param detail - As of `TileTree`.
 */
export function terrainMaterial(
  atlas: PageAtlas,
  grain: Texture,
  uniforms: TerrainUniforms,
  resolution: number,
  detail: number
): MeshStandardNodeMaterial {
  const material = new MeshStandardNodeMaterial()
  material.name = 'Welkin.Terrain'
  material.metalness = 0
  const { reference, radii, stretch, seaLevel } = uniforms

  const handed = {
    place: handedOn<Vec3>('vec3', 'Place'),
    texels: handedOn<Vec2>('vec2', 'Texels'),
    pages: handedOn<Vec4>('vec4', 'Pages'),
    blend: handedOn<Vec4>('vec4', 'Blend')
  }
  material.positionNode = Fn(() => {
    const vertex: TileVertex = tileVertex(atlas, uniforms, resolution, detail)
    handed.place.assign(vertex.place)
    handed.texels.assign(vertex.texels)
    handed.pages.assign(vertex.pages)
    handed.blend.assign(vertex.blend)
    return vertex.position
  })()

  const { place: offset, texels, pages, blend } = handed
  const { width, height } = atlas.surface
  const face = blend.z.round().toConst('face') as Float
  // Samples at a tile's edge may lie beyond it, where another page is.
  const inPage = texels.clamp(0, atlas.surfaceSide - 1).toConst('inPage') as Vec2
  const page = texture(atlas.surface.texture)
  const pageAt = (texel: Vec2): Vec4 =>
    (page as unknown as { sample(uv: Vec2): { level(n: number): Vec4 } })
      .sample(texel.add(0.5).div(vec2(width, height)))
      .level(0)
  // Gradient along the face's axes, height and patchiness.
  const ground = Fn(() => {
    const mixed = pageAt(pages.xy.add(inPage)).toVar('page') as unknown as Vec4 & {
      assign(value: Vec4): void
    }
    If(blend.x.greaterThan(0), () => {
      const parent = pageAt(pages.zw.add(inPage.mul(0.5)))
      mixed.assign(mix(mixed, parent, blend.x))
    })
    return mixed
  })().toConst('ground') as unknown as Vec4
  const place = reference.mul(REFERENCE_STEP).add(offset)
  const up = place.div(radii).mul(stretch).normalize().toConst('up') as Vec3
  const { first, second } = faceAxes(face)
  const isLand = ground.z.greaterThan(seaLevel).select(1, 0) as unknown as Float
  // Two components of a vector along the ellipsoid tell the third.
  const outward = first.cross(second).toConst('outward')
  const along = first.mul(ground.x).add(second.mul(ground.y)).toConst('along')
  const gradient = along
    .sub(outward.mul(along.dot(up).div(outward.dot(up))))
    .mul(isLand)
    .toConst('gradient') as Vec3
  const cosSlope = gradient.dot(gradient).add(1).inverseSqrt().toConst('cosSlope') as Float
  const normal = up.sub(gradient).normalize().toConst('groundNormal') as Vec3
  const surface = groundSurface(
    {
      grain,
      reference,
      offset,
      normal,
      first,
      second,
      height: ground.z,
      patch: ground.w,
      climate: blend.y,
      up,
      cosSlope
    },
    seaLevel
  )
  // Shadow maps ask for its alpha, and need not wait for the rest.
  material.colorNode = Fn(({ material: drawn }: NodeBuilder) => {
    if (isShadowPass(drawn)) return vec4(1)
    // Ahead of the branches of near ground: each would find the page's texel and the normal anew.
    ;(surface.frame as unknown as { toStack(): void }).toStack()
    return vec4(surface.color, 1)
  })()
  material.roughnessNode = surface.roughness
  material.aoNode = surface.occlusion.mul(blend.w)
  material.normalNode = transformNormalToView(normal.sub(surface.grain).normalize())
  return material
}

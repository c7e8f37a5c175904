import {
  Fn,
  If,
  float,
  mat3,
  mix,
  sRGBTransferEOTF,
  texture,
  transformNormalToView,
  varying,
  varyingProperty,
  vec2,
  vec3,
  vec4
} from 'three/tsl'
import type { Texture } from 'three'
import type { Node, NodeBuilder } from 'three/webgpu'
import type { Atmosphere } from '@welkin/atmosphere'
import type { PageAtlas } from '../pages/PageAtlas'
import type { FixedOptions } from '../TerrainOptions'
import type { TerrainUniforms } from '../TerrainUniforms'
import { REFERENCE_STEP } from '../noise/tsl/latticeNoise'
import { faceAxes } from '../tiles/tsl/cubeSphere'
import type { ShaderFigure } from '../tiles/tsl/figure'
import { tilePages, tileVertex, type TileVertex } from '../tiles/tsl/tileVertex'
import type { Float, Variable, Vec2, Vec3, Vec4 } from '../tsl-types'
import type { GroundDetail } from './tsl/grain'
import { groundZone } from './tsl/groundRules'
import { groundSurface } from './tsl/groundSurface'
import {
  FOAM,
  FOAM_GONE,
  foamCover,
  seaSurface,
  waterColor,
  waterFresnel,
  windyVariance
} from './tsl/seaSurface'
import { GroundMaterial, viewDirection } from './GroundMaterial'
import { WaterMirrorNode } from './WaterMirrorNode'

/** True of the material that three draws shadow maps with. */
export const isShadowPass = (material: object | null): boolean =>
  material !== null && 'isShadowPassMaterial' in material

/** Varying: vertices assign it, pixels read it. */
const handedOn = <T extends Node>(type: string, name: string): T & { assign(value: T): void } =>
  varyingProperty(type as never, `welkinTerrain${name}`) as unknown as T & {
    assign(value: T): void
  }

/** Colour of imagery with the light of stones and blades, and the procedural colour where there is no imagery. */
const pictured = ({ rgb, a }: Vec4, made: Vec3, detail: Float): Vec3 => {
  const linear = sRGBTransferEOTF(rgb.div(a.max(1 / 255))) as unknown as Vec3
  return mix(made, linear.mul(detail), a)
}

/**
 * Material of a terrain: vertices on the ground and normals at every pixel, by pages.
 *
 * @param grain - As of `grainTexture`.
 * @param code - Detail that it has code for: code that is skipped costs time, too.
 */
export function terrainMaterial(
  atmosphere: Atmosphere,
  atlas: PageAtlas,
  grain: Texture,
  uniforms: TerrainUniforms,
  figure: ShaderFigure,
  { resolution, detail, maps, mask }: FixedOptions,
  code: GroundDetail = 2
): GroundMaterial {
  const material = new GroundMaterial()
  material.name = 'Welkin.Terrain'
  material.metalness = 0
  const { stretch, reference, seaLevel, seaVariance, waveTime, pole } = uniforms

  const offset = handedOn<Vec3>('vec3', 'Place')
  const texels = handedOn<Vec4>('vec4', 'Texels')
  const blend = handedOn<Vec4>('vec4', 'Blend')
  material.positionNode = Fn(() => {
    const vertex: TileVertex = tileVertex(atlas, uniforms, figure, resolution, detail)
    offset.assign(vertex.place)
    texels.assign(vec4(vertex.texels, groundZone(vertex.up.dot(pole))))
    blend.assign(vertex.blend)
    return vertex.position
  })()

  const pages = varying(tilePages(atlas, resolution)).setInterpolation('flat') as unknown as Vec4
  const { width, height } = atlas.surface
  const face = blend.z.round().toConst() as Float
  // Samples at a tile's edge may lie beyond it, where another page is.
  const inPage = texels.xy.clamp(0, atlas.surfaceSide - 1).toConst() as Vec2
  /** Texels of a texture of pages: of the tile's own page, and by its morph of its parent's. */
  const ofPages = (map: Texture): Vec4 => {
    const page = texture(map) as unknown as { sample(uv: Vec2): { level(n: number): Vec4 } }
    const at = (texel: Vec2): Vec4 => page.sample(texel.add(0.5).div(vec2(width, height))).level(0)
    return Fn(() => {
      const mixed = at(pages.xy.add(inPage)).toVar() as unknown as Vec4 & {
        assign(value: Vec4): void
      }
      If(blend.x.greaterThan(0), () => {
        mixed.assign(mix(mixed, at(pages.zw.add(inPage.mul(0.5))), blend.x))
      })
      return mixed
    })().toConst()
  }
  // Gradient along the face's axes, height and patchiness.
  const ground = ofPages(atlas.surface.texture)
  const picture = atlas.images === null ? null : ofPages(atlas.images.texture)
  // Of the place itself: a varying less.
  const up = figure.upAt(reference.mul(REFERENCE_STEP).add(offset), stretch).toConst() as Vec3
  const { first, second } = faceAxes(face)
  // Two components of a vector along the ellipsoid tell the third.
  const outward = first.cross(second).toConst()
  const along = first.mul(ground.x).add(second.mul(ground.y)).toConst()
  const gradient = along.sub(outward.mul(along.dot(up).div(outward.dot(up)))).toConst() as Vec3
  const cosSlope = gradient.dot(gradient).add(1).inverseSqrt().toConst() as Float
  // The gradient is at right angles to up.
  const normal = up.sub(gradient).mul(cosSlope).toConst() as Vec3
  const surface = groundSurface(
    {
      grain,
      reference,
      offset,
      normal,
      first,
      height: ground.z,
      patch: ground.w,
      climate: blend.y,
      up,
      pole,
      zone: texels.zw,
      cosSlope,
      hollow: blend.w.oneMinus()
    },
    seaLevel,
    {
      maps,
      paint: (layers, relief) => mask?.layersAt(layers, offset, figure.isFlat, relief) ?? layers
    },
    code
  )
  const depth = seaLevel.sub(ground.z).toConst() as Float
  const { footprint, spread } = surface
  const shore = { offset, depth, up, footprint, spread }
  const variance = windyVariance(seaVariance, blend.y)
  const sea = seaSurface(shore, variance, waveTime, code > 0)
  const { cover } = sea
  material.water = cover
  const dry = normal.sub(surface.grain)
  // Normal and roughness, and the variance of water's slopes: all that land does without is in one branch.
  const found = Fn(() => {
    const lit = dry.toVar() as unknown as Variable<Vec3>
    const rough = vec3(surface.roughness).toVar() as unknown as Variable<Vec3>
    If(cover.greaterThan(0), () => {
      lit.assign(mix(lit, up.sub(sea.slope), cover))
      const ofWater = sea.variance.sqrt().sqrt()
      rough.assign(vec3(mix(rough.x, ofWater, cover), sea.variance, 0))
    })
    return mat3(lit, rough, vec3(0))
  })().toConst() as unknown as { element(i: number): Vec3 }
  const { x: roughness, y: unresolved } = found.element(1)
  const litView = (transformNormalToView(found.element(0)) as unknown as Vec3).toConst()
  // Shadow maps ask for its alpha, and need not wait for the rest.
  material.colorNode = Fn(({ material: drawn }: NodeBuilder) => {
    if (isShadowPass(drawn)) return vec4(1)
    // Ahead of the branches of water: each would find waves and normals anew.
    ;(litView as unknown as { toStack(): void }).toStack()
    const made = surface.color
    const color = (picture === null
      ? made
      : pictured(picture, made, surface.detail.mul(uniforms.imageAlbedo))
    ).toVar() as unknown as Variable<Vec3>
    If(cover.greaterThan(0), () => {
      const cosViewer = litView.dot(viewDirection()).max(0).toConst() as Float
      const entering = waterFresnel(cosViewer, unresolved).oneMinus()
      color.assign(mix(color, waterColor(color, depth).mul(entering), cover))
      if (code === 0) return
      If(footprint.lessThan(FOAM_GONE), () => {
        const foam = foamCover(shore, surface.tangle, ground.w, waveTime)
        color.assign(mix(color, vec3(FOAM), foam.mul(cover)))
      })
    })
    return vec4(color, 1)
  })()
  // Beckmann's α² is the variance of slopes.
  material.roughnessNode = roughness
  material.aoNode = mix(surface.occlusion, float(1), cover).mul(blend.w)
  material.normalNode = litView
  material.ground = transformNormalToView(normal)
  const water = { cover, normal: litView, variance: unresolved }
  material.emissiveNode = new WaterMirrorNode(atmosphere, water)
  return material
}

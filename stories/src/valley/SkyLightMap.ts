import { tableTarget } from '@welkin/atmosphere'
import {
  BufferGeometry,
  Float32BufferAttribute,
  type Light,
  Mesh,
  type PerspectiveCamera,
  PlaneGeometry,
  Scene
} from 'three'
import {
  attribute,
  float,
  Fn,
  lights,
  normalWorldGeometry,
  positionWorld,
  texture,
  uniform,
  vec2,
  vec3,
  vec4
} from 'three/tsl'
import { MeshLambertNodeMaterial, PhongLightingModel, RendererUtils } from 'three/webgpu'
import type { Node, NodeBuilder, WebGPURenderer } from 'three/webgpu'
import { mergeGeometries } from 'three/addons/utils/BufferGeometryUtils.js'
import { type LightsBuilder, received, sumOfLit } from './litLights'

type Vec3 = Node<'vec3'>

/** Edge of the square that the map covers, and its middle along the valley [m]. */
const WIDTH = 26_000
const MIDDLE = -3500

/** Texels along an edge: clouds' mean light changes over kilometres, and that of heights little from one to the next. */
const SIZE = 96

/** Quads of the land under it along an edge. */
const QUADS = 64

/** Directions in which planes of a place look: their light is that of any other plane between them. */
const FACES = [
  [1, 0, 0],
  [-1, 0, 0],
  [0, 1, 0],
  [0, -1, 0],
  [0, 0, 1],
  [0, 0, -1]
] as const

/** Frames at the start in which it is drawn: stills have few, and clouds have no weather in the first. */
const WHOLE_FRAMES = 10

/** Frames from one drawing to the next. */
const EVERY = 8

/** Light from all sides alone: what a white plane has of the lights that are on. */
class IrradianceModel extends PhongLightingModel {
  constructor() {
    super(false)
  }

  override start(builder: NodeBuilder): void {
    const lit = builder as unknown as LightsBuilder
    lit.context.irradiance.addAssign(sumOfLit(received(lit)))
    this.indirect(builder)
  }
}

/** A material of places of the land, each drawn where the map has it. */
class MappedLightMaterial extends MeshLambertNodeMaterial {
  override setupLightingModel(): PhongLightingModel {
    return new IrradianceModel()
  }

  // Unlike a `vertexNode` it leaves positions where they are.
  override setupModelViewProjection(): Node<'vec4'> {
    return vec4(attribute<'vec2'>('place', 'vec2').mul(2).sub(1), 0, 1)
  }
}

/** Land under one tile of the map, for planes that look in one direction. */
function tileOf(land: PlaneGeometry, face: number): BufferGeometry {
  const { position, uv } = land.attributes
  const tile = new BufferGeometry().setAttribute('position', position.clone())
  const places = Float32Array.from({ length: 2 * uv.count }, (_, i) => {
    const at = Math.floor(i / 2)
    return i % 2 === 0 ? (face + uv.getX(at)) / FACES.length : uv.getY(at)
  })
  const normals = Float32Array.from({ length: 3 * uv.count }, (_, i) => FACES[face][i % 3])
  tile.setAttribute('place', new Float32BufferAttribute(places, 2))
  tile.setAttribute('normal', new Float32BufferAttribute(normals, 3))
  return tile.setIndex(land.index)
}

/**
 * Light of the sky on the land, for materials to read: clouds in it make a shader longer than all else of the valley does, and
 * one small map has that shader alone.
 *
 * It has planes of six directions. Between them, moments of degree 0 and 1 are exact, and of degree 2 those along the axes:
 * E(n) = ½ Σ n_i² (E₊ + E₋) + n_i (E₊ − E₋), like an ambient cube (McTaggart 2004, "Half-Life 2 / Valve source shading").
 */
export class SkyLightMap {
  readonly #target = tableTarget('SkyLightMap', FACES.length * SIZE, SIZE)
  readonly #scene = new Scene()
  readonly #material = new MappedLightMaterial()
  readonly #mesh: Mesh
  #frames = 0
  /** Luminance scale of the light in the map, and that of the next picture over it. */
  #kept = 1
  readonly #gain = uniform(1)

  /**
   * @param probes - Lights that come from all sides.
   * @param heightAt - Height of the land at a place [m].
   */
  constructor(probes: readonly Light[], heightAt: (x: number, z: number) => number) {
    const land = new PlaneGeometry(1, 1, QUADS, QUADS)
    const { position, uv } = land.attributes
    for (let i = 0; i < position.count; i++) {
      const x = (uv.getX(i) - 0.5) * WIDTH
      // As in a picture, the first row is the last along v.
      const z = (0.5 - uv.getY(i)) * WIDTH + MIDDLE
      position.setXYZ(i, x, heightAt(x, z), z)
    }
    const tiles = FACES.map((_, face) => tileOf(land, face))
    land.dispose()
    const material = this.#material
    material.colorNode = vec3(Math.PI) // of which Lambert's model gives back the light itself
    material.lightsNode = lights([...probes]) as never
    material.depthTest = material.depthWrite = false
    material.fog = false
    this.#mesh = new Mesh(mergeGeometries(tiles), material)
    this.#mesh.frustumCulled = false
    this.#scene.name = 'SkyLightMap'
    this.#scene.add(this.#mesh)
  }

  /** Has it drawn with the next frame: the light is another now. */
  reset(): void {
    this.#frames = Math.min(this.#frames, WHOLE_FRAMES - 1)
  }

  /** Draws it, in one of some frames. */
  update(renderer: WebGPURenderer, camera: PerspectiveCamera, luminanceScale: number): void {
    const frame = this.#frames++
    if (frame < WHOLE_FRAMES || frame % EVERY === 0) {
      this.#kept = luminanceScale
      const state = RendererUtils.resetRendererState(renderer, {} as never)
      renderer.autoClear = false
      renderer.setRenderTarget(this.#target)
      renderer.render(this.#scene, camera)
      RendererUtils.restoreRendererState(renderer, state)
    }
    this.#gain.value = luminanceScale / this.#kept
  }

  /** Light on the surface that is drawn, by its place and normal. */
  sample(): Vec3 {
    return Fn(() => {
      const { x, z } = positionWorld
      const at = vec2(x, z.sub(MIDDLE)).div(WIDTH).add(0.5)
      const inside = at.clamp(0.5 / SIZE, 1 - 0.5 / SIZE).toConst()
      const normal = normalWorldGeometry.toConst()
      const sum = vec3(0).toVar()
      for (const [axis, part] of (['x', 'y', 'z'] as const).entries()) {
        const [towards, away] = [0, 1].map(side => {
          const place = vec2(inside.x.add(2 * axis + side).div(FACES.length), inside.y)
          const light = texture(this.#target.texture, place).level(float(0))
          return (light as unknown as Node<'vec4'>).rgb
        })
        const along = normal[part]
        sum.addAssign(towards.mul(along.mul(along.add(1)).mul(0.5)))
        sum.addAssign(away.mul(along.mul(along.sub(1)).mul(0.5)))
      }
      return sum.max(0).mul(this.#gain)
    })()
  }

  /** Frees what it draws with. */
  dispose(): void {
    this.#target.dispose()
    this.#mesh.geometry.dispose()
    this.#material.dispose()
  }
}

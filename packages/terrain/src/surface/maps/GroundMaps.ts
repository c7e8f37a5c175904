import {
  LinearFilter,
  LinearMipmapLinearFilter,
  RenderTarget,
  RepeatWrapping,
  SRGBColorSpace
} from 'three'
import type { Texture } from 'three'
import { checkRange, FragmentPass, vector3Uniform, withDefaults } from '@welkin/atmosphere'
import { checkOptions, checkPositive, fail } from '@welkin/geo'
import type { Renderer } from 'three/webgpu'
import type { GrainPlace } from '../tsl/grain'
import type { GroundColors, GroundLayers } from '../tsl/groundRules'
import { mappedGround, type MappedGround, type MappedLayer } from '../tsl/mappedGround'
import { GROUND_KINDS, type GroundKind } from './groundKinds'
import { colorLayer, reliefLayer, type MaterialMaps } from './packMaps'

/** Options of `GroundMaps`. */
export interface GroundMapsOptions {
  /** Texels along the side of a material, a power of two in [16, 4096], default 1024: maps of other sizes are drawn to it. */
  size?: number
}

const DEFAULTS: Required<GroundMapsOptions> = { size: 1024 }
const NAMES = ['albedo', 'normal', 'roughness', 'ao', 'height'] as const
const DEFAULT_SIDE = 2
const DEFAULT_RELIEF = 0.05

/** Number of times that maps have changed; null while one of them has not loaded yet. */
function versionOf(maps: MaterialMaps): number | null {
  let sum = 0
  for (const name of NAMES) {
    const map = maps[name]
    if (map === undefined) continue
    const isThere = map.isRenderTargetTexture || map.version > 0
    if (!isThere) return null
    sum += map.version
  }
  return sum
}

function checkMaps(kind: string, maps: MaterialMaps): void {
  const where = 'GroundMaps'
  if (!GROUND_KINDS.includes(kind as GroundKind)) {
    fail(where, `materials are ${GROUND_KINDS.join(', ')}`, kind)
  }
  checkOptions(where, maps, ...NAMES, 'side', 'relief')
  for (const name of NAMES) {
    const map = maps[name]
    const isMissing = map === undefined && name !== 'albedo'
    if (!isMissing && map?.isTexture !== true) fail(where, `${kind}.${name} must be a Texture`, map)
  }
  checkPositive(where, `${kind}.side`, maps.side ?? DEFAULT_SIDE)
  checkRange(where, `${kind}.relief`, maps.relief ?? DEFAULT_RELIEF, 0, 1)
}

function arrayTarget(size: number, layers: number): RenderTarget {
  const target = new RenderTarget(size, size, {
    depth: layers,
    depthBuffer: false,
    generateMipmaps: true,
    minFilter: LinearMipmapLinearFilter,
    magFilter: LinearFilter,
    wrapS: RepeatWrapping,
    wrapT: RepeatWrapping,
    anisotropy: 8,
    // sRGB has finer steps where it is dark. The GPU encodes and decodes it: what is read is linear.
    colorSpace: SRGBColorSpace
  })
  target.texture.name = 'Welkin.Terrain.maps'
  target.texture.isArrayTexture = true
  return target
}

/**
 * Texture maps of the ground's materials, in place of procedural ones; materials without maps stay procedural.
 *
 * ```ts
 * const load = (name: string) => new TextureLoader().load(name)
 * const albedo = load('rock.jpg')
 * albedo.colorSpace = SRGBColorSpace
 * const maps = new GroundMaps({ rock: { albedo, normal: load('rockNormal.png'), side: 3 } })
 * const terrain = new Terrain(atmosphere, heights, { maps })
 * ```
 *
 * All maps lie in one texture array, drawn when they have arrived and again when they change: however many materials there are, the ground samples one texture
 * for them. A material is procedural until all of its maps have loaded.
 */
export class GroundMaps {
  /** Texels along the side of a material. */
  readonly size: number
  /** Materials that have maps, in the order of the array's layers. */
  readonly layers: readonly MappedLayer[]
  readonly #maps: readonly MaterialMaps[]
  readonly #versions: (number | null)[]
  readonly #target: RenderTarget
  #renderer: Renderer | null = null

  /** @throws If a material is unknown, or an option is out of its range. */
  constructor(
    materials: Partial<Record<GroundKind, MaterialMaps>>,
    options: GroundMapsOptions = {}
  ) {
    const { size } = withDefaults('GroundMaps', DEFAULTS, options)
    checkRange('GroundMaps', 'size', size, 16, 4096)
    if (!Number.isInteger(Math.log2(size))) fail('GroundMaps', 'size must be a power of two', size)
    const given = Object.entries(materials).filter(([, maps]) => maps !== undefined)
    if (given.length === 0) fail('GroundMaps', 'at least one material needs maps', materials)
    for (const [kind, maps] of given) checkMaps(kind, maps)
    this.size = size
    this.#maps = given.map(([, maps]) => maps)
    this.#versions = given.map(() => null)
    this.layers = given.map(([kind, { side, relief }]) => {
      const state = vector3Uniform()
      state.value.set(0, 1 / (side ?? DEFAULT_SIDE), relief ?? DEFAULT_RELIEF)
      return { kind: kind as GroundKind, state }
    })
    this.#target = arrayTarget(size, 2 * given.length)
  }

  /** Two layers for a material: reflectance with the share of the sky's light, and slopes along both sides, roughness and height. */
  get texture(): Texture {
    return this.#target.texture
  }

  /** Memory on the GPU [bytes]. */
  get bytes(): number {
    return Math.ceil((4 * this.size ** 2 * this.#target.depth * 4) / 3)
  }

  /** Draws maps that have arrived or changed; a terrain calls it by itself. The renderer is left as it was. */
  update(renderer: Renderer): void {
    if (renderer !== this.#renderer) {
      this.#renderer = renderer
      this.#versions.fill(null)
    }
    for (const [n, maps] of this.#maps.entries()) {
      const version = versionOf(maps)
      this.layers[n].state.value.x = version === null ? 0 : 1
      if (version === null || version === this.#versions[n]) continue
      this.#versions[n] = version
      this.#draw(renderer, maps, n)
    }
  }

  /** Nodes of the ground at a place, for a terrain's material; see `mappedGround`. */
  groundAt(place: GrainPlace, layers: GroundLayers, colors: GroundColors): MappedGround {
    return mappedGround(this, place, layers, colors)
  }

  #draw(renderer: Renderer, maps: MaterialMaps, layer: number): void {
    for (const [n, output] of [colorLayer(maps), reliefLayer(maps)].entries()) {
      const pass = new FragmentPass(this.texture.name, output)
      pass.render(renderer, this.#target, 2 * layer + n)
      pass.dispose()
    }
  }

  /** Frees the array; textures are the user's. A terrain that has them must be disposed of before. */
  dispose(): void {
    this.#target.dispose()
    this.#renderer = null
  }
}

import { Box3, NearestFilter, NearestMipmapNearestFilter, Vector3, type CubeTexture } from 'three'
import { cubeTexture, pmremTexture, positionWorldDirection, uniform } from 'three/tsl'
import { PMREMGenerator } from 'three/webgpu'
import type { CubeRenderTarget, Node, Renderer } from 'three/webgpu'
import { CubeFaces } from './CubeFaces'

/** Passes of three's filter that run together. */
interface Part {
  /** Level of the map that they draw; −1 for those that prepare its source. */
  level: number
  /** Faces that they draw, from … to (exclusive). */
  from: number
  to: number
}

/** Texels of a level, of 256 samples each, that a part draws: 0.8 ms of an H100. */
const TEXELS = 2 * 128 * 128

const _faces = new Box3(new Vector3())

/** Cheapest part: drawing it allocates a map on the GPU. */
const ALLOCATION: Part = { level: 0, from: 0, to: 1 }

/** The parts of a map, in the order that the filter draws them in. */
function partsOf({ texture: { mipmaps } }: CubeRenderTarget): Part[] {
  const parts: Part[] = [{ level: -1, from: 0, to: 6 }]
  mipmaps.forEach(({ width }, level) => {
    // The first level is a copy.
    const faces = level === 0 ? 6 : Math.min(Math.max(Math.floor(TEXELS / width ** 2), 1), 6)
    for (let from = 0; from < 6; from += faces) parts.push({ level, from, to: from + faces })
  })
  return parts
}

/**
 * A cube filtered for materials by three's `PMREMGenerator`, a part of its passes at a time.
 *
 * The generator draws all levels of a map at once. Here it runs for every part anew, on a stand-in for
 * the renderer that lets only the passes of that part through. What comes out is what the generator
 * itself makes of the cube, to the bit.
 *
 * A map is made out of sight, and copied in one go to the one that materials see when it is complete: so
 * they sample a single texture. Swapping textures would not reach all materials.
 */
export class PrefilteredCube {
  readonly #source: CubeTexture
  /** The map that materials see, and the one that is made. */
  #maps: [shown: CubeRenderTarget, made: CubeRenderTarget] | null = null
  readonly #copy = new CubeFaces('Welkin.SkyEnvironment.copy')
  readonly #level = uniform(0)
  #parts: Part[] = []
  #next = 0
  #renderer: Renderer | null = null
  #generator: PMREMGenerator | null = null
  /** Passes that are let through; null for all. */
  #part: Part | null = null
  #target: CubeRenderTarget | null = null
  #node: Node | null = null

  /** @param source - The cube, 256 texels wide or more. */
  constructor(source: CubeTexture) {
    this.#source = source
  }

  /** Map that materials mirror, once there is one. */
  get node(): Node | null {
    return this.#node
  }

  /** Filters all of the cube now. */
  filterAll(renderer: Renderer): void {
    this.#allocate(renderer)
    this.#run(null)
    this.#finish(renderer)
  }

  /**
   * Filters the next part of the cube, which must not change from the first part on.
   *
   * @returns True if that was the last.
   */
  filterNext(renderer: Renderer): boolean {
    this.#allocate(renderer)
    this.#run(this.#parts[this.#next++])
    if (this.#next < this.#parts.length) return false
    this.#finish(renderer)
    return true
  }

  /** Starts again with the first part. */
  restart(): void {
    this.#next = 0
  }

  /** Copies the finished map to the one that materials see. */
  #finish(renderer: Renderer): void {
    this.#next = 0
    if (this.#maps === null) return
    const [shown, made] = this.#maps
    const { isWebGPUBackend: canCopy } = renderer.backend as { isWebGPUBackend?: boolean }
    shown.texture.mipmaps.forEach(({ width, height }, level) => {
      if (canCopy) {
        _faces.max.set(width, height, 6)
        renderer.copyTextureToTexture(made.texture, shown.texture, _faces, null, level, level)
        return
      }
      // three copies no cubes on WebGL.
      this.#level.value = level
      for (let face = 0; face < 6; face++) this.#copy.draw(renderer, shown, face, level)
    })
  }

  #run(part: Part | null, target = this.#maps?.[1] ?? null): void {
    this.#part = part
    this.#target = target
    this.#generator?.fromCubemap(this.#source, this.#target)
  }

  #allocate(renderer: Renderer): void {
    if (this.#renderer === renderer) return
    this.#generator?.dispose()
    this.#renderer = renderer
    const generator = new PMREMGenerator(this.#gate(renderer))
    this.#generator = generator
    this.#next = 0
    if (this.#maps === null) {
      this.#part = { level: 0, from: 0, to: 0 }
      const make = (): CubeRenderTarget => generator.fromCubemap(this.#source)
      const [shown, made] = (this.#maps = [make(), make()])
      this.#parts = partsOf(shown)
      // Read texel by texel, by the copy alone.
      made.texture.minFilter = NearestMipmapNearestFilter
      made.texture.magFilter = NearestFilter
      this.#node = pmremTexture(shown.texture)
      this.#copy.shader = cubeTexture(made.texture, positionWorldDirection, this.#level)
    }
    // The map that materials see is bound before it is copied to.
    this.#run(ALLOCATION, this.#maps[0])
  }

  /** The renderer, but for the passes that it is not the turn of. */
  #gate(renderer: Renderer): Renderer {
    const render: Renderer['render'] = (...scene) => {
      if (this.#isDue(renderer)) renderer.render(...scene)
    }
    return new Proxy(renderer, {
      get: (_, key) => {
        if (key === 'render') return render
        const value: unknown = Reflect.get(renderer, key)
        return typeof value === 'function' ? (value.bind(renderer) as unknown) : value
      }
    })
  }

  #isDue(renderer: Renderer): boolean {
    if (this.#part === null) return true
    const { level, from, to } = this.#part
    const isMap = renderer.getRenderTarget() === this.#target
    if (!isMap || level < 0) return isMap === level >= 0
    const face = renderer.getActiveCubeFace()
    return renderer.getActiveMipmapLevel() === level && face >= from && face < to
  }

  /** Frees GPU memory; it can be used again. */
  dispose(): void {
    for (const map of this.#maps ?? []) map.dispose()
    this.#copy.dispose()
    this.#generator?.dispose()
    this.#generator = this.#renderer = null
  }
}

import {
  LinearFilter,
  LinearMipmapLinearFilter,
  RenderTarget3D,
  RepeatWrapping,
  RGBAFormat,
  RGFormat,
  UnsignedByteType
} from 'three'
import type { Data3DTexture, PixelFormat } from 'three'
import { checkOwner, FragmentPass } from '@welkin/atmosphere'
import { Fn, float, texture3D, uniform, uv, vec3, vec4 } from 'three/tsl'
import type { Renderer, UniformNode } from 'three/webgpu'
import { NOISE_SIZE } from './noiseSizes'
import { detailChannel, shapeChannels, weatherChannels } from './noiseRecipes'
import { channelNoise, curlNoise } from './tsl/noiseChannels'
import type { LevelTexture, Vec3, Vec4 } from '../tsl-types'

function noiseTarget(name: string, size: number, format: PixelFormat, mips: boolean) {
  const target = new RenderTarget3D(size, size, size, {
    type: UnsignedByteType,
    format,
    depthBuffer: false,
    minFilter: mips ? LinearMipmapLinearFilter : LinearFilter,
    magFilter: LinearFilter
  })
  // The types know no wrapR on it.
  const texture = target.texture as unknown as Data3DTexture
  texture.name = name
  texture.wrapS = texture.wrapT = texture.wrapR = RepeatWrapping
  // Levels are drawn here: three makes none for 3-D textures.
  texture.generateMipmaps = mips
  texture.mipmapsAutoUpdate = false
  return target
}

/** A texture of noise, filled slice by slice, level by level. */
class NoiseTexture {
  readonly target: RenderTarget3D
  readonly #size: number
  readonly #format: PixelFormat
  readonly #slice: UniformNode<'float', number> = uniform(0)
  readonly #noise: FragmentPass

  constructor(name: string, size: number, format: PixelFormat, noise: (p: Vec3) => Vec4) {
    this.#size = size
    this.#format = format
    this.target = noiseTarget(`Welkin.CloudNoise.${name}`, size, format, true)
    this.#noise = new FragmentPass(
      `Welkin.CloudNoise.${name}`,
      Fn(() => noise(vec3(uv(), this.#slice).toConst()))()
    )
  }

  *#draw(renderer: Renderer, pass: FragmentPass, target: RenderTarget3D, level: number) {
    const slices = this.#size >> level
    const targetLevel = target === this.target ? level : 0
    for (let slice = 0; slice < slices; slice++) {
      this.#slice.value = (slice + 0.5) / slices
      pass.render(renderer, target, slice, targetLevel)
      yield
    }
  }

  /** Draws all texels, a slice a step. */
  *bake(renderer: Renderer): Generator<void, void, void> {
    yield* this.#draw(renderer, this.#noise, this.target, 0)
    let finer = this.target
    // A level is made outside of the texture and copied in: nothing may be read while it is drawn to.
    for (let level = 1; this.#size >> level > 0; level++) {
      const scratch = noiseTarget(
        'Welkin.CloudNoise.level',
        this.#size >> level,
        this.#format,
        false
      )
      const from = (source: RenderTarget3D): FragmentPass => {
        const node = texture3D(source.texture) as unknown as LevelTexture<Vec3>
        // Between texels, the filter is the mean of eight.
        const mean = node.sample(vec3(uv(), this.#slice)).level(float(0))
        return new FragmentPass('Welkin.CloudNoise.level', mean)
      }
      const passes = [from(finer), from(scratch)]
      try {
        yield* this.#draw(renderer, passes[0], scratch, level)
        yield* this.#draw(renderer, passes[1], this.target, level)
      } finally {
        for (const pass of passes) pass.dispose()
        if (finer !== this.target) finer.dispose()
      }
      finer = scratch
    }
    finer.dispose()
  }

  dispose(): void {
    this.target.dispose()
    this.#noise.dispose()
  }
}

/**
 * The noise that clouds are made of: three tileable 3-D textures with levels of detail, drawn on the
 * GPU in fragment passes. About 6 MB.
 *
 * Weather is a volume too, of which the planet's surface is a slice: it has neither seams nor poles,
 * and since the lattice lies askew to the ground, no two tiles of it look alike.
 */
export class CloudNoise {
  /** Perlin–Worley and finer billows, by `shapeChannels`. */
  readonly shape = new NoiseTexture('shape', NOISE_SIZE.shape, RGFormat, p =>
    vec4(channelNoise(shapeChannels[0], 0, p), channelNoise(shapeChannels[1], 1, p), 0, 1)
  )
  /** Billows and curl. */
  readonly detail = new NoiseTexture('detail', NOISE_SIZE.detail, RGBAFormat, p => {
    const curl = curlNoise(p).toConst()
    return vec4(channelNoise(detailChannel, 2, p), curl.x, curl.y, curl.z)
  })
  /** Weather, by `weatherChannels`. */
  readonly weather = new NoiseTexture('weather', NOISE_SIZE.weather, RGBAFormat, p => {
    const [r, g, b, a] = weatherChannels.map((channel, i) => channelNoise(channel, 3 + i, p))
    return vec4(r, g, b, a)
  })
  readonly #textures = [this.weather, this.shape, this.detail]
  #steps: Generator<void, void, void> | null = null
  #isReady = false
  #renderer: Renderer | null = null

  /** Whether all texels are drawn. */
  get isReady(): boolean {
    return this.#isReady
  }

  /** Bytes of GPU memory that the finished textures take. */
  get bytes(): number {
    const { shape, detail, weather } = NOISE_SIZE
    // A level has an eighth of the texels of the one before, down to one.
    const texels = (size: number): number => (8 * size ** 3 - 1) / 7
    return 2 * texels(shape) + 4 * (texels(detail) + texels(weather))
  }

  /**
   * Draws what is missing.
   *
   * @param slices - How many slices at most.
   * @returns Whether all texels are drawn.
   * @throws If another renderer drew the noise that was not disposed of.
   */
  update(renderer: Renderer, slices = Infinity): boolean {
    if (renderer !== this.#renderer) {
      checkOwner('CloudNoise', this.#renderer, renderer)
      // Textures went with the renderer before.
      if (this.#renderer !== null) this.#restart()
      this.#renderer = renderer
    }
    this.#steps ??= this.#bake(renderer)
    for (let i = 0; i < slices && !this.#isReady; i++) {
      this.#isReady = this.#steps.next().done === true
    }
    return this.#isReady
  }

  #restart(): void {
    this.#steps?.return()
    this.#steps = null
    this.#isReady = false
  }

  *#bake(renderer: Renderer): Generator<void, void, void> {
    for (const noise of this.#textures) yield* noise.bake(renderer)
  }

  /** Frees the textures; the next update draws them anew. */
  dispose(): void {
    this.#restart()
    this.#renderer = null
    for (const noise of this.#textures) noise.dispose()
  }
}

import {
  LinearFilter,
  LinearMipmapLinearFilter,
  RenderTarget3D,
  RepeatWrapping,
  RedFormat,
  RGBAFormat,
  UnsignedByteType
} from 'three'
import type { Data3DTexture, PixelFormat } from 'three'
import { checkOwner, FragmentPass } from '@welkin/atmosphere'
import { checkOptions, fail } from '@welkin/geo'
import { Fn, float, texture3D, uniform, uv, vec3, vec4 } from 'three/tsl'
import type { Renderer, UniformNode } from 'three/webgpu'
import { NOISE_SIZE, type NoiseName } from './noiseSizes'
import {
  FIRST_CHANNEL,
  detailChannel,
  shapeChannels,
  weatherChannels,
  type NoiseChannel
} from './noiseRecipes'
import { channelNoise, curlNoise } from './tsl/noiseChannels'
import type { Float, LevelTexture, Vec3, Vec4 } from '../tsl-types'

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

/**
 * Time that a slice of each texture's finest level takes, in slices of the shape. Coarser levels take
 * little of the GPU, but as many passes.
 */
const SLICE_COST = { shape: 1, weather: 0.3, detail: 0.16, level: 0.12 } as const

/** A texture of noise, filled slice by slice, level by level. */
class NoiseTexture {
  readonly target: RenderTarget3D
  readonly #cost: number
  readonly #slice: UniformNode<'float', number> = uniform(0)
  readonly #noise: FragmentPass

  constructor(name: NoiseName, format: PixelFormat, noise: (p: Vec3) => Vec4) {
    this.#cost = SLICE_COST[name]
    this.target = noiseTarget(`Welkin.CloudNoise.${name}`, NOISE_SIZE[name], format, true)
    this.#noise = new FragmentPass(
      `Welkin.CloudNoise.${name}`,
      Fn(() => noise(vec3(uv(), this.#slice).toConst()))()
    )
  }

  *#draw(
    renderer: Renderer,
    pass: FragmentPass,
    target: RenderTarget3D,
    level: number
  ): Generator<number, void, void> {
    const slices = this.target.width >> level
    const targetLevel = target === this.target ? level : 0
    const cost = level === 0 ? this.#cost : SLICE_COST.level
    for (let slice = 0; slice < slices; slice++) {
      this.#slice.value = (slice + 0.5) / slices
      pass.render(renderer, target, slice, targetLevel)
      yield cost
    }
  }

  /** Draws all texels, a slice a step, of which it tells the cost. */
  *bake(renderer: Renderer): Generator<number, void, void> {
    yield* this.#draw(renderer, this.#noise, this.target, 0)
    let finer = this.target
    // A level is made outside of the texture and copied in: nothing may be read while it is drawn to.
    const { width, texture } = this.target
    const format = texture.format as PixelFormat
    for (let level = 1; width >> level > 0; level++) {
      const scratch = noiseTarget('Welkin.CloudNoise.level', width >> level, format, false)
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

/** Channels of a recipe at a place in the texture. */
const channelsAt = (channels: readonly NoiseChannel[], first: number, p: Vec3): Float[] =>
  channels.map((channel, i) => channelNoise(channel, first + i, p))

/**
 * Noise at a place in a texture of it, of which each coordinate is in [0, 1] and that repeats without seams: a function
 * that builds its node, such as `noiseVolume(texture)`.
 */
export type NoiseFunction = (place: Vec3) => Vec4

/** Noise of one's own in place of a {@link CloudNoise}'s; what is left out is its own. */
export interface CloudNoiseOptions {
  /**
   * Weather of single clouds: cumulus, stratocumulus, cumulonimbus and cirrus, as `weatherWeights` mixes them.
   * Where it is greater, there is cloud sooner. Every value in [0, 1] is as frequent as any other: so a `coverage` of
   * 0.3 covers 0.3 of the sky.
   */
  weather?: NoiseFunction
  /**
   * Billows and turbulence: coarse billows, four along an edge; fine ones, sixteen; and two components of a curl.
   * Each is 0.5 + 0.18 z, with a z of mean 0 and standard deviation 1.
   */
  shape?: NoiseFunction
  /** Finest billows, six along an edge, in the first component: 0.5 + 0.18 z, as in `shape`. */
  detail?: NoiseFunction
}

/**
 * The noise that clouds are made of: three tileable 3-D textures with levels of detail, drawn on the
 * GPU in fragment passes. About 11 MB.
 *
 * Weather is a volume too, of which the planet's surface is a slice: it has neither seams nor poles,
 * and since the lattice is tilted against the ground, no two tiles of it look alike.
 *
 * ```ts
 * const noise = new CloudNoise({ shape: noiseVolume(billows) })
 * clouds(air, depth, camera, atmosphere, layers, { noise })
 * ```
 */
export class CloudNoise {
  /** Coarse and fine billows, by `shapeChannels`, and two components of a curl. */
  readonly shape: NoiseTexture
  /** Finest billows, by `detailChannel`. */
  readonly detail: NoiseTexture
  /** Weather, by `weatherChannels`. */
  readonly weather: NoiseTexture
  readonly #textures: readonly NoiseTexture[]
  #steps: Generator<number, void, void> | null = null
  #isReady = false
  #renderer: Renderer | null = null

  /**
   * @param options - Noise of one's own. It is drawn into the textures as any other: after a change, call `dispose`.
   * @throws If one of them is no function.
   */
  constructor(options: CloudNoiseOptions = {}) {
    checkOptions('CloudNoise', options, ...(Object.keys(NOISE_SIZE) as NoiseName[]))
    const make = (name: NoiseName, format: PixelFormat, noise: NoiseFunction): NoiseTexture => {
      const { [name]: own = noise } = options
      if (typeof own !== 'function') fail('CloudNoise', `${name} must be a function`, own)
      return new NoiseTexture(name, format, own)
    }
    this.shape = make('shape', RGBAFormat, p => {
      const [coarse, fine] = channelsAt(shapeChannels, FIRST_CHANNEL.shape, p)
      return vec4(coarse, fine, curlNoise(FIRST_CHANNEL.shape + shapeChannels.length, p))
    })
    this.detail = make('detail', RedFormat, p =>
      vec4(vec3(channelNoise(detailChannel, FIRST_CHANNEL.detail, p)), 1)
    )
    this.weather = make('weather', RGBAFormat, p => {
      const [r, g, b, a] = channelsAt(weatherChannels, FIRST_CHANNEL.weather, p)
      return vec4(r, g, b, a)
    })
    this.#textures = [this.weather, this.shape, this.detail]
  }

  /** True once all texels are drawn. */
  get isReady(): boolean {
    return this.#isReady
  }

  /**
   * Draws what is missing.
   *
   * @param slices - Slices of the shape to draw, or as many others as cost the same.
   * @returns True once all texels are drawn.
   * @throws If the noise belongs to another renderer that has not been disposed of.
   */
  update(renderer: Renderer, slices = Infinity): boolean {
    if (renderer !== this.#renderer) {
      checkOwner('CloudNoise', this.#renderer, renderer)
      // The textures were those of the renderer before.
      if (this.#renderer !== null) this.#restart()
      this.#renderer = renderer
    }
    this.#steps ??= this.#bake(renderer)
    for (let spent = 0; spent < slices && !this.#isReady;) {
      const step = this.#steps.next()
      this.#isReady = step.done === true
      spent += step.value ?? 0
    }
    return this.#isReady
  }

  #restart(): void {
    this.#steps?.return()
    this.#steps = null
    this.#isReady = false
  }

  *#bake(renderer: Renderer): Generator<number, void, void> {
    for (const noise of this.#textures) yield* noise.bake(renderer)
  }

  /** Frees the textures; the next update draws them anew. */
  dispose(): void {
    this.#restart()
    this.#renderer = null
    for (const noise of this.#textures) noise.dispose()
  }
}

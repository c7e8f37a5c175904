import {
  aerialPerspectiveTo,
  FragmentPass,
  tableTarget,
  type AtmosphereView
} from '@welkin/atmosphere'
import { Vector3, Vector4 } from 'three'
import { Fn, If, float, int, mix, texture, uv, vec2, vec3, vec4 } from 'three/tsl'
import type { Renderer } from 'three/webgpu'
import type { CloudsNode } from '../march/CloudsNode'
import { unpack } from '../temporal/tsl/packing'
import { viewRayAt, viewRayEnd } from '../march/tsl/viewRay'
import {
  loop,
  vec4Array,
  type Float,
  type Int,
  type LevelTexture,
  type Variable,
  type Vec2,
  type Vec3,
  type Vec4
} from '../tsl-types'
import { number, vector2 } from '../uniforms'
import { BoltPass } from './BoltPass'
import {
  CHANNEL_COLOR,
  fromCamera,
  STEM_POINTS,
  STORED_POWER,
  type PlacedChannel,
  type StormColumn
} from './channel'
import { hazeAt } from './hazeAt'
import { StormDensity } from './StormDensity'
import { channelTint } from './tsl/channelTint'
import { limbDarkening } from './tsl/limbDarkening'
import { meanInverseSquare } from './tsl/lineLight'

/**
 * Depth in cloud from which its light comes: a few scaled mean free paths; the line's light is as soft [m]. Smaller: a white core where a
 * channel leaves its cloud (*Storm at night*).
 */
const CLOUD_SOFTNESS = 250
/** Softness of light in haze: a line is as soft as its picture's pixels are wide [m]. */
const HAZE_SOFTNESS = 25
/** Longest path through lit haze [m]. */
const LONGEST_HAZE = 60_000

/** Opacity of clouds below which their light is not seen [–]. */
const LEAST_OPACITY = 1e-3

/**
 * Light on faces of clouds that a flash lights from outside: of those turned away, and of thin ones [–]. 0: black (*Storm at night*).
 */
const TURNED_AWAY = 0.1
const UNFACED = 1 / 3

/** Share of the depth that one looks into clouds in which form is lost. Greater: heads without form; smaller: grain (*Storm at night*). */
const BLURRED = 0.25
/** Difference of log₂ of distances at which a neighbour's counts half. Greater: heads and ridges shine over others' edges; smaller: grain. */
const LIKE = 0.03

/** Marched pixels whose distances make a face, from the nearest one on. */
const TAPS = [
  [0, 0],
  [-1, -1],
  [1, -1],
  [-1, 1],
  [1, 1]
] as const

/** Opacity around a pixel from which nothing of the air behind its clouds is seen. */
const OPAQUE = 0.999

/** Edge of a pixel of the light, in the picture's. Greater: heads with blurred outlines. */
const LIGHT_PIXEL = 4

const _offset = new Vector3()

/** Passes that draw a flash: its light in clouds and in haze, and its channel. */
export class LightningPasses {
  /** Luminous power, times `luminanceScale` [lm]. */
  readonly power = number()
  readonly #clouds: CloudsNode
  /** Scale and offset from places in the picture to those among marched pixels: quotients of uniforms cost each pixel a division. */
  readonly #scale = vector2()
  readonly #offset = vector2()
  /** Points of the stem from the camera, in the mapped space [m], and scattering by air there [1/m]. */
  readonly #stem: readonly Vector4[] = Array.from({ length: STEM_POINTS }, () => new Vector4())
  readonly #stemArray = vec4Array(this.#stem as Vector4[])
  readonly #target = tableTarget('Welkin.Lightning', 1, 1)
  readonly #light: LevelTexture<Vec2>
  readonly #pass: FragmentPass
  readonly #bolt: BoltPass
  readonly #density: StormDensity

  constructor(clouds: CloudsNode) {
    this.#clouds = clouds
    this.#light = texture(this.#target.texture) as unknown as LevelTexture<Vec2>
    this.#density = new StormDensity(clouds.field)
    this.#pass = new FragmentPass('Welkin.Lightning', this.#lit())
    this.#bolt = new BoltPass(clouds)
  }

  /** Takes a channel in a storm: a layer, and its base and top. */
  begin(renderer: Renderer, viewpoint: Vector3, channel: PlacedChannel, storm: StormColumn): void {
    this.#bolt.channel = channel
    this.#density.bake(renderer, _offset.copy(channel.place).sub(viewpoint), channel, storm)
  }

  /**
   * Light of a pixel, for `STORED_POWER`: that of its clouds with the air before them, and in alpha that of the air before what was drawn, both over the
   * channel's colour.
   */
  #lit(): Vec4 {
    const { viewRays } = this.#clouds.passes
    const { field } = this.#clouds
    const layers = field.atmosphere.layers.filter(layer => !('upTo' in layer))
    return Fn(() => {
      const here = uv() as unknown as Vec2
      const ray = viewRayAt(viewRays, here)
      const { direction, directionView } = ray
      const { opacity, distance, normal, known } = this.#faceAt(here, direction)
      const air = float(0).toVar() as Variable<Float>
      If(opacity.lessThan(OPAQUE), () => {
        const end = viewRayEnd(viewRays, here, ray).min(LONGEST_HAZE).toConst()
        air.assign(this.#hazeLight(direction, end))
      })
      const light = vec2(air).toVar() as Variable<Vec2>
      If(opacity.greaterThan(LEAST_OPACITY), () => {
        const place = direction.mul(distance).toConst() as Vec3
        const line = this.#lineLight(place)
        const out = this.#density.lightOut(place)
        const turned = normal.dot(line.xyz).div(line.w).add(1).div(2).toConst() as Float
        const outside = turned
          .mul(turned)
          .mul(1 - TURNED_AWAY)
          .add(TURNED_AWAY)
        const inside = limbDarkening(normal.dot(direction).negate())
        const face = mix(mix(1, UNFACED, out.y), mix(inside, outside, out.y), known)
        const lit = line.w.mul(out.x).mul(face)
        const displacement = directionView.mul(distance).toConst()
        const { transmittance } = aerialPerspectiveTo(field.view, displacement, layers)
        const before = this.#hazeLight(direction, distance.min(LONGEST_HAZE).toConst()).toConst()
        const radiance = transmittance.xz.mul(lit).mul(STORED_POWER / (4 * Math.PI ** 2))
        light.assign(radiance.add(before))
        air.assign(air.max(before))
      })
      return vec4(channelTint(light), air)
    })()
  }

  /** Opacity of the clouds of a marched pixel, their mean distance, and the mean deviation from it [m]. @param here - In its textures. */
  #seenAt(here: Vec2): Vec3 {
    const { seen } = this.#clouds.passes
    const distances = seen.distances.sample(here).level(0).toConst() as Vec4
    const shares = seen.shares.sample(here).level(0).toConst() as Vec4
    const opacity = shares.dot(vec4(1)).toConst() as Float
    const mean = shares.dot(distances).div(opacity.max(1e-6)).toConst() as Float
    const depth = distances.sub(mean).abs().dot(shares).div(opacity.max(1e-6))
    return vec3(opacity, mean, depth).toConst()
  }

  /**
   * Face of a pixel's clouds: their opacity around, its distance [m] and normal, and from 0 to 1 how much of a face they have. A plane through those of five
   * marched pixels that are as far as the pixel's own, by history: single ones have the march's grain. To be called inside of a shader function.
   *
   * @param here - Place in the picture, y down.
   */
  #faceAt(
    here: Vec2,
    direction: Vec3
  ): { opacity: Float; distance: Float; normal: Vec3; known: Float } {
    const { viewRays, accumulated } = this.#clouds.passes
    const { marchedSize, block, size } = viewRays.frame
    const own = unpack(accumulated.distances.sample(here).level(0)).x
    const place = here.mul(this.#scale).add(this.#offset).mul(marchedSize).sub(0.5).toConst()
    const nearest = place.add(0.5).floor().toConst() as Vec2
    const taps = TAPS.map(tap => {
      const texel = nearest.add(vec2(...tap)).toConst() as Vec2
      return {
        shift: texel.sub(place).toConst(),
        seen: this.#seenAt(texel.add(0.5).div(marchedSize).toConst())
      }
    })
    // Where the pixel sees none, the farthest around.
    const farthest = taps.map(({ seen }) => seen.y as Float).reduce((a, b) => a.max(b))
    const reference = own.exp2().min(farthest).max(1).toConst() as Float
    // Sums of opacities; of weights, of these by place, depth and square of the place, of distances from the reference, and of these by place.
    let opacity: Float = float(0)
    let weights: Vec4 = vec4(0)
    let squares: Vec2 = vec2(0)
    let rises: Vec3 = vec3(0)
    for (const { shift, seen } of taps) {
      const rise = seen.y.sub(reference).toConst() as Float
      const apart = rise.div(reference.mul(LIKE * Math.LN2)).toConst() as Float
      const weight = seen.x.div(apart.mul(apart).add(1)).toConst() as Float
      opacity = opacity.add(seen.x)
      weights = weights.add(vec4(1, shift, seen.z).mul(weight)).toConst()
      squares = squares.add(shift.mul(shift).mul(weight)).toConst()
      rises = rises.add(vec3(1, shift).mul(rise.mul(weight))).toConst()
    }
    const mean = weights.yzw.div(weights.x.max(1e-9)).toConst() as Vec3
    const slopes = rises.yz
      .sub(mean.xy.mul(rises.x))
      .div(squares.sub(mean.xy.mul(weights.yz)).max(1e-3))
      .toConst() as Vec2
    const rise = rises.x.div(weights.x.max(1e-9)).sub(slopes.dot(mean.xy))
    const distance = reference.add(rise).max(1).toConst() as Float
    const blurred = mean.z.mul(BLURRED).toConst() as Float
    const width = float(0).toVar() as Variable<Float>
    const normal = direction.negate().toVar() as Variable<Vec3>
    for (const [axis, slope] of [
      [vec2(1, 0), slopes.x],
      [vec2(0, 1), slopes.y]
    ] as const) {
      const step = axis.mul(block).div(size)
      const next = viewRayAt(viewRays, here.add(step).toConst())
      const aside = next.direction.sub(direction).toConst() as Vec3
      width.assign(aside.length().mul(distance))
      normal.addAssign(aside.normalize().mul(slope.div(width.add(blurred))))
    }
    const known = width.div(width.add(blurred)).toConst() as Float
    opacity = opacity.div(TAPS.length).toConst()
    return { opacity, distance, normal: normal.normalize().toConst(), known }
  }

  /** Mean of 1/(r² + s²) over the stem, for a place in clouds, in w, and of that times the direction to the stem [1/m²]. */
  #lineLight(place: Vec3): Vec4 {
    const sum = vec4(0).toVar() as Variable<Vec4>
    loop('flashLine', 2, index => {
      // The stem is nearly straight.
      const first = index.mul(int(2)).toConst() as Int
      const [from, to] = [first, first.add(int(2))].map(
        i => this.#stemArray.element(i).xyz.sub(place).toConst() as Vec3
      )
      const light = meanInverseSquare(from, to, float(CLOUD_SOFTNESS))
      sum.addAssign(vec4(from.add(to).normalize(), 1).mul(light))
    })
    return sum.div(2).toConst()
  }

  /** Light that the air on a ray scatters once, without direction, for `STORED_POWER` [cd/m²]: from three points of the stem. */
  #hazeLight(direction: Vec3, end: Float): Float {
    const sum = float(0).toVar() as Variable<Float>
    loop('flashHaze', 3, index => {
      const point = this.#stemArray.element(index.mul(int(2))).toConst() as Vec4
      const from = point.xyz.negate().toConst() as Vec3
      const to = from.add(direction.mul(end)).toConst() as Vec3
      sum.addAssign(meanInverseSquare(from, to, float(HAZE_SOFTNESS)).mul(point.w))
    })
    return sum.mul(end).mul(STORED_POWER / (3 * 16 * Math.PI ** 2))
  }

  /**
   * Adds its light to a picture's colour. To be called inside of a shader function.
   *
   * @param transmittance - Part of the light from behind that passes the clouds.
   */
  addTo(color: Vec3, transmittance: Float): Vec3 {
    const result = color.toVar() as Variable<Vec3>
    If(this.power.greaterThan(0), () => {
      const here = uv() as unknown as Vec2
      const light = this.#light.sample(here).level(0).toConst() as Vec4
      const glow = mix(light.xyz, vec3(light.w), transmittance).toVar() as Variable<Vec3>
      If(this.#bolt.isNear(here), () => {
        glow.addAssign(channelTint(this.#bolt.sample(here)))
      })
      const scale = this.power.mul(1 / STORED_POWER)
      result.addAssign(glow.mul(vec3(...CHANNEL_COLOR)).mul(scale))
    })
    return result
  }

  /**
   * Draws a flash.
   *
   * @param power - Luminous powers of stem and of branches, times `luminanceScale` [lm].
   */
  render(
    renderer: Renderer,
    view: AtmosphereView,
    viewpoint: Vector3,
    channel: PlacedChannel,
    power: { readonly all: number; readonly branches: number }
  ): void {
    channel.stem.forEach((point, i) => {
      const { x, y, z } = fromCamera(channel, viewpoint, point, _offset)
      this.#stem[i].set(x, y, z, hazeAt(view, point[2]))
    })
    _offset.copy(channel.place).sub(viewpoint)
    this.#density.update(_offset)
    this.power.value = power.all
    const { size, marchedSize, block, jitter } = this.#clouds.passes.viewRays.frame
    const marched = marchedSize.value
    const edge = block.value
    const blocks = marched.clone().multiplyScalar(edge)
    this.#scale.value.copy(size.value).divide(blocks)
    // Where the marched pixels of this frame lie in their blocks.
    this.#offset.value
      .setScalar((edge - 1) / 2)
      .sub(jitter.value)
      .divide(blocks)
    const { x, y } = size.value
    this.#target.setSize(Math.ceil(x / LIGHT_PIXEL), Math.ceil(y / LIGHT_PIXEL))
    this.#pass.render(renderer, this.#target)
    this.#bolt.render(renderer, view, _offset, channel, power.branches / power.all)
  }

  /** Frees render targets and passes. */
  dispose(): void {
    for (const owned of [this.#target, this.#pass, this.#bolt, this.#density]) owned.dispose()
  }
}

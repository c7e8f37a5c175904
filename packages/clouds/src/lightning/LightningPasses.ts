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
import { marchedPixel } from '../march/tsl/marchedPixel'
import { CORNERS } from '../temporal/tsl/cells'
import { unpack } from '../temporal/tsl/packing'
import { viewRayAt, viewRayEnd } from '../march/tsl/viewRay'
import {
  loop,
  vec4Array,
  type Float,
  type LevelTexture,
  type Variable,
  type Vec2,
  type Vec3,
  type Vec4
} from '../tsl-types'
import { number, vector2 } from '../uniforms'
import { BoltPass } from './BoltPass'
import {
  fromCamera,
  STEM_POINTS,
  STORED_POWER,
  type PlacedChannel,
  type StormColumn
} from './channel'
import { hazeAt } from './hazeAt'
import { StormDensity } from './StormDensity'
import { channelColor } from './tsl/channelColor'
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
const LONGEST_OCTAVE = Math.log2(LONGEST_HAZE)

/** Opacity of clouds below which their light is not seen [–]. */
const LEAST_OPACITY = 1e-3

/**
 * Light on faces of clouds that a flash lights from outside: of those turned away, and of thin ones [–]. 0: black (*Storm at night*).
 */
const TURNED_AWAY = 0.1
const UNFACED = 1 / 3

/** Share of the depth that one looks into clouds in which form is lost. Greater: heads without form; smaller: grain (*Storm at night*). */
const BLURRED = 0.25
/** Difference of log₂ of distances at which light or place of a neighbour counts half, of clouds and of what was drawn. Greater: heads and ridges shine over others' edges; smaller: grain. */
const LIKE = 0.03
const AIR_LIKE = 0.3
/** Weight of dark air where neighbours are at other distances. 0: bright lines around what stands before the sky. */
const DARK = 0.01

/** Edge of a pixel of the light, in the picture's. Greater: heads with blurred outlines. */
const LIGHT_PIXEL = 3

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
  /** Light of the marched pixels' clouds, and of all pixels. */
  readonly #glowTarget = tableTarget('Welkin.LightningGlow', 1, 1)
  readonly #glow: LevelTexture<Vec2>
  readonly #glowPass: FragmentPass
  readonly #target = tableTarget('Welkin.Lightning', 1, 1)
  readonly #light: LevelTexture<Vec2>
  readonly #pass: FragmentPass
  readonly #bolt: BoltPass
  readonly #density: StormDensity

  constructor(clouds: CloudsNode) {
    this.#clouds = clouds
    this.#glow = texture(this.#glowTarget.texture) as unknown as LevelTexture<Vec2>
    this.#light = texture(this.#target.texture) as unknown as LevelTexture<Vec2>
    this.#density = new StormDensity(clouds.field)
    this.#glowPass = new FragmentPass('Welkin.LightningGlow', this.#clouded())
    this.#pass = new FragmentPass('Welkin.Lightning', this.#lit())
    this.#bolt = new BoltPass(clouds)
  }

  /** Takes a channel in a storm: a layer, and its base and top. */
  begin(renderer: Renderer, viewpoint: Vector3, channel: PlacedChannel, storm: StormColumn): void {
    this.#bolt.channel = channel
    this.#density.bake(renderer, _offset.copy(channel.place).sub(viewpoint), channel, storm)
  }

  /**
   * One pixel of each block: red and blue of the light of its clouds and of the air before them, for `STORED_POWER`; 1, or 0 where there are no clouds; and light of the air
   * before what was drawn.
   */
  #clouded(): Vec4 {
    const { passes, field } = this.#clouds
    const { viewRays } = passes
    const layers = field.atmosphere.layers.filter(layer => !('upTo' in layer))
    return Fn(() => {
      const { at } = marchedPixel(viewRays)
      const here = uv() as unknown as Vec2
      const ray = viewRayAt(viewRays, at)
      const { direction, directionView } = ray
      const end = viewRayEnd(viewRays, at, ray).min(LONGEST_HAZE).toConst()
      const light = vec3(0).toVar() as Variable<Vec3>
      const seen = this.#seenAt(here)
      If(seen.x.greaterThan(LEAST_OPACITY), () => {
        const { distance, normal, known } = this.#faceAt(here, at, direction, seen)
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
        const before = this.#hazeLight(direction, distance.min(LONGEST_HAZE).toConst())
        const radiance = transmittance.xz.mul(lit).mul(STORED_POWER / (4 * Math.PI ** 2))
        light.assign(vec3(radiance.add(before), 1))
      })
      return vec4(light, this.#hazeLight(direction, end))
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
   * Face of a marched pixel's clouds: its distance [m] and normal, and from 0 to 1 how much of one they have. A plane through nine pixels: single ones have
   * the march's grain. To be called inside of a shader function.
   *
   * @param here - Place of the marched pixel in its textures, and `at` in the picture.
   * @param seen - `#seenAt` there.
   */
  #faceAt(
    here: Vec2,
    at: Vec2,
    direction: Vec3,
    seen: Vec3
  ): { distance: Float; normal: Vec3; known: Float } {
    const { viewRays } = this.#clouds.passes
    const { marchedSize, block, size } = viewRays.frame
    // Sums of weights, of these by place and by its square, of distances from the pixel's, and of these by place.
    const weights = vec3(0).toVar() as Variable<Vec3>
    const squares = vec2(0).toVar() as Variable<Vec2>
    const rises = vec3(0).toVar() as Variable<Vec3>
    loop('faceTap', 9, index => {
      const row = index.div(int(3)).toConst()
      const shift = vec2(index.sub(row.mul(3)), row)
        .sub(1)
        .toConst() as Vec2
      const there = this.#seenAt(here.add(shift.div(marchedSize)).toConst())
      const rise = there.y.sub(seen.y).toConst() as Float
      const apart = rise.div(seen.y.mul(LIKE * Math.LN2)).toConst()
      const weight = there.x.div(apart.mul(apart).add(1)).toConst() as Float
      weights.addAssign(vec3(1, shift).mul(weight))
      squares.addAssign(shift.mul(shift).mul(weight))
      rises.addAssign(vec3(1, shift).mul(rise.mul(weight)))
    })
    const middle = weights.yz.div(weights.x).toConst() as Vec2
    const mean = rises.x.div(weights.x).toConst() as Float
    const slopes = rises.yz
      .sub(middle.mul(rises.x))
      .div(squares.sub(middle.mul(weights.yz)).max(1e-3))
      .toConst() as Vec2
    const width = float(0).toVar() as Variable<Float>
    const blurred = seen.z.mul(BLURRED).toConst() as Float
    const normal = direction.negate().toVar() as Variable<Vec3>
    for (const [axis, slope] of [
      [vec2(1, 0), slopes.x],
      [vec2(0, 1), slopes.y]
    ] as const) {
      const step = axis.mul(block).div(size)
      const next = viewRayAt(viewRays, at.add(step).toConst()).direction
      const aside = next.sub(direction.mul(next.dot(direction))).toConst() as Vec3
      width.assign(aside.length().mul(seen.y))
      normal.addAssign(aside.normalize().mul(slope.div(width.add(blurred))))
    }
    const distance = seen.y.add(mean).sub(slopes.dot(middle)).max(1).toConst() as Float
    const known = width.div(width.add(blurred)).toConst() as Float
    return { distance, normal: normal.normalize().toConst(), known }
  }

  /**
   * Light of a pixel, for `STORED_POWER`, from the marched ones around that are as far: red and blue of its clouds, and that of its air.
   */
  #lit(): Vec4 {
    const { viewRays, accumulated, seen } = this.#clouds.passes
    const { marchedSize } = viewRays.frame
    return Fn(() => {
      const here = uv() as unknown as Vec2
      const own = unpack(accumulated.distances.sample(here).level(0))
        .xy.min(LONGEST_OCTAVE)
        .toConst()
      const place = here.mul(this.#scale).add(this.#offset).mul(marchedSize).sub(0.5).toConst()
      const first = place.floor().toConst() as Vec2
      const part = place.sub(first).toConst() as Vec2
      const clouds = vec3(0).toVar() as Variable<Vec3>
      const airs = vec2(0, DARK).toVar() as Variable<Vec2>
      for (const [x, y] of CORNERS) {
        const texel = first
          .add(vec2(x + 0.5, y + 0.5))
          .div(marchedSize)
          .toConst()
        const found = this.#glow.sample(texel).level(0).toConst() as Vec4
        const weights = mix(part.oneMinus(), part, vec2(x, y)).toConst() as Vec2
        const distances = seen.ray.sample(texel).level(0).xy.min(LONGEST_OCTAVE)
        const apart = distances
          .sub(own)
          .mul(vec2(1 / LIKE, 1 / AIR_LIKE))
          .toConst()
        const like = weights.x
          .mul(weights.y)
          .add(1e-3)
          .div(apart.mul(apart).add(1))
          .toConst() as Vec2
        clouds.addAssign(vec3(found.xy, 1).mul(like.x.mul(found.z)))
        airs.addAssign(vec2(found.w, 1).mul(like.y))
      }
      const air = airs.x.div(airs.y).toConst() as Float
      // Some where none of them sees a cloud.
      const all = clouds.add(vec3(air, air, 1).mul(1e-6)).toConst() as Vec3
      return vec4(all.xy.div(all.z), air, 1)
    })()
  }

  /** Mean of 1/(r² + s²) over the stem, for a place in clouds, in w, and of that times the direction to the stem [1/m²]. */
  #lineLight(place: Vec3): Vec4 {
    const sum = vec4(0).toVar() as Variable<Vec4>
    loop('flashLine', STEM_POINTS - 1, index => {
      const [from, to] = [index, index.add(int(1))].map(
        i => this.#stemArray.element(i).xyz.sub(place).toConst() as Vec3
      )
      const light = meanInverseSquare(from, to, float(CLOUD_SOFTNESS))
      sum.addAssign(vec4(from.add(to).normalize(), 1).mul(light))
    })
    return sum.div(STEM_POINTS - 1).toConst()
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
      const { xyz: light } = this.#light.sample(here).level(0).toConst()
      const glow = mix(light.xy, vec2(light.z), transmittance).add(this.#bolt.sample(here))
      result.addAssign(channelColor(glow.toConst()).mul(this.power.mul(1 / STORED_POWER)))
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
    this.#glowTarget.setSize(marched.x, marched.y)
    const { x, y } = size.value
    this.#target.setSize(Math.ceil(x / LIGHT_PIXEL), Math.ceil(y / LIGHT_PIXEL))
    this.#glowPass.render(renderer, this.#glowTarget)
    this.#pass.render(renderer, this.#target)
    this.#bolt.render(renderer, view, _offset, channel, power.branches / power.all)
  }

  /** Frees render targets and passes. */
  dispose(): void {
    const targets = [this.#glowTarget, this.#target]
    const passes = [this.#glowPass, this.#pass, this.#bolt, this.#density]
    for (const owned of [...targets, ...passes]) owned.dispose()
  }
}

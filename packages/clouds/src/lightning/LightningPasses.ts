import {
  aerialPerspectiveTo,
  FragmentPass,
  tableTarget,
  type AtmosphereView
} from '@welkin/atmosphere'
import { MathUtils, Vector3, Vector4 } from 'three'
import {
  Fn,
  If,
  float,
  int,
  isBackgroundDepth,
  mix,
  texture,
  uv,
  vec2,
  vec3,
  vec4
} from 'three/tsl'
import type { Renderer } from 'three/webgpu'
import type { CloudsNode } from '../march/CloudsNode'
import { CORNERS } from '../temporal/tsl/cells'
import { unpack } from '../temporal/tsl/packing'
import { groundDistance } from '../march/tsl/layerBoundaries'
import { viewRayAt, viewRayEnd } from '../march/tsl/viewRay'
import { select } from '../select'
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
import { CLOUD_SOFTNESS, StormDensity } from './StormDensity'
import { channelColor } from './tsl/channelColor'
import { limbDarkening } from './tsl/limbDarkening'
import { lineAngle } from './tsl/lineLight'

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
const TURNED_AWAY = 0.3

/** Share of the depth that one looks into clouds in which form is lost. Greater: heads without form; smaller: grain (*Storm at night*). */
const BLURRED = 0.25
/** Difference of log₂ of distances at which a neighbour's counts half. Greater: heads and ridges shine over others' edges; smaller: grain. */
const LIKE = 0.03

/** Opacity around a pixel from which nothing of the air behind its clouds is seen. */
const OPAQUE = 0.999

/** Pixels of the light in small pictures, and the greatest edge of one, in the picture's. Fewer and greater: heads with blurred outlines. */
const LIGHT_PIXELS = 32_000
const LIGHT_PIXEL = 8

const _offset = new Vector3()

/** Passes that draw a flash: its light in clouds and in haze, and its channel. */
export class LightningPasses {
  /** Luminous power, times `luminanceScale` [lm]. */
  readonly power = number()
  readonly #clouds: CloudsNode
  /** Scale and offset from places in the picture to those among marched pixels: quotients of uniforms cost each pixel a division. */
  readonly #scale = vector2()
  readonly #offset = vector2()
  /** Size of two pixels of the light, over the picture's. */
  readonly #lightPixel = vector2()
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
   * Light of a pixel, for `STORED_POWER`: red and blue of its clouds with the air before them; that of the air before sky and bare ground, and of that before
   * what was drawn, both over the channel's colour.
   */
  #lit(): Vec4 {
    const { field, passes } = this.#clouds
    const { viewRays } = passes
    const layers = field.atmosphere.layers.filter(layer => !('upTo' in layer))
    return Fn(() => {
      const here = uv() as unknown as Vec2
      const ray = viewRayAt(viewRays, here)
      const { direction, directionView } = ray
      const { opacity, distance, normal, known } = this.#faceAt(here, direction)
      const air = vec2(0).toVar() as Variable<Vec2>
      If(opacity.lessThan(OPAQUE), () => {
        const cosView = direction.dot(field.view.up).clamp(-1, 1).toConst() as Float
        const ground = groundDistance(field, cosView).min(LONGEST_HAZE).toConst() as Float
        air.assign(vec2(this.#hazeLight(direction, ground)))
        const end = viewRayEnd(viewRays, here, ray).toVar() as Variable<Float>
        // Before the sky, that of what stands beside the pixel.
        If(end.lessThan(ground).not(), () => {
          const beside = CORNERS.map(corner => {
            const at = vec2(...corner)
              .sub(0.5)
              .mul(this.#lightPixel)
              .add(here)
            return passes.seen.ray.sample(at).level(0).y
          }).reduce((a, b) => a.min(b))
          end.assign(beside.exp2())
        })
        If(end.lessThan(ground), () => {
          air.y.assign(this.#hazeLight(direction, end))
        })
      })
      const light = vec2(air.x).toVar() as Variable<Vec2>
      If(opacity.greaterThan(LEAST_OPACITY), () => {
        const place = direction.mul(distance).toConst() as Vec3
        const way = this.#density.source.sub(place).toConst() as Vec3
        const square = way.dot(way).toConst() as Float
        const out = this.#density.lightOut(place)
        const turned = normal.dot(way).mul(square.inverseSqrt()).add(1).div(2).toConst() as Float
        const outside = turned
          .mul(turned)
          .mul(known)
          .mul(1 - TURNED_AWAY)
          .add(TURNED_AWAY)
        const inside = mix(1, limbDarkening(normal.dot(direction).negate()), known)
        const face = mix(inside, outside, out.y)
        const lit = out.x.mul(face).div(square.add(CLOUD_SOFTNESS ** 2))
        const displacement = directionView.mul(distance).toConst()
        const { transmittance } = aerialPerspectiveTo(field.view, displacement, layers)
        const before = this.#hazeLight(direction, distance.min(LONGEST_HAZE).toConst())
        const radiance = transmittance.xz.mul(lit).mul(STORED_POWER / (4 * Math.PI ** 2))
        light.assign(radiance.add(before))
      })
      return vec4(light, air)
    })()
  }

  /**
   * Face of a pixel's clouds: opacity around it, its distance [m] and normal, and from 0 to 1 how much of a face they have. It is a plane
   * through those of nine marched pixels that are as far as the pixel's own, by history: single ones have the march's grain. To be called inside of a shader function, outside of branches.
   *
   * @param here - Place in the picture, y down.
   */
  #faceAt(
    here: Vec2,
    direction: Vec3
  ): { opacity: Float; distance: Float; normal: Vec3; known: Float } {
    const { viewRays, accumulated, seen } = this.#clouds.passes
    const { marchedSize, block, size } = viewRays.frame
    const own = unpack(accumulated.distances.sample(here).level(0)).x
    const place = here.mul(this.#scale).add(this.#offset).mul(marchedSize).sub(0.5).toConst()
    const nearest = place.add(0.5).floor().toConst() as Vec2
    // Where the pixel sees none, all around are as unlike.
    const reference = own.min(LONGEST_OCTAVE).exp2().toConst() as Float
    // Sums of opacities by place in the picture; of weights, of these by place, depth and square of the place, of distances from the reference, and of
    // these by place.
    const opacity = float(0).toVar() as Variable<Float>
    const weights = vec4(0).toVar() as Variable<Vec4>
    const squares = vec2(0).toVar() as Variable<Vec2>
    const rises = vec3(0).toVar() as Variable<Vec3>
    loop('faceTap', 9, index => {
      const row = index.div(int(3)).toConst()
      const texel = nearest
        .add(vec2(index.sub(row.mul(3)), row))
        .sub(1)
        .toConst() as Vec2
      const shift = texel.sub(place).toConst() as Vec2
      const at = texel.add(0.5).div(marchedSize).toConst() as Vec2
      const distances = seen.distances.sample(at).level(0).toConst() as Vec4
      const shares = seen.shares.sample(at).level(0).toConst() as Vec4
      const seenShare = shares.dot(vec4(1)).toConst() as Float
      const middle = shares.dot(distances).div(seenShare.max(1e-6)).toConst() as Float
      // Smooth from pixel to pixel: a weight is 0 where its place among the nine changes.
      const near = vec2(1.5).sub(shift.abs()).clamp(0, 1).toConst() as Vec2
      const share = near.x.mul(near.y).mul(seenShare).toConst() as Float
      const rise = middle.sub(reference).toConst() as Float
      const unlike = rise.div(reference.mul(LIKE * Math.LN2)).toConst() as Float
      const weight = share.div(unlike.mul(unlike).add(1)).toConst() as Float
      opacity.addAssign(share)
      const depth = distances.sub(middle).abs().dot(shares).div(seenShare.max(1e-6))
      weights.addAssign(vec4(1, shift, depth).mul(weight))
      squares.addAssign(shift.mul(shift).mul(weight))
      rises.addAssign(vec3(1, shift).mul(rise.mul(weight)))
    })
    const mean = weights.yzw.div(weights.x.max(1e-9)).toConst() as Vec3
    const slopes = rises.yz
      .sub(mean.xy.mul(rises.x))
      .div(squares.sub(mean.xy.mul(weights.yz)).max(weights.x.mul(0.1)).max(1e-9))
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
    const face = { distance, normal: normal.normalize().toConst() as Vec3, known }
    return { ...face, opacity: opacity.div(4) }
  }

  /** Light that the air on a ray scatters once, without direction, for `STORED_POWER` [cd/m²]: from three points of the stem. */
  #hazeLight(direction: Vec3, end: Float): Float {
    const sum = float(0).toVar() as Variable<Float>
    loop('flashHaze', 3, index => {
      const point = this.#stemArray.element(index.mul(int(2))).toConst() as Vec4
      const along = point.xyz.dot(direction).toConst() as Float
      const aside = point.xyz.sub(direction.mul(along)).toConst() as Vec3
      const square = aside
        .dot(aside)
        .add(HAZE_SOFTNESS ** 2)
        .toConst() as Float
      const b = square.sqrt().toConst() as Float
      sum.addAssign(lineAngle(b, square, along, end).mul(point.w).div(b))
    })
    return sum.mul(STORED_POWER / (3 * 16 * Math.PI ** 2)).toConst()
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
      const { viewRays } = this.#clouds.passes
      const air = select(isBackgroundDepth(viewRays.depthAt(here)), light.z, light.w)
      const glow = mix(light.xy, vec2(air), transmittance).toVar() as Variable<Vec2>
      If(this.#bolt.isNear(here), () => {
        glow.addAssign(this.#bolt.sample(here))
      })
      result.addAssign(channelColor(glow).mul(this.power.mul(1 / STORED_POWER)))
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
    const pixel = MathUtils.clamp(Math.sqrt((x * y) / LIGHT_PIXELS), 1, LIGHT_PIXEL)
    this.#target.setSize(Math.ceil(x / pixel), Math.ceil(y / pixel))
    this.#lightPixel.value.set(2 / this.#target.width, 2 / this.#target.height)
    this.#pass.render(renderer, this.#target)
    this.#bolt.render(renderer, view, _offset, channel, power.branches / power.all)
  }

  /** Frees render targets and passes. */
  dispose(): void {
    for (const owned of [this.#target, this.#pass, this.#bolt, this.#density]) owned.dispose()
  }
}

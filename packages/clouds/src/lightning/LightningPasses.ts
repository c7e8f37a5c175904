import {
  aerialPerspectiveTo,
  FragmentPass,
  tableTarget,
  type AtmosphereView
} from '@welkin/atmosphere'
import { Vector3, Vector4 } from 'three'
import { Fn, If, float, int, mix, texture, uv, vec2, vec4 } from 'three/tsl'
import type { Renderer } from 'three/webgpu'
import { select } from '../select'
import type { CloudsNode } from '../march/CloudsNode'
import { marchedPixel } from '../march/tsl/marchedPixel'
import { CORNERS } from '../temporal/tsl/cells'
import { encodeDistance, FARTHEST } from '../temporal/tsl/packing'
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
import { fromCamera, STEM_POINTS, type PlacedChannel, type StormColumn } from './channel'
import { StormDensity } from './StormDensity'
import { channelColor } from './tsl/channelColor'
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

/** Difference of a pixel's nearness to the glow's about it, over the latter, above which it finds the light of its own air. Greater: air shines over ridges. */
const UNLIKE = 0.03

/**
 * Difference of the nearness at a glow pixel's four corners to four times its own, over its own, from which on an edge is there: pixels find the light of their own
 * air. Greater: bright lines below ridges.
 */
const EDGE = 0.3

/** Edge of a pixel of the glow, in marched ones. Greater: no relief in lit clouds (*Storm at night*). */
const GLOW_PIXEL = 2

/** Opacity of clouds below which their light is not seen [–]. */
const LEAST_OPACITY = 1e-3

/** Opacity of a ray's clouds above which they have a face [–]. */
const FACED = 0.1
/** Light of the night's sky, as it were, on faces of clouds that are turned away from a flash [–]. 0: black (*Storm at night*). */
const TURNED_AWAY = 0.15

/** Power for which half floats hold light: 1e-9 of it is left 2 km from the channel [lm]. */
const STORED_POWER = 1e9

/** Slope of the clouds that stands for none. */
const STEEPEST = 1e6

/**
 * Radiance of a cloud's surface that is lit from inside, over that of an even one [–]: (1 + 1.5 μ)/2, of which the mean over the light that leaves is 1.
 *
 * @param facing - μ, cosine between the surface's normal and the way to the eye.
 * @see Milne 1930, "Thermodynamics of the stars", Handbuch der Astrophysik 3, §33: limb darkening in Eddington's approximation
 */
const limbDarkening = (facing: Float): Float => facing.clamp(0, 1).mul(0.75).add(0.5)

const _offset = new Vector3()

/** Scattering by molecules and aerosols at an altitude, 520 nm [1/m]. */
function hazeAt({ atmosphere }: AtmosphereView, altitude: number): number {
  const { rayleighScattering, rayleighScaleHeight, mieScattering, mieScaleHeight } =
    atmosphere.parameters
  return (
    rayleighScattering[1] * Math.exp(-altitude / rayleighScaleHeight) +
    mieScattering[1] * Math.exp(-altitude / mieScaleHeight)
  )
}

/** Passes that draw a flash: its light in clouds and in haze, and its channel. */
export class LightningPasses {
  /** Luminous power, times `luminanceScale` [lm]. */
  readonly power = number()
  readonly #clouds: CloudsNode
  /** Scale and offset from places in the picture to those among marched pixels: quotients of uniforms cost each pixel a division. */
  readonly #scale = vector2()
  readonly #offset = vector2()
  /** Depth where nothing was drawn. */
  readonly #farDepth = number()
  /** Points of the stem from the camera, in the mapped space [m], and scattering by air there [1/m]. */
  readonly #stem: readonly Vector4[] = Array.from({ length: STEM_POINTS }, () => new Vector4())
  readonly #stemArray = vec4Array(this.#stem as Vector4[])
  readonly #target = tableTarget('Welkin.LightningGlow', 1, 1)
  readonly #glow: LevelTexture<Vec2>
  readonly #pass: FragmentPass
  readonly #smoothTarget = tableTarget('Welkin.LightningSmoothGlow', 1, 1)
  readonly #smooth: LevelTexture<Vec2>
  readonly #smoothPass: FragmentPass
  readonly #bolt: BoltPass
  readonly #density: StormDensity

  constructor(clouds: CloudsNode) {
    this.#clouds = clouds
    this.#glow = texture(this.#target.texture) as unknown as LevelTexture<Vec2>
    this.#density = new StormDensity(clouds.field)
    this.#pass = new FragmentPass('Welkin.LightningGlow', this.#light())
    this.#smooth = texture(this.#smoothTarget.texture) as unknown as LevelTexture<Vec2>
    this.#smoothPass = new FragmentPass('Welkin.LightningSmoothGlow', this.#smoothed())
    this.#bolt = new BoltPass(clouds)
  }

  /** Takes a channel in a storm: a layer, and its base and top. */
  begin(renderer: Renderer, viewpoint: Vector3, channel: PlacedChannel, storm: StormColumn): void {
    this.#bolt.channel = channel
    this.#density.bake(renderer, _offset.copy(channel.place).sub(viewpoint), channel, storm)
  }

  /**
   * Clouds of one pixel of each block: their light, red and blue, for `STORED_POWER`, times their opacity; that opacity; and
   * log₂ of their distance, times it.
   */
  #light(): Vec4 {
    const { passes, field } = this.#clouds
    const { seen, viewRays } = passes
    const layers = field.atmosphere.layers.filter(layer => !('upTo' in layer))
    return Fn(() => {
      const { block, at } = marchedPixel(viewRays)
      const here = block.add(0.5).div(viewRays.frame.marchedSize).toConst() as Vec2
      const ray = viewRayAt(viewRays, at)
      const distances = seen.distances.sample(here).level(0).toConst()
      const shares = seen.shares.sample(here).level(0).toConst()
      const opacity = shares.dot(vec4(1)).toConst() as Float
      const light = vec4(0).toVar() as Variable<Vec4>
      If(opacity.greaterThan(LEAST_OPACITY), () => {
        const mean = shares.dot(distances).div(opacity).toConst() as Float
        // How deep one looks into clouds: what is finer has no face.
        const depth = distances.sub(mean).abs().dot(shares).div(opacity).toConst()
        const { normal, width } = this.#faceAt(here, at, ray.direction, mean, depth)
        const place = ray.direction.mul(mean).toConst() as Vec3
        const line = this.#lineLight(place)
        const out = this.#density.lightOut(place)
        const turned = normal.dot(line.xyz).div(line.w).add(1).div(2).toConst() as Float
        const outside = turned
          .mul(turned)
          .mul(1 - TURNED_AWAY)
          .add(TURNED_AWAY)
        const facing = normal.dot(ray.direction).negate()
        const face = mix(1, mix(limbDarkening(facing), outside, out.y), width.div(width.add(depth)))
        const lit = line.w.mul(out.x).mul(face)
        const displacement = ray.directionView.mul(mean).toConst()
        const { transmittance } = aerialPerspectiveTo(field.view, displacement, layers)
        const radiance = lit.mul(opacity).mul(STORED_POWER / (4 * Math.PI ** 2))
        const distance = encodeDistance(mean).mul(opacity)
        light.assign(vec4(transmittance.xz.mul(radiance), opacity, distance))
      })
      return light
    })()
  }

  /**
   * Normal of what is seen of clouds, and the width over which it is known [m]: from distances of the marched pixels around, on each axis the nearer
   * one's. To be called inside of a shader function.
   *
   * @param here - Place of the marched pixel in its textures, and `at` in the picture.
   * @param mean - The pixel's mean distance, and `depth` its mean deviation [m].
   */
  #faceAt(
    here: Vec2,
    at: Vec2,
    direction: Vec3,
    mean: Float,
    depth: Float
  ): { normal: Vec3; width: Float } {
    const { seen, viewRays } = this.#clouds.passes
    const { marchedSize, block, size } = viewRays.frame
    const width = float(0).toVar() as Variable<Float>
    const normal = direction.negate().toVar() as Variable<Vec3>
    for (const axis of [vec2(1, 0), vec2(0, 1)]) {
      const step = axis.mul(GLOW_PIXEL)
      const next = viewRayAt(viewRays, at.add(step.mul(block).div(size)).toConst()).direction
      const aside = next.sub(direction.mul(next.dot(direction))).toConst() as Vec3
      width.assign(aside.length().mul(mean))
      const [before, after] = [-1, 1].map(sign => {
        const place = here.add(step.mul(sign).div(marchedSize)).toConst()
        const shares = seen.shares.sample(place).level(0).toConst() as Vec4
        const opacity = shares.dot(vec4(1)).toConst() as Float
        const distance = shares.dot(seen.distances.sample(place).level(0)).div(opacity.max(1e-3))
        const rise = distance.sub(mean).mul(sign).div(width.add(depth))
        return select(opacity.greaterThan(FACED), rise, STEEPEST).toConst()
      })
      const slope = select(before.abs().lessThan(after.abs()), before, after)
      normal.addAssign(aside.normalize().mul(select(slope.lessThan(STEEPEST), slope, 0)))
    }
    return { normal: normal.normalize().toConst(), width }
  }

  /**
   * Glow by a tent: marched pixels are one of each block, and it hides which. Light of opaque clouds and of the air before them, red and blue; of the
   * air before what was drawn; and its nearness, −1 beside edges, and on ground that was not drawn.
   */
  #smoothed(): Vec4 {
    const { viewRays } = this.#clouds.passes
    return Fn(() => {
      const here = uv() as unknown as Vec2
      const texel = vec2(GLOW_PIXEL).div(viewRays.frame.marchedSize).toConst() as Vec2
      const glow = vec4(0).toVar() as Variable<Vec4>
      const inPicture = (place: Vec2): Vec2 => place.sub(this.#offset).div(this.#scale).toConst()
      const at = inPicture(here)
      const nearness = this.#nearness(viewRays.depthAt(at))
      const bend = nearness.mul(-4).toVar() as Variable<Float>
      for (const [x, y] of CORNERS) {
        const place = here.add(texel.mul(vec2(x - 0.5, y - 0.5))).toConst() as Vec2
        glow.addAssign(this.#glow.sample(place).level(0))
        bend.addAssign(this.#nearness(viewRays.depthAt(inPicture(place))))
      }
      const opacity = glow.z.max(LEAST_OPACITY).toConst() as Float
      const none = LEAST_OPACITY * FARTHEST
      const { direction, end, air } = this.#airOn(at)
      const distance = glow.w.add(none).div(opacity).exp2().min(LONGEST_HAZE).toConst() as Float
      const before = this.#hazeLight(direction, distance)
      const isEdge = nearness
        .lessThanEqual(0)
        .and(end.lessThan(LONGEST_HAZE))
        .or(bend.abs().greaterThan(nearness.mul(EDGE)))
      return vec4(glow.xy.div(opacity).add(before), air, select(isEdge, -1, nearness))
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

  /** A pixel's ray, its length through lit haze [m], and the light of that. @param at - In the picture. */
  #airOn(at: Vec2): { direction: Vec3; end: Float; air: Float } {
    const { viewRays } = this.#clouds.passes
    const ray = viewRayAt(viewRays, at)
    const end = viewRayEnd(viewRays, at, ray).min(LONGEST_HAZE).toConst() as Float
    return { ...ray, end, air: this.#hazeLight(ray.direction, end) }
  }

  /** Nearness of what was drawn, linear on planes in the picture, of depths that are not logarithmic; 0 where nothing was. */
  #nearness(depth: Float): Float {
    return depth.sub(this.#farDepth).abs().mul(1e4).toConst()
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
    const here = uv() as unknown as Vec2
    const result = color.toVar() as Variable<Vec3>
    If(this.power.greaterThan(0), () => {
      const glow = this.#smooth
        .sample(here.mul(this.#scale).add(this.#offset))
        .level(0)
        .toConst() as Vec4
      const air = glow.z.toVar() as Variable<Float>
      // The depth that the air has read.
      const nearness = this.#nearness((this.#clouds.depthNode as unknown as Vec4).r)
      If(nearness.sub(glow.w).abs().greaterThan(glow.w.mul(UNLIKE)), () => {
        // Light of neighbours would shine over ridges and the horizon.
        air.assign(this.#airOn(here).air)
      })
      const light = channelColor(mix(vec2(air), glow.xy, transmittance.oneMinus()).toConst())
      result.addAssign(light.mul(this.power.mul(1 / STORED_POWER)).add(this.#bolt.sample(here)))
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
    this.#farDepth.value = renderer.reversedDepthBuffer ? 0 : 1
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
    const { x, y } = marched.clone().divideScalar(GLOW_PIXEL).floor().addScalar(1)
    for (const target of [this.#target, this.#smoothTarget]) target.setSize(x, y)
    this.#pass.render(renderer, this.#target)
    this.#smoothPass.render(renderer, this.#smoothTarget)
    this.#bolt.render(renderer, view, _offset, channel, power)
  }

  /** Frees render targets and passes. */
  dispose(): void {
    const targets = [this.#target, this.#smoothTarget]
    const passes = [this.#pass, this.#smoothPass, this.#bolt, this.#density]
    for (const owned of [...targets, ...passes]) owned.dispose()
  }
}

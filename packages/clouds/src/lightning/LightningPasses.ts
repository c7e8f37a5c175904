import {
  aerialPerspectiveTo,
  FragmentPass,
  outputs,
  tableTarget,
  type AtmosphereView,
  type Outputs
} from '@welkin/atmosphere'
import { Vector3, Vector4 } from 'three'
import { If, float, int, texture, uv, vec4 } from 'three/tsl'
import type { Renderer } from 'three/webgpu'
import { componentAt } from '../density/tsl/componentAt'
import type { CloudsNode } from '../march/CloudsNode'
import { POINTS } from '../march/tsl/seenPoints'
import { viewRayAt } from '../march/tsl/viewRay'
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
import { number } from '../uniforms'
import { BoltPass } from './BoltPass'
import { CHANNEL_COLOR, STEM_POINTS, type PlacedChannel } from './channel'
import { meanInverseSquare } from './tsl/lineLight'

/**
 * Depth in cloud from which its light comes: a few scaled mean free paths; the line's light is as soft [m]. Smaller: a white core where a
 * channel leaves its cloud (*Storm at night*).
 */
const CLOUD_SOFTNESS = 250
/** The same of haze: a line is as soft as its picture's pixels are wide [m]. */
const HAZE_SOFTNESS = 25
/** Longest way through lit haze [m]. */
const LONGEST_HAZE = 60_000

/** Power for which half floats hold light: 1e-9 of it is left 2 km from the channel [lm]. */
const STORED_POWER = 1e9

const _offset = new Vector3()
const _row = new Vector3()

/** What is drawn of a flash: its light in clouds and in haze, and its channel. */
export class LightningPasses {
  /** Luminous power, times `luminanceScale` [lm]. */
  readonly power = number()
  /** Scattering by haze about the flash [1/m]. */
  readonly haze = number()
  readonly #clouds: CloudsNode
  /** Points of the stem from the camera, in the mapped space [m]. */
  readonly #stem: readonly Vector4[] = Array.from({ length: STEM_POINTS }, () => new Vector4())
  readonly #stemArray = vec4Array(this.#stem as Vector4[])
  readonly #target = tableTarget('Welkin.LightningGlow', 1, 1, 2)
  readonly #glow: LevelTexture<Vec2>
  readonly #air: LevelTexture<Vec2>
  readonly #pass: FragmentPass
  readonly #bolt: BoltPass

  constructor(clouds: CloudsNode) {
    this.#clouds = clouds
    const [glow, air] = this.#target.textures.map(t => texture(t))
    this.#glow = glow as unknown as LevelTexture<Vec2>
    this.#air = air as unknown as LevelTexture<Vec2>
    this.#pass = new FragmentPass('Welkin.LightningGlow', this.#light())
    this.#bolt = new BoltPass(clouds)
  }

  /** Takes a channel. */
  set channel(channel: PlacedChannel) {
    this.#bolt.channel = channel
  }

  /** Light of one pixel of each block, for `STORED_POWER`: of clouds with their opacity, and of the air. */
  #light(): Outputs {
    const { passes, field } = this.#clouds
    const { seen, viewRays } = passes
    const layers = field.atmosphere.layers.filter(layer => !('upTo' in layer))
    return outputs<[Vec4, Vec4]>(2, ([light, air]) => {
      const here = uv() as unknown as Vec2
      const ray = viewRayAt(viewRays, here)
      const distances = seen.distances.sample(here).level(0).toConst() as Vec4
      const shares = seen.shares.sample(here).level(0).toConst() as Vec4
      const marched = seen.ray.sample(here).level(0).toConst() as Vec4
      const opacity = shares.dot(vec4(1)).toConst() as Float
      const radiance = float(0).toVar() as Variable<Float>
      loop('flashPoint', POINTS, point => {
        const own = componentAt(float(point))
        const share = shares.dot(own).toConst() as Float
        If(share.greaterThan(0), () => {
          const place = ray.direction.mul(distances.dot(own)).toConst() as Vec3
          radiance.addAssign(this.#lineLight(place).mul(share))
        })
      })
      const toClouds = shares.dot(distances).div(opacity.max(1e-4)).toConst() as Float
      const isCloud = opacity.greaterThan(1e-3)
      const seenTo = isCloud.select(toClouds, marched.x.exp2())
      const { transmittance } = aerialPerspectiveTo(
        field.view,
        ray.directionView.mul(seenTo).toConst(),
        layers
      )
      const lit = transmittance.mul(radiance).mul(STORED_POWER / (4 * Math.PI ** 2))
      light.assign(vec4(lit as Vec3, opacity))
      const end = marched.y.exp2().min(LONGEST_HAZE).toConst() as Float
      const behind = this.#hazeLight(ray.direction, end).mul(opacity.oneMinus())
      const before = this.#hazeLight(ray.direction, toClouds.min(end)).mul(opacity)
      air.assign(vec4(behind.add(before), 0, 0, 1))
    })
  }

  /** Mean of 1/(r² + s²) over the stem, for a place in clouds [1/m²]. */
  #lineLight(place: Vec3): Float {
    const sum = float(0).toVar() as Variable<Float>
    loop('flashLine', STEM_POINTS - 1, index => {
      const [from, to] = [index, index.add(int(1))].map(
        i => this.#stemArray.element(i).xyz.sub(place).toConst() as Vec3
      )
      sum.addAssign(meanInverseSquare(from, to, float(CLOUD_SOFTNESS)))
    })
    return sum.div(STEM_POINTS - 1)
  }

  /** Light that the air on a ray scatters once, without direction, for `STORED_POWER` [cd/m²]. */
  #hazeLight(direction: Vec3, end: Float): Float {
    const sum = float(0).toVar() as Variable<Float>
    If(end.greaterThan(1), () => {
      loop('flashHaze', STEM_POINTS, index => {
        const from = this.#stemArray.element(index).xyz.negate().toConst() as Vec3
        const to = from.add(direction.mul(end)).toConst() as Vec3
        sum.addAssign(meanInverseSquare(from, to, float(HAZE_SOFTNESS)))
      })
    })
    return sum
      .mul(end)
      .mul(this.haze)
      .mul(STORED_POWER / (STEM_POINTS * 16 * Math.PI ** 2))
  }

  /** Adds its light to a picture's colour. To be called inside of a shader function. */
  addTo(color: Vec3): Vec3 {
    const here = uv() as unknown as Vec2
    const result = color.toVar() as Variable<Vec3>
    If(this.power.greaterThan(0), () => {
      const { light } = this.#clouds.passes.accumulated
      const opacity = light.sample(here).level(0).a.oneMinus()
      const glow = this.#glow.sample(here).level(0).toConst() as Vec4
      const haze = this.#air.sample(here).level(0).x
      const [r, g, b] = CHANNEL_COLOR
      const all = glow.rgb
        .mul(opacity.div(glow.a.max(1e-3)))
        .add(haze)
        .mul(this.power.div(STORED_POWER))
      result.addAssign(all.mul(vec4(r, g, b, 1).rgb))
      result.addAssign(this.#bolt.sample(here))
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
    const { place, axes, stem } = channel
    _offset.copy(place).sub(viewpoint)
    stem.forEach((point, i) => {
      _row.copy(_offset)
      point.forEach((value, axis) => _row.addScaledVector(axes[axis], value))
      this.#stem[i].set(_row.x, _row.y, _row.z, 0)
    })
    this.power.value = power.all
    const { passes } = this.#clouds
    const { x, y } = passes.viewRays.frame.marchedSize.value
    this.#target.setSize(x, y)
    this.#pass.render(renderer, this.#target)
    this.#bolt.render(renderer, view, _offset, channel, power)
  }

  /** Frees render targets and passes. */
  dispose(): void {
    this.#target.dispose()
    this.#pass.dispose()
    this.#bolt.dispose()
  }
}

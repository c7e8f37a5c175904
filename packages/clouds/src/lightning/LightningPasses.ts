import {
  aerialPerspectiveTo,
  FragmentPass,
  tableTarget,
  type AtmosphereView
} from '@welkin/atmosphere'
import { Vector3, Vector4 } from 'three'
import { Fn, If, float, int, mix, texture, uv, vec2, vec3, vec4 } from 'three/tsl'
import type { Renderer } from 'three/webgpu'
import { componentAt } from '../density/tsl/componentAt'
import type { CloudsNode } from '../march/CloudsNode'
import { FAR_AWAY } from '../march/tsl/layerBoundaries'
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
import { CHANNEL_COLOR, STEM_POINTS, type PlacedChannel, type StormColumn } from './channel'
import { StormDensity } from './StormDensity'
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

/** Edge of a pixel of the glow, in marched ones. Greater: no relief in lit clouds (*Storm at night*); 2: 0.03 ms more. */
const GLOW_PIXEL = 3

/** Power for which half floats hold light: 1e-9 of it is left 2 km from the channel [lm]. */
const STORED_POWER = 1e9

/** Place of 550 nm between 630 and 440 nm in λ⁻⁴: exponent of blue in green. */
const GREEN_SHARE = (550 ** -4 - 630 ** -4) / (440 ** -4 - 630 ** -4)

const _offset = new Vector3()
const _row = new Vector3()

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
  begin(
    renderer: Renderer,
    viewpoint: Vector3,
    channel: PlacedChannel,
    storm: StormColumn,
    layer: number
  ): void {
    this.#bolt.channel = channel
    this.#density.bake(renderer, _offset.copy(channel.place).sub(viewpoint), channel, storm, layer)
  }

  /**
   * Light of one pixel of each block, for `STORED_POWER`: of clouds, red and blue, times their opacity; that opacity; of the air.
   */
  #light(): Vec4 {
    const { passes, field } = this.#clouds
    const { seen, viewRays } = passes
    const layers = field.atmosphere.layers.filter(layer => !('upTo' in layer))
    return Fn(() => {
      const here = uv() as unknown as Vec2
      const ray = viewRayAt(viewRays, here)
      const distances = seen.distances.sample(here).level(0).toConst()
      const shares = seen.shares.sample(here).level(0).toConst()
      const end = seen.ray.sample(here).level(0).y.exp2().min(LONGEST_HAZE).toConst() as Float
      const opacity = shares.dot(vec4(1)).toConst() as Float
      const light = vec4(0, 0, opacity, 0).toVar() as Variable<Vec4>
      const hazeEnd = end.toVar() as Variable<Float>
      If(opacity.greaterThan(1e-3), () => {
        const mean = shares.dot(distances).div(opacity).toConst() as Float
        // Clouds before each other are lit apart: what comes out is known at the nearest and the farthest point.
        const far = float(0).toVar() as Variable<Float>
        const near = float(FAR_AWAY).toVar() as Variable<Float>
        for (const i of ['x', 'y', 'z', 'w'] as const) {
          const isSeen = shares[i].greaterThan(0)
          far.assign(isSeen.select(far.max(distances[i]), far))
          near.assign(isSeen.select(near.min(distances[i]), near))
        }
        const outAt = (at: Float): Float =>
          this.#density.lightOut(ray.direction.mul(at).toConst()).toConst()
        const nearOut = outAt(near)
        const farOut = nearOut.toVar() as Variable<Float>
        If(far.sub(near).greaterThan(CLOUD_SOFTNESS), () => {
          farOut.assign(outAt(far))
        })
        const radiance = float(0).toVar() as Variable<Float>
        loop('flashPoint', POINTS, point => {
          const own = componentAt(float(point))
          const share = shares.dot(own).toConst() as Float
          If(share.greaterThan(0), () => {
            const distance = distances.dot(own).toConst() as Float
            const between = distance.sub(near).div(far.sub(near).max(1))
            const out = mix(nearOut, farOut, between).mul(share)
            radiance.addAssign(this.#lineLight(ray.direction.mul(distance).toConst()).mul(out))
          })
        })
        const displacement = ray.directionView.mul(mean).toConst()
        const { transmittance } = aerialPerspectiveTo(field.view, displacement, layers)
        const lit = transmittance.mul(radiance).mul(STORED_POWER / (4 * Math.PI ** 2))
        light.assign(vec4(lit.x, lit.z, opacity, 0))
        hazeEnd.assign(mix(end, mean.min(end), opacity))
      })
      return vec4(light.xyz, this.#hazeLight(ray.direction, hazeEnd))
    })()
  }

  /** Glow by a tent: marched pixels are one of each block, and it hides which. */
  #smoothed(): Vec4 {
    return Fn(() => {
      const here = uv() as unknown as Vec2
      const texel = vec2(0.5 * GLOW_PIXEL)
        .div(this.#clouds.passes.viewRays.frame.marchedSize)
        .toConst() as Vec2
      const glow = vec4(0).toVar() as Variable<Vec4>
      for (const [x, y] of [
        [-1, -1],
        [1, -1],
        [-1, 1],
        [1, 1]
      ])
        glow.addAssign(this.#glow.sample(here.add(texel.mul(vec2(x, y)))).level(0))
      return glow.mul(0.25)
    })()
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

  /** Adds its light to a picture's colour. To be called inside of a shader function. */
  addTo(color: Vec3): Vec3 {
    const here = uv() as unknown as Vec2
    const result = color.toVar() as Variable<Vec3>
    If(this.power.greaterThan(0), () => {
      const { light } = this.#clouds.passes.accumulated
      const opacity = light.sample(here).level(0).a.oneMinus()
      const glow = this.#smooth.sample(here).level(0).toConst() as Vec4
      const [r, g, b] = CHANNEL_COLOR
      // Green lies between red and blue as λ⁻⁴ does: their mean by geometry, as a fraction of first order in their ratio.
      const [more, less] = [1 + GREEN_SHARE, 1 - GREEN_SHARE]
      const [x, y] = [glow.x, glow.y.max(1e-7)]
      const green = x.mul(y.mul(more).add(x.mul(less))).div(y.mul(less).add(x.mul(more)))
      const cloud = vec3(glow.x, green, glow.y).mul(opacity.div(glow.z.max(2.5e-4)))
      const all = cloud.add(glow.w).mul(this.power.div(STORED_POWER))
      result.addAssign(all.mul(vec3(r, g, b)))
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
      this.#stem[i].set(_row.x, _row.y, _row.z, hazeAt(view, point[2]))
    })
    this.#density.update(_offset)
    this.power.value = power.all
    const { passes } = this.#clouds
    const marched = passes.viewRays.frame.marchedSize.value
    // Never a half: pixels between two marched ones would take either, by the backend.
    const [x, y] = [marched.x, marched.y].map(size => Math.floor(size / GLOW_PIXEL) + 1)
    this.#target.setSize(x, y)
    this.#smoothTarget.setSize(x, y)
    this.#pass.render(renderer, this.#target)
    this.#smoothPass.render(renderer, this.#smoothTarget)
    this.#bolt.render(renderer, view, _offset, channel, power)
  }

  /** Frees render targets and passes. */
  dispose(): void {
    for (const owned of [this.#target, this.#smoothTarget]) owned.dispose()
    for (const owned of [this.#pass, this.#smoothPass, this.#bolt, this.#density]) owned.dispose()
  }
}

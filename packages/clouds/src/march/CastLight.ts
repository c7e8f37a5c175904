import { FragmentPass, outputs, tableTarget, type Outputs } from '@welkin/atmosphere'
import { FloatType, NearestFilter } from 'three'
import type { RenderTarget } from 'three'
import { If, float, int, texture, uv, vec4 } from 'three/tsl'
import type { Renderer } from 'three/webgpu'
import { select } from '../select'
import { componentAt } from '../density/tsl/componentAt'
import { isNight } from '../light/tsl/night'
import type { CloudCaster } from '../light/tsl/shadingContext'
import { POINTS, type SeenPoints } from './tsl/seenPoints'
import type { FallPlaces } from './tsl/fallOnRays'
import { FARTHEST } from '../temporal/tsl/packing'
import { loop, type Float, type LevelTexture, type Vec2, type Vec3, type Vec4 } from '../tsl-types'
import { marchedPixel, type MarchedTargets } from './tsl/marchedPixel'
import { viewRayAt, type FrameInputs } from './tsl/viewRay'

/** Factors that bring a marched ray's log₂ distances, transmittance and steps into [0, 1]. */
const RAY_SCALE = [1 / FARTHEST, 1 / FARTHEST, 1, 1] as const

/** A number in [0, 1] and a byte in one float32: the byte is the whole part. */
const withByte = (value: Vec4, byte: Vec4): Vec4 =>
  byte.mul(255).round().add(value.clamp().mul(0.5))

/** The inverse of {@link withByte}. */
const parted = (both: Vec4): { value: Vec4; byte: Vec4 } => {
  const byte = both.floor().toConst() as Vec4
  return { value: both.sub(byte).mul(2).toConst(), byte: byte.div(255).toConst() }
}

/** Clouds of a camera, and their casters. */
export interface CastScene {
  readonly viewRays: FrameInputs
  readonly precipitation?: FallPlaces
  readonly casters: ReadonlySet<CloudCaster>
}

/** Shares of the points of a ray's clouds, with the light that casters leave to them. */
export interface CastPoints {
  readonly shares: Vec4
  /** Parts of the light that reach the points, in [0, 1], where a pass has found them. */
  readonly lit?: Vec4
}

/** A marched ray, with the light that casters leave to what falls. */
export interface CastRay {
  readonly ray: Vec4
  /** Parts that reach four places of what falls: see `PrecipitationShafts.placesOn`. */
  readonly litFall?: Vec4
}

/**
 * Light that casters besides the clouds leave to what rays see. One caster is looked up in the light's pass, where that has textures
 * to spare: without a map of the world and what falls. Else there is a pass between the march and its light, which
 * takes 0.05 ms more. It writes what it finds beside what the march has written, so that the light's pass samples as many textures with casters
 * as without, whatever these sample.
 */
export class CastLight {
  readonly #scene: CastScene
  readonly #marched: MarchedTargets
  readonly #target: RenderTarget
  readonly #packed: readonly LevelTexture<Vec2>[]
  #pass: FragmentPass | undefined
  /** Casters for which the pass was compiled. */
  #version = ''

  constructor(scene: CastScene, marched: MarchedTargets) {
    this.#scene = scene
    this.#marched = marched
    const count = scene.precipitation ? 2 : 1
    this.#target = tableTarget('Welkin.CloudsCast', 1, 1, count, NearestFilter)
    for (const each of this.#target.textures) each.type = FloatType
    this.#packed = this.#target.textures.map(each => texture(each) as unknown as LevelTexture<Vec2>)
  }

  /** Casters for which the light's pass is compiled: where they have a pass of their own, it matters only that there are some. */
  get version(): string {
    return this.#hasPass ? 'pass' : this.#casters
  }

  /** Key of all casters' shaders, and of the light that each is in. */
  get #casters(): string {
    const { casters, viewRays } = this.#scene
    const { night } = viewRays.field
    const isMoonlit = (caster: CloudCaster): boolean => caster.source === night.source
    return Array.from(casters, caster => `${caster.version} ${isMoonlit(caster)}`).join()
  }

  get #hasPass(): boolean {
    const { casters, precipitation, viewRays } = this.#scene
    return casters.size > (precipitation || viewRays.field.worldMap ? 0 : 1)
  }

  setSize(width: number, height: number): void {
    this.#target.setSize(width, height)
  }

  /** Draws the pass, if there is one; the march goes first. */
  render(renderer: Renderer): void {
    if (!this.#hasPass) {
      if (this.#pass !== undefined) this.dispose()
      return
    }
    const version = this.#casters
    if (this.#pass === undefined || version !== this.#version) {
      this.#pass?.dispose()
      this.#pass = new FragmentPass('Welkin.CloudsCast', this.#draw())
      this.#version = version
    }
    this.#pass.render(renderer, this.#target)
  }

  #draw(): Outputs {
    const { viewRays, precipitation } = this.#scene
    const count = this.#packed.length
    return outputs<Vec4[]>(count, ([points, fallen]) => {
      const { at, noise } = marchedPixel(viewRays)
      const here = uv() as unknown as Vec2
      const [distances, shares, ray] = (['distances', 'shares', 'ray'] as const).map(
        name => this.#marched[name].sample(here).level(0).toConst() as Vec4
      )
      const { direction } = viewRayAt(viewRays, at)
      const fall = precipitation?.placesOn(viewRays.field, direction, ray, distances)
      const lit = vec4(1).toVar() as Vec4
      const litFall = vec4(1).toVar() as Vec4
      loop('castPlace', count * POINTS, index => {
        const isFall = index.greaterThanEqual(int(POINTS)).toConst()
        const own = componentAt(float(index).mod(POINTS))
        const distance = select(isFall, fall?.dot(own) ?? 0, distances.dot(own)).toConst() as Float
        If(select(isFall, distance, shares.dot(own)).greaterThan(0), () => {
          const dark = own.mul(this.#litAt(direction, distance, noise).oneMinus()).toConst() as Vec4
          lit.subAssign(dark.mul(select(isFall, 0, 1)))
          litFall.subAssign(dark.mul(select(isFall, 1, 0)))
        })
      })
      points.assign(withByte(shares, lit))
      fallen?.assign(withByte(ray.mul(vec4(...RAY_SCALE)), litFall))
    })
  }

  /** Part of the light that arrives at a place of a ray: of the moon's where it is night, or else of the sun's. */
  #litAt(direction: Vec3, distance: Float, jitter: Float): Float {
    const { casters, viewRays } = this.#scene
    const { field } = viewRays
    const { view, night, atmosphere } = field
    const { up } = view.localCoordinates(direction.mul(distance).toConst())
    const lit = float(1).toVar() as Float
    const pass = (isCast: (caster: CloudCaster) => boolean): void => {
      for (const caster of [...casters].filter(isCast)) {
        lit.mulAssign(caster.litAt({ direction, jitter }, distance))
      }
    }
    If(isNight(field, up.dot(view.lightDirection)), () => {
      pass(({ source }) => source === night.source)
    }).Else(() => {
      pass(({ source }) => source === atmosphere.sun)
    })
    return lit
  }

  #read(node: LevelTexture<Vec2>, here: Vec2): Vec4 {
    return node.sample(here).level(0).toConst()
  }

  /** Points of a pixel's ray; to be called inside of a shader function. */
  pointsAt(here: Vec2): CastPoints {
    if (!this.#hasPass) return { shares: this.#read(this.#marched.shares, here) }
    const points = parted(this.#read(this.#packed[0], here))
    return { shares: points.value, lit: points.byte }
  }

  /** Ray of a pixel, as it was marched; to be called inside of a shader function. */
  rayAt(here: Vec2): CastRay {
    if (!this.#hasPass || this.#packed.length === 1)
      return { ray: this.#read(this.#marched.ray, here) }
    const fallen = parted(this.#read(this.#packed[1], here))
    return { ray: fallen.value.div(vec4(...RAY_SCALE)).toConst(), litFall: fallen.byte }
  }

  /** Part of the light that reaches a point of a ray: see `SeenPoints.lit`. */
  litOn({ lit }: CastPoints, direction: Vec3, jitter: Float): SeenPoints['lit'] {
    if (lit !== undefined) return own => lit.dot(own)
    if (this.#scene.casters.size === 0) return undefined
    return (_, distance) => this.#litAt(direction, distance, jitter)
  }

  /** Frees its textures; it may be drawn again. */
  dispose(): void {
    this.#target.dispose()
    this.#pass?.dispose()
    this.#pass = undefined
  }
}

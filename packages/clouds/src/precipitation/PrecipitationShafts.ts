import type { AtmosphereView, ScatteringPhase } from '@welkin/atmosphere'
import { checkOptions, fail } from '@welkin/geo'
import { MathUtils, Vector3, Vector4 } from 'three'
import { If, int, vec3, vec4 } from 'three/tsl'
import { select } from '../select'
import type { CloudField } from '../density/CloudField'
import type { LayerNodes } from '../density/tsl/layer'
import type { CloudSample } from '../density/tsl/sample'
import { CloudLayers } from '../layers/CloudLayers'
import { dry } from '../layers/precipitation'
import { layerPeriods } from '../layers/layerUniforms'
import { meanColumnOf } from '../layers/meanColumn'
import { windAxis } from '../layers/wind'
import type { ShadingContext } from '../light/tsl/shadingContext'
import { FallPass, type FallScene } from '../march/FallPass'
import type { CloudTargets } from '../temporal/tsl/renderTargets'
import type { FallOnRay, LitRays } from '../march/tsl/fallOnRays'
import type { MarchedTargets } from '../march/tsl/marchedPixel'
import { POINTS } from '../march/tsl/seenPoints'
import { GROWING_TOGETHER } from '../march/tsl/layerBoundaries'
import type { DeckFallNodes } from '../environment/tsl/decks'
import { vec4Array, type Float, type Int, type Variable, type Vec3, type Vec4 } from '../tsl-types'
import { number } from '../uniforms'
import { fallColumnOf } from './cpu/fallColumn'
import { DIFFRACTED, fallFloor, fallForm, STREAK_WIDTH } from './fallForm'
import { fallenFrom } from './tsl/fall'
import type { FallNodes } from './tsl/fallColumn'
import { fallExtinctions } from './tsl/fallExtinctions'
import {
  distanceAt,
  endOf,
  FARTHEST,
  fallStretch,
  partAt,
  type FallStretch
} from './tsl/fallStretch'
import { CLOUD_RADIUS, lightPrecipitation } from './tsl/lightPrecipitation'
import { LEAST_SEEN, marchPrecipitation } from './tsl/marchPrecipitation'

/** Options of {@link PrecipitationShafts}. */
export interface PrecipitationShaftsOptions {
  /**
   * Phase function of the drops, `raindrops({ rate: 8 })`, with rainbows; shared, not owned. Null, the default, for a smooth one.
   */
  drops?: ScatteringPhase | null
}

/** Vectors that a layer takes in the uniforms. */
const STRIDE = 4

/** Path of horizontal light through precipitation from a deck [m]. */
const DECK_WIDTH = 1500

/** Shortest mean length of steps over the width of coarse streaks [–], and its upper bound [m]. Longer: virga has grain (*Virga*). */
const STEP = 0.2
const LONGEST_STEP = 1200

/** Altitude below all that is drawn, where nothing falls [m]. */
const NOWHERE = -1000

const _axis = new Vector3()

/**
 * Rain, snow and hail under clouds, as shafts and curtains seen from afar: a medium for `clouds`.
 *
 * ```ts
 * const layers = cloudPreset('shower')
 * layers.at(0).precipitation = { rate: 20 } // at any time
 * const drops = raindrops({ rate: 20 })     // for rainbows; else left out
 * const node = clouds(air, depth, camera, atmosphere, layers, { precipitation: precipitationShafts({ drops }) })
 * ```
 *
 * It falls under the strongest columns of a layer, leans with the wind, which grows with height, and with the layer's shear, and is lit as
 * clouds are: by the sun where no cloud is before it, by the sky and the ground. A node draws it before and behind its clouds, through air.
 * Serves one node; it has no textures of its own.
 *
 * @see Atlas 1953, "Optical extinction by rainfall", J. Meteor. 10, pp. 486–488
 * @see Marshall 1953, "Precipitation trajectories and patterns", J. Meteor. 10, pp. 25–29
 */
export class PrecipitationShafts {
  /** Phase function of the drops; shared, not owned. */
  readonly drops: ScatteringPhase | null
  readonly #values: Vector4[] = Array.from(
    { length: CloudLayers.maxLayers * STRIDE },
    () => new Vector4()
  )
  readonly #array = vec4Array(this.#values)
  /** Altitude above which nothing falls; below 0 where nothing falls at all [m]. */
  readonly ceiling = number(NOWHERE)
  readonly #floor = number(NOWHERE)
  readonly #width = number()
  readonly #shortest = number(LONGEST_STEP)
  readonly #firstLayer = number()
  readonly #endLayer = number()
  readonly #above = {
    depth: number(),
    layered: number(),
    baseAltitude: number(),
    period: number(1)
  }
  /** False where nothing falls, or all of it is too far below the camera to be seen: by the last `update`. */
  isFalling = false
  #version = 0
  #state = ''

  /** @throws If an option is unknown, or the drops are none. */
  constructor(options: PrecipitationShaftsOptions = {}) {
    const { drops = null } = checkOptions('PrecipitationShafts', options, 'drops')
    if (drops !== null && typeof drops?.phase !== 'function') {
      fail('PrecipitationShafts', 'drops must be a ScatteringPhase or null', drops)
    }
    this.drops = drops
  }

  /**
   * Copies the layers of a field into uniforms; the field's `update` goes first.
   *
   * @returns Count of changes other than those of wind and camera.
   */
  update({ layers, depthScale }: CloudField, { up, height }: AtmosphereView): number {
    let [ceiling, floor, most] = [NOWHERE, Infinity, 0]
    let shortest = LONGEST_STEP
    let [firstLayer, endLayer] = [CloudLayers.maxLayers, 0]
    for (const [i, { parameters }] of [...layers].entries()) {
      const { baseAltitude, topAltitude, coverage, density, wind, shear } = parameters
      const { rate, share, virgaDepth, freezingLevel, hail, streaks } = {
        ...dry,
        ...parameters.precipitation
      }
      const thickness = topAltitude - baseAltitude
      const layerCeiling = baseAltitude + thickness * fallForm.onset
      const growth =
        (Math.hypot(wind.east, wind.north) * (1 - fallForm.groundWind)) /
        Math.max(baseAltitude, 100)
      const [first, second, third, fourth] = this.#values.slice(i * STRIDE)
      first.set(rate, share, virgaDepth > 0 ? 1 / virgaDepth : 0, freezingLevel)
      windAxis(wind, up, _axis)
      const { x, y, z } = _axis
      second.set(x, y, z, 0).multiplyScalar(growth / 2).w = hail
      third.set(x, y, z, 0).multiplyScalar(shear).w = layerCeiling
      fourth.fromArray([...(fallColumnOf(parameters)?.parts ?? [0, 0, 0]), streaks])
      if (rate === 0 || coverage === 0) continue
      ceiling = Math.max(ceiling, layerCeiling)
      floor = Math.min(floor, fallFloor(baseAltitude, virgaDepth))
      firstLayer = Math.min(firstLayer, i)
      endLayer = i + 1
      const { weather, shape } = layerPeriods(parameters)
      // Fine streaks of weak virga are seen beside a strong shower, too.
      shortest = Math.min(shortest, STEP * STREAK_WIDTH * shape)
      if (rate <= most) continue
      most = rate
      const column = meanColumnOf(parameters, depthScale.value)
      const { depth, layered, baseAltitude: base, period } = this.#above
      depth.value = density * thickness * column.insideDensity * depthScale.value
      layered.value = MathUtils.smoothstep(coverage, ...GROWING_TOGETHER)
      base.value = baseAltitude
      period.value = weather
      this.#width.value = MathUtils.lerp(period.value * CLOUD_RADIUS, DECK_WIDTH, layered.value)
    }
    this.isFalling = endLayer > 0 && height < ceiling + FARTHEST
    this.ceiling.value = ceiling
    this.#floor.value = Math.max(floor, NOWHERE)
    this.#shortest.value = shortest
    this.#firstLayer.value = Math.min(firstLayer, endLayer)
    this.#endLayer.value = endLayer
    const state = JSON.stringify([...layers].map(layer => layer.parameters.precipitation))
    if (state !== this.#state) this.#version++
    this.#state = state
    return this.#version + (this.drops?.version ?? 0)
  }

  /** The pass that draws it, for the clouds of a node. */
  passOf(scene: FallScene, marched: MarchedTargets, cast: LitRays, shaded: CloudTargets): FallPass {
    return new FallPass(scene, this, marched, cast, shaded)
  }

  /** Extinction of light by what falls from a layer, without what is only diffracted [1/m]. To be called inside of a shader function. */
  extinctionAt(field: CloudField, layer: LayerNodes, sample: CloudSample): Float {
    const falls = this.fallOf(layer.index)
    const { rate, snow, hail } = fallenFrom(field, undefined, layer, falls, sample)
    return fallExtinctions(rate, snow, hail).x.mul(1 - DIFFRACTED)
  }

  /**
   * Rain and snow from a layer in the mean, for the light of the sky. To be called inside of a shader function. Twin: cpu/fallColumn.ts
   *
   * @param altitude - Altitude of a plane [m].
   */
  deckFall(index: Int, altitude: Float): DeckFallNodes {
    const { share, ceiling, parts } = this.fallOf(index)
    const place = ceiling.sub(altitude).mul(3).div(ceiling.max(1))
    const over = parts
      .dot(
        vec3(place)
          .sub(vec3(0, 1, 2))
          .clamp()
      )
      .toConst() as Float
    return { share, over, under: parts.dot(vec3(1)).sub(over).toConst() }
  }

  /** Precipitation of a layer, as shader nodes. */
  fallOf(index: Int): FallNodes {
    const start = index.mul(int(STRIDE)).toConst()
    const [first, second, third, fourth] = [0, 1, 2, 3].map(
      slot => this.#array.element(start.add(int(slot))).toConst() as Vec4
    )
    return {
      rate: first.x,
      share: first.y,
      perVirga: first.z,
      freezingLevel: first.w,
      windAxis: second.xyz,
      hail: second.w,
      shearAxis: third.xyz,
      ceiling: third.w,
      parts: fourth.xyz,
      streaks: fourth.w
    }
  }

  /**
   * Stretch of a ray on which something falls. To be called inside of a shader function.
   *
   * @param marched - Ray of the march: log₂ of its end, and transmittance, in y and z.
   * @param distances - Distances of the clouds' points [m].
   */
  #stretchOn(field: CloudField, direction: Vec3, marched: Vec4, distances: Vec4): FallStretch {
    const end = endOf(marched, distances).exp2().toConst() as Float
    const space = { ceiling: this.ceiling, floor: this.#floor }
    return fallStretch(field, space, { direction, end })
  }

  /**
   * Distances of as many places of a ray on which something falls as clouds have points; 0 where nothing does [m]. The light that
   * casters leave is found between them, at the mean distance of what falls. To be called inside of a shader function; arguments as for {@link among}.
   */
  placesOn(field: CloudField, direction: Vec3, marched: Vec4, distances: Vec4): Vec4 {
    const stretch = this.#stretchOn(field, direction, marched, distances)
    const parts = vec4(0, 1, 2, 3).add(0.5).div(POINTS) as Vec4
    const isThere = stretch.span.greaterThan(1)
    return distanceAt(stretch, parts)
      .mul(select(isThere, 1, 0))
      .toConst()
  }

  /** Part of the light that reaches a distance, between the places of {@link placesOn}. */
  #litAt(stretch: FallStretch, litFall: Vec4, distance: Float): Float {
    const place = partAt(stretch, distance)
      .mul(POINTS)
      .sub(0.5)
      .clamp(0, POINTS - 1)
    const weights = vec4(0, 1, 2, 3).sub(place).abs().min(1).oneMinus()
    return litFall.dot(weights).toConst()
  }

  /**
   * Precipitation on a ray, with its light. To be called inside of a shader function.
   *
   * @param ray - Its direction, noise in [0, 1), what was marched (log₂ of the clouds' distance and of its end, transmittance), and
   *   parts of the light that casters leave at {@link placesOn}, if there are any.
   * @param distances - Distances of the clouds' points [m].
   */
  among(
    context: ShadingContext,
    ray: { direction: Vec3; jitter: Float; marched: Vec4; litFall?: Vec4 },
    distances: Vec4
  ): FallOnRay {
    const { direction, marched, litFall } = ray
    const stretch = this.#stretchOn(context.field, direction, marched, distances)
    const { from, span } = stretch
    const space = {
      fallOf: (index: Int) => this.fallOf(index),
      layers: {
        first: this.#firstLayer.toInt().toConst(),
        last: this.#endLayer.toInt().toConst()
      },
      ceiling: this.ceiling,
      width: this.#width,
      shortest: this.#shortest
    }
    const radiance = vec4(0).toVar() as Variable<Vec4>
    const seen = marchPrecipitation(context, space, ray, stretch)
    const { weight, distance } = seen
    If(weight.greaterThan(LEAST_SEEN), () => {
      const lit = litFall && this.#litAt(stretch, litFall, distance)
      radiance.assign(lightPrecipitation(context, this.drops, direction, seen, this.#above, lit))
    })
    // Nothing lies before the stretch or behind it.
    const room = distance.sub(from).min(from.add(span).sub(distance)).max(1)
    const half = seen.spread.mul(Math.sqrt(3)).clamp(1, room).toConst() as Float
    return { radiance, opacity: weight, distance, half, end: stretch.end }
  }
}

/** Rain, snow and hail under clouds: see {@link PrecipitationShafts}. */
export const precipitationShafts = (options?: PrecipitationShaftsOptions): PrecipitationShafts =>
  new PrecipitationShafts(options)

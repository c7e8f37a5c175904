import { octahedralDirection, octahedralPoint, tableTarget, viewNodes } from '@welkin/atmosphere'
import type { AtmosphereView, SkyOverlay, ViewNodes } from '@welkin/atmosphere'
import { checkOptions, checkPositive, fail } from '@welkin/geo'
import { Vector3 } from 'three'
import type { Quaternion, RenderTarget } from 'three'
import { Fn, float, texture, transpose, uniform, uv, vec4 } from 'three/tsl'
import type { Renderer } from 'three/webgpu'
import { checkClouds } from '../check'
import { CloudField, viewpointMapped } from '../density/CloudField'
import { PassByKinds } from '../density/kinds'
import { WeatherMap } from '../density/WeatherMap'
import type { CloudsNode } from '../march/CloudsNode'
import { nightGain } from '../light/NightLight'
import {
  QualityUniforms,
  resolveQuality,
  type CloudQuality,
  type CloudQualityName
} from '../march/quality'
import { withAerialPerspective } from '../march/tsl/aerialPerspective'
import { litClouds } from '../march/tsl/shadePoints'
import { interleavedNoise } from '../temporal/tsl/noisePattern'
import { groundDistance } from '../march/tsl/layerBoundaries'
import type { LevelTexture, Mat3, Mat4, Vec2, Vec3 } from '../tsl-types'
import { matrix3, matrix4, number, vector3 } from '../uniforms'

/** Options of {@link cloudEnvironment}. */
export interface CloudEnvironmentOptions {
  /** Edge of the square map of all directions, in [16, 2048]; by default 256 [pixels]. */
  size?: number
  /** Fineness of the march; by default `'low'`. */
  quality?: CloudQualityName | CloudQuality
  /** Distance that the wind may carry clouds before they are drawn again, > 0; by default 200 [m]. */
  drift?: number
}

/**
 * Frames that the clouds' shadow maps take to follow a change, three cascades of four strips: the map is
 * drawn after them.
 */
const WAIT = 12

/** Strips that the map is drawn in, one a frame. */
const STRIPS = 6

/** Luminance scale of what is stored: by day, half floats hold it well. */
const STORED_SCALE = 1e-4

const _center = new Vector3()
const _pole = new Vector3(0, 0, 1)

/**
 * Change of the direction to the moon, or of its light's strength, for which the map is drawn again. Greater:
 * reflections jump (*24 hours*).
 */
const MOON_CHANGE = 2e-3

/** State of the clouds that a map shows; compared to tell whether it is out of date. */
interface CloudState {
  /** Values that have to stay the same. */
  readonly inputs: readonly unknown[]
  /** Rotations of the layers by the wind. */
  readonly rotations: readonly Quaternion[]
  /** Direction to the moon times its strength; 0 by day. */
  readonly moonlight: Vector3
}

/**
 * Cloud environment map: clouds in all directions about a `skyEnvironment`'s place, for materials to
 * mirror. An octahedral map (`octahedralPoint`) with the nadir in its corners, marched as a `CloudsNode` marches its pixels,
 * in six strips, one a frame, once the clouds' shadow maps have followed. It has a `WeatherMap` of its own, with which its shader compiles several times as fast.
 *
 * ```ts
 * const overlay = cloudEnvironment(cloudsNode)
 * scene.environmentNode = skyEnvironment(atmosphere, { overlay })
 * ```
 *
 * It is drawn again with the environment, and when layers are changed or have drifted, or the moon that
 * lights them has moved. Use one per environment.
 */
export class CloudEnvironment implements SkyOverlay {
  readonly steps = WAIT + STRIPS
  /** Node whose clouds it shows; shared, not owned. */
  readonly clouds: CloudsNode
  #drift = 200
  readonly #target: RenderTarget
  readonly #map: LevelTexture<Vec2>
  /** Fineness of the march. */
  readonly quality: CloudQuality
  readonly #quality = new QualityUniforms()
  /** Axes of the map, east, north and zenith at its place, to those of the mapped space. */
  readonly #axes = matrix4()
  /** Displacements in the mapped space to view space. */
  readonly #fromMapped = matrix3()
  /** Stored light per light. */
  readonly #gain = number(1)
  /** Scale of what is stored, for light without a luminance scale. */
  #storedScale = STORED_SCALE
  /** Displacement from the camera of the shadow maps to the environment's [m]. */
  readonly #shift = vector3()
  #field: CloudField | null = null
  #weatherMap: WeatherMap | null = null
  #pass: PassByKinds | null = null
  #drawn: CloudState | null = null
  #version = 0

  /** @throws If the clouds are missing, or an option is out of its range. */
  constructor(clouds: CloudsNode, options: CloudEnvironmentOptions = {}) {
    checkClouds('CloudEnvironment', clouds)
    checkOptions('CloudEnvironment', options, 'size', 'quality', 'drift')
    const { size = 256, quality = 'low', drift = 200 } = options
    if (!(Number.isInteger(size) && size >= 16 && size <= 2048)) {
      fail('CloudEnvironment', 'size must be an integer in [16, 2048]', size)
    }
    this.clouds = clouds
    this.drift = drift
    this.quality = resolveQuality('CloudEnvironment', quality)
    this.#quality.set(this.quality)
    this.#target = tableTarget('Welkin.CloudEnvironment', size, size)
    this.#target.scissorTest = true
    this.#map = texture(this.#target.texture) as unknown as LevelTexture<Vec2>
  }

  /** Distance that the wind may carry clouds before they are drawn again, > 0 [m]. */
  get drift(): number {
    return this.#drift
  }

  set drift(value: number) {
    checkPositive('CloudEnvironment', 'drift', value)
    this.#drift = value
  }

  /** Pixels along an edge of the picture. */
  get size(): number {
    return this.#target.width
  }

  /** See `SkyOverlay.version`. */
  get version(): number {
    return this.#isAsDrawn() ? this.#version : this.#version + 1
  }

  #state(): CloudState {
    const { field, light, shadows } = this.clouds
    const { moonDirection, illuminance, moonIrradiance } = field.night
    // At dusk the sun outshines the moon, however fast that moves.
    const moonlight = shadows.nodes.isMoonlit.value * moonIrradiance.value.y
    return {
      inputs: [
        light.texture.version,
        field.fadeIn === 1,
        shadows.isDrawn,
        illuminance,
        ...[...field.layers].map(({ parameters }) => parameters)
      ],
      rotations: field.rotations.map(rotation => rotation.clone()),
      moonlight: moonDirection.value.clone().multiplyScalar(moonlight)
    }
  }

  #isAsDrawn(): boolean {
    if (this.#drawn === null) return false
    const { inputs, rotations, moonlight } = this.#drawn
    const now = this.#state()
    const maxAngle = this.drift / this.clouds.atmosphere.parameters.bottomRadius
    return (
      inputs.every((input, i) => input === now.inputs[i]) &&
      rotations.every((turn, i) => turn.angleTo(now.rotations[i]) <= maxAngle) &&
      moonlight.distanceTo(now.moonlight) <= MOON_CHANGE * moonlight.length()
    )
  }

  /** See `SkyOverlay.draw`. */
  draw(renderer: Renderer, view: AtmosphereView, step: number): void {
    const { atmosphere, shadows } = this.clouds
    const field = view.camera === this.#field?.view.camera ? this.#field : this.#build(view)
    if (field.view.update(view) === undefined) return
    const strip = step - WAIT
    if (strip < 0) return
    if (strip === 0) {
      this.#begin(view, field)
      this.#weatherMap?.render(renderer, view.up)
    }
    this.#gain.value = this.#storedScale / atmosphere.luminanceScale
    viewpointMapped(view, this.#shift.value).sub(shadows.camera)
    const { width: size } = this.#target
    const [from, to] = [strip, strip + 1].map(part => Math.round((part * size) / STRIPS))
    this.#target.scissor.set(0, from, size, to - from)
    this.#pass?.render(renderer, this.#target)
  }

  /** Fixes clouds, sun and viewpoint for all strips of a picture. */
  #begin(view: AtmosphereView, field: CloudField): void {
    const { rotations, night, depthScale } = this.clouds.field
    if (!this.#isAsDrawn()) this.#version++
    this.#drawn = this.#state()
    rotations.forEach((turn, i) => field.rotations[i].copy(turn))
    field.pixelAngle.value = 2 / this.#target.width
    field.depthScale.value = depthScale.value
    field.night.illuminance = night.illuminance
    // Its clock stands still: rotations are copied from the camera's field.
    field.update(view, 0)
    this.#storedScale = STORED_SCALE * nightGain(view, field.radius.value)
    this.#fromMapped.value.copy(view.viewToMapped).invert()
    // East is the cross product of pole and zenith.
    this.#axes.value.lookAt(view.up, _center, _pole)
  }

  /** Makes field and shader for the environment's camera. */
  #build({ camera }: AtmosphereView): CloudField {
    const { atmosphere, field: source, light, shadows } = this.clouds
    const { layers, noise, worldMap, extinction } = source
    this.#freeView()
    const view = viewNodes(atmosphere, camera)
    const field = new CloudField(atmosphere, layers, view, { noise, worldMap, extinction })
    const weatherMap = new WeatherMap(field)
    const context = { weatherMap, light: light.nodes, quality: this.#quality }
    const draw = (compiled: CloudField) =>
      Fn(() => {
        const at = uv() as unknown as Vec2
        const local = octahedralDirection(at.mul(2).sub(1)).toConst()
        const direction = (this.#axes as unknown as Mat4).mul(vec4(local, 0)).xyz.toConst() as Vec3
        const end = groundDistance(field, direction.dot(view.up).clamp(-1, 1).toConst())
        const maps = { ...shadows.nodes, shift: this.#shift }
        const pixel = at.mul(this.#target.width).floor().toConst() as Vec2
        const jitter = interleavedNoise(pixel, float(0))
        const ray = { direction, end, jitter }
        const marched = litClouds({ ...context, field: compiled, shadows: maps }, ray)
        const directionView = (this.#fromMapped as unknown as Mat3).mul(direction)
        return withAerialPerspective(view, marched, directionView, this.#gain)
      })()
    this.#weatherMap = weatherMap
    this.#pass = new PassByKinds('Welkin.CloudEnvironment', field, draw)
    return (this.#field = field)
  }

  /** See `SkyOverlay.over`. */
  over(_view: ViewNodes, direction: Vec3, sky: Vec3): Vec3 {
    const { atmosphere } = this.clouds
    const scale = uniform(1).onRenderUpdate(() => atmosphere.luminanceScale / this.#storedScale)
    const local = transpose(this.#axes as unknown as Mat4)
      .mul(vec4(direction, 0))
      .xyz.toConst()
    const at = octahedralPoint(local).mul(0.5).add(0.5)
    const clouds = this.#map.sample(at).level(0).toConst()
    return sky.mul(clouds.a).add(clouds.rgb.mul(scale))
  }

  /** Frees the map. */
  dispose(): void {
    this.#target.dispose()
    this.#freeView()
    this.#drawn = null
  }

  /** Frees what belongs to one camera. */
  #freeView(): void {
    for (const own of [this.#pass, this.#weatherMap, this.#field]) own?.dispose()
    this.#pass = this.#weatherMap = this.#field = null
  }
}

/** Cloud environment map for a `skyEnvironment`: see {@link CloudEnvironment}. */
export const cloudEnvironment = (
  clouds: CloudsNode,
  options: CloudEnvironmentOptions = {}
): CloudEnvironment => new CloudEnvironment(clouds, options)

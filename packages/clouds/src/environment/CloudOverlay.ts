import {
  FragmentPass,
  octahedralDirection,
  octahedralPoint,
  tableTarget,
  viewNodes
} from '@welkin/atmosphere'
import type { AtmosphereView, SkyOverlay, ViewNodes } from '@welkin/atmosphere'
import { checkOptions, checkPositive, fail } from '@welkin/geo'
import { Vector3 } from 'three'
import type { Quaternion, RenderTarget } from 'three'
import { Fn, float, texture, transpose, uniform, uv, vec4 } from 'three/tsl'
import type { Renderer } from 'three/webgpu'
import { checkClouds } from '../check'
import { CloudField, eyePosition } from '../density/CloudField'
import type { CloudsNode } from '../march/CloudsNode'
import { nightGain } from '../light/NightLight'
import {
  QualityUniforms,
  resolveQuality,
  type CloudQuality,
  type CloudQualityName
} from '../march/quality'
import { withAirBefore } from '../march/tsl/airBefore'
import { marchClouds } from '../march/tsl/march'
import { interleavedNoise } from '../temporal/tsl/noisePattern'
import { groundDistance } from '../march/tsl/shells'
import type { LevelTexture, Mat3, Mat4, Vec2, Vec3 } from '../tsl-types'
import { matrix3, matrix4, number, vector3 } from '../uniforms'

/** Options of {@link cloudOverlay}. */
export interface CloudOverlayOptions {
  /** Pixels along an edge of the square picture of all directions, in [16, 2048]. */
  size?: number
  /** How finely clouds are marched; by default `'low'`. */
  quality?: CloudQualityName | CloudQuality
  /** How far the wind may carry clouds before they are drawn again, > 0 [m]. */
  drift?: number
}

/** Frames after which the clouds' shadow maps are those of the clouds as they are. */
const WAIT = 12

/** Strips of the picture. */
const STRIPS = 6

/** Light of the default luminance scale, which half floats hold well by day. */
const STORED_SCALE = 1e-4

const _center = new Vector3()
const _pole = new Vector3(0, 0, 1)

/** Change of the direction to the moon, or of its light's strength, that shows. */
const MOON_CHANGE = 2e-3

/** What clouds are like, by all that shows. */
interface CloudState {
  /** What has to stay as it is. */
  readonly things: readonly unknown[]
  readonly turns: readonly Quaternion[]
  /** Direction to the moon times its strength; 0 by day. */
  readonly moonlight: Vector3
}

/**
 * Clouds for a `skyEnvironment`: a picture of all directions about its place, an octahedron's net with
 * the nadir in the corners, marched as a cloud node's pictures are but drawn in six strips, one a frame,
 * when the clouds' shadow maps have followed.
 *
 * ```ts
 * const overlay = cloudOverlay(cloudsNode)
 * scene.environmentNode = skyEnvironment(atmosphere, { overlay })
 * ```
 *
 * It is drawn again with the environment, and when layers are changed or have drifted, or the moon that
 * lights them has moved. Use one per environment.
 */
export class CloudOverlay implements SkyOverlay {
  readonly steps = WAIT + STRIPS
  /** Whose clouds; shared, not owned. */
  readonly clouds: CloudsNode
  #drift = 200
  readonly #target: RenderTarget
  readonly #picture: LevelTexture<Vec2>
  readonly #quality = new QualityUniforms()
  /** Axes of the picture, east, north and the zenith at its place, to those of the mapped space. */
  readonly #axes = matrix4()
  /** Displacements in the mapped space to view space. */
  readonly #fromMapped = matrix3()
  /** Stored light per light. */
  readonly #gain = number(1)
  /** The same without the luminance scale of then. */
  #raised = STORED_SCALE
  /** From the camera of the shadow maps [m]. */
  readonly #shift = vector3()
  #field: CloudField | null = null
  #pass: FragmentPass | null = null
  #drawn: CloudState | null = null
  #version = 0

  /** @throws If the clouds are missing, or an option is out of its range. */
  constructor(clouds: CloudsNode, options: CloudOverlayOptions = {}) {
    checkClouds('CloudOverlay', clouds)
    checkOptions('CloudOverlay', options, 'size', 'quality', 'drift')
    const { size = 256, quality = 'low', drift = 200 } = options
    if (!(Number.isInteger(size) && size >= 16 && size <= 2048)) {
      fail('CloudOverlay', 'size must be an integer in [16, 2048]', size)
    }
    this.clouds = clouds
    this.drift = drift
    this.#quality.set(resolveQuality('CloudOverlay', quality))
    this.#target = tableTarget('Welkin.CloudOverlay', size, size)
    this.#target.scissorTest = true
    this.#picture = texture(this.#target.texture) as unknown as LevelTexture<Vec2>
  }

  /** How far the wind may carry clouds before they are drawn again, > 0 [m]. */
  get drift(): number {
    return this.#drift
  }

  set drift(value: number) {
    checkPositive('CloudOverlay', 'drift', value)
    this.#drift = value
  }

  /** Size on the GPU [bytes]. */
  get bytes(): number {
    return 8 * this.#target.width * this.#target.height
  }

  /** See `SkyOverlay.version`. */
  get version(): number {
    return this.#isAsDrawn() ? this.#version : this.#version + 1
  }

  #state(): CloudState {
    const { field, light, shadows } = this.clouds
    const { direction, illuminance, irradiance } = field.night
    return {
      things: [
        light.texture.version,
        field.grown === 1,
        shadows.isDrawn,
        illuminance,
        ...[...field.layers].map(({ parameters }) => parameters)
      ],
      turns: field.turns.map(turn => turn.clone()),
      moonlight: direction.value.clone().multiplyScalar(irradiance.value.y)
    }
  }

  #isAsDrawn(): boolean {
    if (this.#drawn === null) return false
    const { things, turns, moonlight } = this.#drawn
    const now = this.#state()
    const reach = this.drift / this.clouds.atmosphere.parameters.bottomRadius
    return (
      things.every((thing, i) => thing === now.things[i]) &&
      turns.every((turn, i) => turn.angleTo(now.turns[i]) <= reach) &&
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
    if (strip === 0) this.#begin(view, field)
    this.#gain.value = this.#raised / atmosphere.luminanceScale
    eyePosition(view, this.#shift.value).sub(shadows.camera)
    const { width: size } = this.#target
    const [from, to] = [strip, strip + 1].map(part => Math.round((part * size) / STRIPS))
    this.#target.scissor.set(0, from, size, to - from)
    this.#pass?.render(renderer, this.#target)
  }

  /** Takes clouds, sun and place as they are for all steps. */
  #begin(view: AtmosphereView, field: CloudField): void {
    const { turns, night, depthScale } = this.clouds.field
    if (!this.#isAsDrawn()) this.#version++
    this.#drawn = this.#state()
    turns.forEach((turn, i) => field.turns[i].copy(turn))
    field.pixelAngle.value = 2 / this.#target.width
    field.depthScale.value = depthScale.value
    field.night.illuminance = night.illuminance
    // On a clock that stands still: the turns are the other field's.
    field.update(view, 0)
    this.#raised = STORED_SCALE * nightGain(view, field.radius.value)
    this.#fromMapped.value.copy(view.viewToMapped).invert()
    // East is across pole and zenith.
    this.#axes.value.lookAt(view.up, _center, _pole)
  }

  /** Makes its field and shader, for the environment's camera. */
  #build({ camera }: AtmosphereView): CloudField {
    const { atmosphere, field: source, light, shadows } = this.clouds
    const { layers, noise, worldMapTexture: worldMap } = source
    const view = viewNodes(atmosphere, camera)
    const field = new CloudField(atmosphere, layers, view, { noise, worldMap })
    const picture = Fn(() => {
      const at = uv() as unknown as Vec2
      const local = octahedralDirection(at.mul(2).sub(1)).toConst()
      const direction = (this.#axes as unknown as Mat4).mul(vec4(local, 0)).xyz.toConst() as Vec3
      const end = groundDistance(field, direction.dot(view.up).clamp(-1, 1).toConst())
      const maps = { ...shadows.nodes, shift: this.#shift }
      const pixel = at.mul(this.#target.width).floor().toConst() as Vec2
      const jitter = interleavedNoise(pixel, float(0))
      const ray = { direction, end, jitter }
      const marched = marchClouds(
        { field, light: light.nodes, shadows: maps, quality: this.#quality },
        ray
      )
      const directionView = (this.#fromMapped as unknown as Mat3).mul(direction)
      return withAirBefore(view, marched, directionView, this.#gain)
    })
    this.#pass?.dispose()
    this.#pass = new FragmentPass('Welkin.CloudOverlay', picture())
    return (this.#field = field)
  }

  /** See `SkyOverlay.over`. */
  over(_view: ViewNodes, direction: Vec3, sky: Vec3): Vec3 {
    const { atmosphere } = this.clouds
    const scale = uniform(1).onRenderUpdate(() => atmosphere.luminanceScale / this.#raised)
    const local = transpose(this.#axes as unknown as Mat4)
      .mul(vec4(direction, 0))
      .xyz.toConst()
    const at = octahedralPoint(local).mul(0.5).add(0.5)
    const clouds = this.#picture.sample(at).level(0).toConst()
    return sky.mul(clouds.a).add(clouds.rgb.mul(scale))
  }

  /** Frees its picture. */
  dispose(): void {
    this.#target.dispose()
    this.#pass?.dispose()
    this.#field?.dispose()
    this.#pass = this.#field = this.#drawn = null
  }
}

/** Clouds for a `skyEnvironment`: see {@link CloudOverlay}. */
export const cloudOverlay = (clouds: CloudsNode, options: CloudOverlayOptions = {}): CloudOverlay =>
  new CloudOverlay(clouds, options)

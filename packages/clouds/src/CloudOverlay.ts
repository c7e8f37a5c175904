import {
  FragmentPass,
  octahedralDirection,
  octahedralPoint,
  tableTarget,
  viewNodes
} from '@welkin/atmosphere'
import type { AtmosphereView, SkyOverlay, ViewNodes } from '@welkin/atmosphere'
import { fail } from '@welkin/geo'
import type { Camera, Quaternion, RenderTarget } from 'three'
import { Fn, float, texture, uniform, uv, vec3 } from 'three/tsl'
import type { Renderer } from 'three/webgpu'
import { checkClouds } from './check'
import { CloudField, eyePosition } from './CloudField'
import type { CloudLayerParameters } from './CloudLayer'
import type { CloudsNode } from './CloudsNode'
import { nightGain } from './NightLight'
import {
  QualityUniforms,
  resolveQuality,
  type CloudQuality,
  type CloudQualityName
} from './quality'
import { withAirBefore } from './tsl/airBefore'
import { marchClouds } from './tsl/march'
import { interleavedNoise } from './tsl/noisePattern'
import { groundDistance } from './tsl/shells'
import type { LevelTexture, Mat3, Vec2, Vec3, Vec4 } from './tsl-types'
import { matrix3, number, vector3 } from './uniforms'
import { eastAt } from './wind'

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
const WAIT = 4

/** Strips of the picture. */
const STRIPS = 6

/** Light of the default luminance scale, which half floats hold well by day. */
const STORED_SCALE = 1e-4

/** What clouds were like when they were drawn. */
interface DrawnClouds {
  readonly layers: readonly CloudLayerParameters[]
  readonly turns: readonly Quaternion[]
  readonly phase: object
  /** Whether there were shadow maps. */
  readonly isMapped: boolean
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
 * It is drawn again with the environment, and when layers are changed or have drifted. Use one per
 * environment.
 */
export class CloudOverlay implements SkyOverlay {
  readonly steps = WAIT + STRIPS
  /** Whose clouds; shared, not owned. */
  readonly clouds: CloudsNode
  /** How far the wind may carry clouds before they are drawn again [m]. */
  drift: number
  readonly #target: RenderTarget
  readonly #picture: LevelTexture<Vec2>
  readonly #quality = new QualityUniforms()
  /** Level axes of the picture; the third is the zenith at its place. All in the mapped space. */
  readonly #across = vector3()
  readonly #along = vector3()
  readonly #up = vector3()
  /** Displacements in the mapped space to view space. */
  readonly #fromMapped = matrix3()
  /** Stored light per light. */
  readonly #gain = number(1)
  /** The same without the luminance scale of then. */
  #raised = STORED_SCALE
  /** From the camera of the shadow maps [m]. */
  readonly #shift = vector3()
  #camera: Camera | null = null
  #view: ViewNodes | null = null
  #field: CloudField | null = null
  #pass: FragmentPass | null = null
  #drawn: DrawnClouds | null = null
  #version = 0

  /** @throws If the clouds are missing, or an option is out of its range. */
  constructor(
    clouds: CloudsNode,
    { size = 256, quality = 'low', drift = 200 }: CloudOverlayOptions = {}
  ) {
    checkClouds('CloudOverlay', clouds)
    if (!(Number.isInteger(size) && size >= 16 && size <= 2048)) {
      fail('CloudOverlay', 'size must be an integer in [16, 2048]', size)
    }
    if (!(drift > 0)) fail('CloudOverlay', 'drift must be positive', drift)
    this.clouds = clouds
    this.drift = drift
    this.#quality.set(resolveQuality(quality))
    this.#target = tableTarget('Welkin.CloudOverlay', size, size)
    this.#target.scissorTest = true
    this.#picture = texture(this.#target.texture) as unknown as LevelTexture<Vec2>
  }

  /** Size on the GPU [bytes]. */
  get bytes(): number {
    return 8 * this.#target.width * this.#target.height
  }

  /** See `SkyOverlay.version`. */
  get version(): number {
    return this.#isAsDrawn() ? this.#version : this.#version + 1
  }

  #isAsDrawn(): boolean {
    const drawn = this.#drawn
    if (drawn === null) return false
    const { field, light, shadows } = this.clouds
    const reach = this.drift / field.atmosphere.parameters.bottomRadius
    return (
      light.phase === drawn.phase &&
      drawn.isMapped === shadows.isDrawn &&
      drawn.layers.every((parameters, i) => parameters === field.layers.at(i).parameters) &&
      drawn.turns.every((turn, i) => turn.angleTo(field.turns[i]) <= reach)
    )
  }

  /** See `SkyOverlay.draw`. */
  draw(renderer: Renderer, view: AtmosphereView, step: number): void {
    const { clouds } = this
    clouds.field.bake(renderer)
    clouds.light.bake()
    if (view.camera !== this.#camera) this.#build(view)
    const field = this.#field
    if (field === null || this.#view?.update({ camera: view.camera }) === undefined) return
    const strip = step - WAIT
    if (strip < 0) return
    if (strip === 0) this.#begin(view, field)
    const { atmosphere, shadows } = clouds
    this.#gain.value = this.#raised / atmosphere.luminanceScale
    eyePosition(view, this.#shift.value).sub(shadows.camera)
    const { width: size } = this.#target
    const [from, to] = [strip, strip + 1].map(part => Math.round((part * size) / STRIPS))
    this.#target.scissor.set(0, from, size, to - from)
    this.#pass?.render(renderer, this.#target)
  }

  /** Takes clouds, sun and place as they are for all steps. */
  #begin(view: AtmosphereView, field: CloudField): void {
    const source = this.clouds.field
    if (!this.#isAsDrawn()) this.#version++
    this.#drawn = {
      layers: [...source.layers].map(({ parameters }) => parameters),
      turns: source.turns.map(turn => turn.clone()),
      phase: this.clouds.light.phase,
      isMapped: this.clouds.shadows.isDrawn
    }
    source.turns.forEach((turn, i) => field.turns[i].copy(turn))
    field.pixelAngle.value = 2 / this.#target.width
    field.night.illuminance = source.night.illuminance
    // On a clock that stands still: the turns are the other field's.
    field.update(view, 0)
    this.#raised = STORED_SCALE * nightGain(view, field.radius.value)
    this.#fromMapped.value.copy(view.viewToMapped).invert()
    const across = eastAt(this.#up.value.copy(view.up), this.#across.value)
    this.#along.value.crossVectors(view.up, across)
  }

  /** Makes its field and shader, for the environment's camera. */
  #build(view: AtmosphereView): void {
    const { atmosphere, field, light, shadows } = this.clouds
    this.#camera = view.camera
    const nodes = (this.#view = viewNodes(atmosphere, view.camera))
    const { noise, worldMapTexture: worldMap } = field
    const seen = (this.#field = new CloudField(atmosphere, field.layers, nodes, {
      noise,
      worldMap
    }))
    this.#pass?.dispose()
    this.#pass = new FragmentPass('Welkin.CloudOverlay', this.#march(seen, nodes, light, shadows))
  }

  #march(
    field: CloudField,
    view: ViewNodes,
    light: CloudsNode['light'],
    shadows: CloudsNode['shadows']
  ): Vec4 {
    return Fn(() => {
      const at = uv() as unknown as Vec2
      const local = octahedralDirection(at.mul(2).sub(1)).toConst()
      const direction = this.#across
        .mul(local.x)
        .add(this.#along.mul(local.y))
        .add(this.#up.mul(local.z))
        .toConst() as Vec3
      const end = groundDistance(field, direction.dot(view.up).clamp(-1, 1).toConst())
      const maps = { ...shadows.nodes, shift: this.#shift }
      const pixel = at.mul(this.#target.width).floor().toConst() as Vec2
      const marched = marchClouds(field, light.nodes, maps, this.#quality, {
        direction,
        end,
        jitter: interleavedNoise(pixel, float(0))
      })
      const directionView = (this.#fromMapped as unknown as Mat3).mul(direction)
      return withAirBefore(view, marched, directionView, this.#gain)
    })()
  }

  /** See `SkyOverlay.over`. */
  over(_view: ViewNodes, direction: Vec3, sky: Vec3): Vec3 {
    const { atmosphere } = this.clouds
    const scale = uniform(1).onRenderUpdate(() => atmosphere.luminanceScale / this.#raised)
    const local = vec3(
      direction.dot(this.#across),
      direction.dot(this.#along),
      direction.dot(this.#up)
    ).toConst()
    const at = octahedralPoint(local).mul(0.5).add(0.5)
    const clouds = this.#picture.sample(at).level(0).toConst()
    return sky.mul(clouds.a).add(clouds.rgb.mul(scale))
  }

  /** Frees its picture. */
  dispose(): void {
    this.#target.dispose()
    this.#pass?.dispose()
    this.#field?.dispose()
    this.#pass = this.#camera = this.#field = this.#drawn = null
  }
}

/** Clouds for a `skyEnvironment`: see {@link CloudOverlay}. */
export const cloudOverlay = (clouds: CloudsNode, options: CloudOverlayOptions = {}): CloudOverlay =>
  new CloudOverlay(clouds, options)

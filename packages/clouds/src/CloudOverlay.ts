import {
  aerialPerspectiveTo,
  FragmentPass,
  linearSRGB,
  octahedralDirection,
  octahedralPoint,
  viewNodes
} from '@welkin/atmosphere'
import type { AtmosphereView, SkyOverlay, ViewNodes } from '@welkin/atmosphere'
import { HalfFloatType, LinearFilter, Matrix3, RenderTarget, Vector3 } from 'three'
import type { Camera, Quaternion } from 'three'
import { Fn, If, float, renderGroup, texture, uniform, uv, vec3, vec4 } from 'three/tsl'
import type { Renderer } from 'three/webgpu'
import { CloudField } from './CloudField'
import type { CloudLayerParameters } from './CloudLayer'
import type { CloudsNode } from './CloudsNode'
import { nightGain } from './FrameUniforms'
import {
  QualityUniforms,
  resolveQuality,
  type CloudQuality,
  type CloudQualityName
} from './quality'
import { marchClouds } from './tsl/march'
import { interleavedNoise } from './tsl/noisePattern'
import { groundDistance } from './tsl/shells'
import type { LevelTexture, Mat3, Vec2, Vec3, Vec4 } from './tsl-types'

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

const vector = () => uniform(new Vector3()).setGroup(renderGroup)

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
  readonly #across = vector()
  readonly #along = vector()
  readonly #up = vector()
  /** Displacements in the mapped space to view space. */
  readonly #fromMapped = uniform(new Matrix3()).setGroup(renderGroup)
  /** Stored light per light. */
  readonly #gain = uniform(1).setGroup(renderGroup)
  /** The same without the luminance scale of then. */
  #raised = STORED_SCALE
  /** From the camera of the shadow maps [m]. */
  readonly #shift = vector()
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
    if (clouds?.shadows === undefined) {
      throw new Error(`CloudOverlay: clouds must be a CloudsNode, got ${typeof clouds}`)
    }
    if (!(Number.isInteger(size) && size >= 16 && size <= 2048)) {
      throw new Error(`CloudOverlay: size must be an integer in [16, 2048], got ${size}`)
    }
    if (!(drift > 0)) throw new Error(`CloudOverlay: drift must be positive, got ${drift}`)
    this.clouds = clouds
    this.drift = drift
    this.#quality.set(resolveQuality(quality))
    this.#target = new RenderTarget(size, size, {
      type: HalfFloatType,
      depthBuffer: false,
      minFilter: LinearFilter,
      magFilter: LinearFilter
    })
    this.#target.texture.name = 'Welkin.CloudOverlay'
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
    this.#shift.value
      .copy(view.up)
      .multiplyScalar(field.radius.value + view.height)
      .sub(shadows.camera)
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
    const [up, across] = [this.#up.value.copy(view.up), this.#across.value]
    across.set(-up.y, up.x, 0)
    if (across.lengthSq() < 1e-12) across.set(0, 1, 0)
    this.#along.value.crossVectors(up, across.normalize())
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
      const opacity = marched.transmittance.oneMinus().toConst()
      const result = vec4(0, 0, 0, 1).toVar()
      If(opacity.greaterThan(0), () => {
        const offset = direction.mul(marched.distance)
        const toView = this.#fromMapped as unknown as Mat3
        const air = aerialPerspectiveTo(view, toView.mul(offset).toConst())
        const seen = linearSRGB(view.air.uniforms, marched.radiance).mul(air.transmittance)
        const lit = seen.add(air.inScatter.mul(opacity)).mul(this.#gain)
        result.assign(vec4(lit, marched.transmittance))
      })
      return result
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

import { LightProbe } from 'three'
import { Fn, normalView, vec4 } from 'three/tsl'
import { AnalyticLightNode, NodeUpdateType } from 'three/webgpu'
import type { NodeBuilder, NodeFrame } from 'three/webgpu'
import { checkNonNegative } from '@welkin/geo'
import type { Atmosphere } from '../Atmosphere'
import { NIGHT_ILLUMINANCE } from './cpu/twilight'
import { scaleToLuminance } from '../parameters/photometry'
import { linearSRGB } from '../air/tsl/color'
import type { SkyLitPlane } from '../lights/SkyLightProbe'
import type { Vec3, Vec4 } from '../tsl-types'
import { coveredPosition } from '../view/tsl/coveredPosition'
import type { ViewNodes } from '../view/ViewNodes'
import { checkAtmosphere, viewNodes } from '../view/ViewNodes'
import { watchScene } from '../view/renderers'
import { vector4 } from '../uniforms'

/**
 * Light of the night sky on surfaces, so that nights without a moon are dark but not black.
 *
 * The sky is an even dome, and the ground reflects it from below. By day the light stays on, a hundred
 * million times weaker than daylight. `cloudSkyLight` of `@welkin/clouds` dims it under clouds. `color` and `intensity` multiply the physical illuminance; the
 * probe's `sh` is not used.
 */
export class NightLightProbe extends LightProbe {
  /** Shared, not owned. */
  readonly atmosphere: Atmosphere
  #illuminance = NIGHT_ILLUMINANCE

  /**
   * Irradiance under clouds, given that of a plane without them, for a sky that gives level ground unit
   * irradiance: see `SkyLightProbe`. Set it before the first render.
   */
  overcast: ((plane: SkyLitPlane, clear: Vec4) => Vec4) | null = null

  /**
   * @param illuminance - Illuminance of level ground, finite, ≥ 0 [lx].
   * @throws If an argument is of the wrong kind or out of range.
   */
  constructor(atmosphere: Atmosphere, illuminance = NIGHT_ILLUMINANCE) {
    super()
    checkAtmosphere('NightLightProbe', atmosphere)
    this.atmosphere = atmosphere
    this.illuminance = illuminance
  }

  /** Illuminance of level ground, finite, ≥ 0 [lx]. */
  get illuminance(): number {
    return this.#illuminance
  }

  set illuminance(value: number) {
    checkNonNegative('NightLightProbe', 'illuminance', value)
    this.#illuminance = value
  }

  override updateMatrixWorld(force?: boolean): void {
    watchScene('NightLightProbe', this)
    super.updateMatrixWorld(force)
  }

  override clone(): this {
    return new NightLightProbe(this.atmosphere, this.illuminance).copy(this) as this
  }
}

/** Per-fragment irradiance of a {@link NightLightProbe}. */
export class NightLightProbeNode extends AnalyticLightNode<NightLightProbe> {
  static get type(): string {
    return 'NightLightProbeNode'
  }

  readonly #view: ViewNodes
  readonly #light: NightLightProbe
  readonly #irradiance = vector4()

  constructor(light: NightLightProbe) {
    super(light)
    this.#light = light
    this.#view = viewNodes(light.atmosphere)
    this.updateBeforeType = NodeUpdateType.RENDER
    this.updateType = NodeUpdateType.RENDER
  }

  override updateBefore(frame: NodeFrame): undefined {
    this.#view.prepare(frame)
  }

  override update(frame: NodeFrame): undefined {
    super.update(frame)
    this.#view.update(frame)
    const { atmosphere, illuminance } = this.#light
    const { parameters } = atmosphere
    // The spectrum of sunlight: a neutral light.
    const values = scaleToLuminance(parameters, [1, 1, 1, 1], illuminance)
    this.#irradiance.value.fromArray(values)
  }

  override setup(builder: NodeBuilder): undefined {
    const irradiance = Fn(() => {
      const view = this.#view
      const { uniforms } = view.air
      const offset = view.toMapped(coveredPosition()).toConst()
      const { altitude, cosLight, up } = view.localCoordinates(offset)
      const cosNormal = view.toMapped(normalView).normalize().dot(up).clamp(-1, 1).toConst()
      const above = cosNormal.add(1).mul(0.5)
      const below = uniforms.groundAlbedo.mul(cosNormal.oneMinus().mul(0.5))
      const clear = vec4(below.add(above))
      const plane = { view, offset, altitude, up, cosLight, cosNormal, isNight: true }
      const received = this.#light.overcast?.(plane, clear) ?? clear
      return linearSRGB(uniforms, received.mul(this.#irradiance)).mul(
        (this as unknown as { colorNode: Vec3 }).colorNode
      )
    })()
    const { irradiance: sum } = builder.context as {
      irradiance: { addAssign(node: unknown): void }
    }
    sum.addAssign(irradiance)
  }
}

// In the same file: `sideEffects: false` would drop a separate one.
NightLightProbe.registerNode(NightLightProbeNode)

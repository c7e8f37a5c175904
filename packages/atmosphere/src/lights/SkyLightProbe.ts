import { LightProbe } from 'three'
import { Fn, normalView } from 'three/tsl'
import { AnalyticLightNode, NodeUpdateType } from 'three/webgpu'
import type { NodeBuilder, NodeFrame } from 'three/webgpu'
import type { Atmosphere } from '../Atmosphere'
import { checkSource, type LightSource } from '../view/LightSource'
import { linearSRGB } from '../air/tsl/color'
import { coveredPosition } from '../view/tsl/coveredPosition'
import { skyIrradiance } from '../diffuseLight/tsl/skyIrradiance'
import type { Float, Vec3, Vec4 } from '../tsl-types'
import type { ViewNodes } from '../view/ViewNodes'
import { checkAtmosphere, viewNodes } from '../view/ViewNodes'
import { watchScene } from '../view/renderers'

/** A small plane in the light of sky and ground, as shader nodes. */
export interface SkyLitPlane {
  /** Camera's view in the light of the probe's source. */
  readonly view: ViewNodes
  /** Position from the camera, in the mapped space [m]. */
  readonly offset: Vec3
  /** Altitude above the ground [m]. */
  readonly altitude: Float
  /** Zenith there. */
  readonly up: Vec3
  /** μ_s. */
  readonly cosLight: Float
  /** Its normal against the zenith. */
  readonly cosNormal: Float
  /** True in the light of the night sky, an even dome over ground that reflects it; left out, false. */
  readonly isNight?: boolean
}

/**
 * Light of sky and ground: a light probe whose irradiance is looked up per fragment, at the
 * fragment's own place and altitude, day and night side of the globe alike.
 *
 * `intensity` multiplies the physical illuminance; the probe's `sh` is not used.
 */
export class SkyLightProbe extends LightProbe {
  /** Shared, not owned. */
  readonly atmosphere: Atmosphere

  /** Source of the light that sky and ground scatter; by default the sun. */
  readonly source: LightSource

  /**
   * Irradiance under clouds, given that of a plane under a clear sky and its ground, for unit
   * irradiance of the source. Set it before the first render.
   */
  overcast: ((plane: SkyLitPlane, clear: Vec4) => Vec4) | null = null

  /**
   * @param source - Source of the light that sky and ground scatter; by default the sun.
   * @throws If an argument is of the wrong kind.
   */
  constructor(atmosphere: Atmosphere, source: LightSource = atmosphere?.sun) {
    super()
    checkAtmosphere('SkyLightProbe', atmosphere)
    checkSource('SkyLightProbe', 'source', source)
    this.atmosphere = atmosphere
    this.source = source
  }

  override updateMatrixWorld(force?: boolean): void {
    watchScene('SkyLightProbe', this)
    super.updateMatrixWorld(force)
  }

  override clone(): this {
    return new SkyLightProbe(this.atmosphere, this.source).copy(this) as this
  }
}

/** Per-fragment irradiance of a {@link SkyLightProbe}. */
export class SkyLightProbeNode extends AnalyticLightNode<SkyLightProbe> {
  static get type(): string {
    return 'SkyLightProbeNode'
  }

  readonly #view: ViewNodes
  readonly #light: SkyLightProbe

  constructor(light: SkyLightProbe) {
    super(light)
    this.#light = light
    this.#view = viewNodes(light.atmosphere, null, light.source)
    this.updateBeforeType = NodeUpdateType.RENDER
    this.updateType = NodeUpdateType.RENDER
  }

  override updateBefore(frame: NodeFrame): undefined {
    this.#view.prepare(frame)
  }

  override update(frame: NodeFrame): undefined {
    super.update(frame)
    this.#view.update(frame)
  }

  override setup(builder: NodeBuilder): undefined {
    const irradiance = Fn(() => {
      const view = this.#view
      const { air } = view
      const offset = view.toMapped(coveredPosition()).toConst()
      const place = view.localCoordinates(offset)
      const { altitude, cosLight, up } = place
      const normal = view.toMapped(normalView).normalize().toConst()
      const cosNormal = normal.dot(up)
      const clear = skyIrradiance(
        air.uniforms,
        air.diffuse!,
        altitude,
        cosNormal,
        cosLight,
        normal.dot(view.lightDirection)
      )
      const plane = { view, offset, ...place, cosNormal }
      const received = this.#light.overcast?.(plane, clear) ?? clear
      return linearSRGB(air.uniforms, received.mul(view.source.irradiance)).mul(
        (this as unknown as { colorNode: Vec3 }).colorNode
      )
    })()
    const context = builder.context as { irradiance: { addAssign(node: unknown): void } }
    context.irradiance.addAssign(irradiance)
  }
}

// In the same file: `sideEffects: false` would drop a separate one.
SkyLightProbe.registerNode(SkyLightProbeNode)

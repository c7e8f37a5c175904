import { LightProbe } from 'three'
import { Fn, normalView } from 'three/tsl'
import { AnalyticLightNode, NodeUpdateType } from 'three/webgpu'
import type { NodeBuilder, NodeFrame } from 'three/webgpu'
import type { Atmosphere } from './Atmosphere'
import { checkSource } from './check'
import type { LightSource } from './LightSource'
import { linearSRGB } from './tsl/color'
import { coveredPosition } from './tsl/coveredPosition'
import { skyIrradiance } from './tsl/skyIrradiance'
import type { Vec3 } from './tsl-types'
import type { ViewNodes } from './ViewNodes'
import { checkAtmosphere, viewNodes } from './ViewNodes'

/**
 * Light of sky and ground: a light probe whose irradiance is looked up per fragment, at the
 * fragment's own place and altitude, day and night side of the globe alike.
 *
 * `intensity` multiplies the physical illuminance; the probe's `sh` is not used.
 */
export class SkyLightProbe extends LightProbe {
  /** Shared, not owned. */
  readonly atmosphere: Atmosphere

  /** Whose light sky and ground scatter: the sun's. */
  readonly source: LightSource

  /**
   * @param source - Whose light sky and ground scatter; by default the sun's.
   * @throws If an argument is of the wrong kind.
   */
  constructor(atmosphere: Atmosphere, source: LightSource = atmosphere?.sun) {
    super()
    checkAtmosphere('SkyLightProbe', atmosphere)
    checkSource('SkyLightProbe', 'source', source)
    this.atmosphere = atmosphere
    this.source = source
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

  constructor(light: SkyLightProbe) {
    super(light)
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
      const { air } = this.#view
      const offset = this.#view.toMapped(coveredPosition()).toConst()
      const { altitude, cosSun, up } = this.#view.place(offset)
      const normal = this.#view.toMapped(normalView).normalize().toConst()
      const received = skyIrradiance(
        air.uniforms,
        air.diffuse!,
        altitude,
        normal.dot(up),
        cosSun,
        normal.dot(this.#view.sunDirection)
      )
      return linearSRGB(air.uniforms, received.mul(this.#view.source.irradiance)).mul(
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
SkyLightProbe.registerNode(SkyLightProbeNode)

import {
  AtmosphereNode,
  coveredPosition,
  horizontalIrradiance,
  linearSRGB,
  skyColor,
  type Atmosphere
} from '@welkin/atmosphere'
import { Fn, If, mix, reflect, smoothstep, vec3 } from 'three/tsl'
import type { Node, NodeBuilder } from 'three/webgpu'
import type { Float, Variable, Vec3 } from '../tsl-types'
import { waterFresnel } from './tsl/seaSurface'

/** Distances between which the mirrored sky goes over from the viewer's to an even one over the water [m]. */
const NEAR = 3e3
const FAR = 3e4

/** Sine of the lowest elevation that is mirrored: waves hide what is lower from each other. */
const LOWEST = 0.02

/** Lean of the waves towards a low viewer, who sees only their near sides, in standard deviations of their slope [–]. */
const LEAN = 0.6

/** Water that mirrors. */
export interface MirroringWater {
  /** Share of the pixel that is water. */
  readonly cover: Float
  /** Its normal with waves, in view space. */
  readonly normal: Vec3
  /** Variance of the slopes that the normal does not have. */
  readonly variance: Float
}

/**
 * Sky that water mirrors, without the sun, which is a light. Near by it is the viewer's sky in the mirrored direction, far away the even
 * light of the sky on level ground. It is black where the scene has an environment: that is mirrored then.
 */
export class WaterMirrorNode extends AtmosphereNode {
  static get type(): string {
    return 'WaterMirrorNode'
  }

  constructor(
    atmosphere: Atmosphere,
    readonly water: MirroringWater
  ) {
    super(atmosphere)
  }

  override setup(builder: NodeBuilder): Node {
    const { environmentNode, material } = builder as unknown as {
      environmentNode: Node | null
      material: { envNode: Node | null }
    }
    if (environmentNode || material.envNode) return vec3(0)
    return Fn(() => {
      const { cover, normal, variance } = this.water
      const radiance = vec3(0).toVar() as unknown as Variable<Vec3>
      If(cover.greaterThan(0), () => {
        radiance.assign(this.#mirrored(normal, variance).mul(cover))
      })
      return radiance
    })()
  }

  #mirrored(normalView: Vec3, variance: Float): Vec3 {
    const { view } = this
    const { uniforms, diffuse } = view.air
    const offset = view.toMapped(coveredPosition()).toConst() as Vec3
    const distance = offset.length().toConst()
    const incoming = offset.div(distance).toConst() as Vec3
    const { altitude, cosLight, up } = view.localCoordinates(offset)
    const normal = view.toMapped(normalView).normalize().toConst() as Vec3
    const cosViewer = normal.dot(incoming).negate().max(0).toConst() as Float
    const lean = variance.sqrt().mul(cosViewer.oneMinus()).mul(LEAN)
    const facet = normal.sub(incoming.mul(lean)).normalize().toConst() as Vec3
    const leaving = (reflect(incoming, facet) as unknown as Vec3).toConst()
    const raised = leaving.add(up.mul(leaving.dot(up).negate().add(LOWEST).max(0)))
    const even = smoothstep(NEAR, FAR, distance).toConst() as Float
    const sky = vec3(0).toVar() as unknown as Variable<Vec3>
    If(even.lessThan(1), () => {
      sky.assign(skyColor(view, raised.normalize().toConst(), null, []))
    })
    If(even.greaterThan(0), () => {
      const level = horizontalIrradiance(uniforms, diffuse!, altitude, cosLight).up
      const light = level.mul(view.source.irradiance).div(Math.PI)
      sky.assign(mix(sky, linearSRGB(uniforms, light), even))
    })
    return sky.mul(waterFresnel(cosViewer, variance))
  }
}

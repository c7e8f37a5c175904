import { DirectionalLight, Vector3 } from 'three'
import { Fn } from 'three/tsl'
import { DirectionalLightNode, NodeUpdateType } from 'three/webgpu'
import type { NodeBuilder, NodeFrame } from 'three/webgpu'
import { checkPositive } from '@welkin/geo'
import type { Atmosphere } from '../Atmosphere'
import { checkSource, type LightSource } from '../view/LightSource'
import { linearSRGB } from '../air/tsl/color'
import { lightAtFragment } from '../sky/tsl/lightAtFragment'
import { lightTransmittance } from '../transmittance/tsl/transmittance'
import type { Vec3 } from '../tsl-types'
import type { ViewNodes } from '../view/ViewNodes'
import { checkAtmosphere, viewNodes } from '../view/ViewNodes'
import { watchScene } from '../view/renderers'

const _direction = new Vector3()

/**
 * Sunlight: a directional light that comes from the atmosphere's sun, reddened by the air above each
 * fragment and blocked by the planet, so that one light is right on the whole globe.
 *
 * `color` and `intensity` multiply the physical illuminance. Shadows, cascades included, are three's:
 * set `castShadow`, the shadow camera and `target`, around which the light is placed at
 * {@link distance}.
 */
export class SunDirectionalLight extends DirectionalLight {
  /** Shared, not owned. */
  readonly atmosphere: Atmosphere
  #distance = 1

  /** Source of the light; by default the sun. */
  readonly source: LightSource

  /**
   * @param distance - Distance from the target to the light [world units].
   * @param source - Source of the light; by default the sun.
   */
  constructor(atmosphere: Atmosphere, distance = 1, source: LightSource = atmosphere?.sun) {
    super()
    checkAtmosphere('SunDirectionalLight', atmosphere)
    checkSource('SunDirectionalLight', 'source', source)
    this.atmosphere = atmosphere
    this.source = source
    this.distance = distance
    this.update()
  }

  /** Distance from the target to the light, along the sun's direction, > 0 [world units]. */
  get distance(): number {
    return this.#distance
  }

  set distance(value: number) {
    checkPositive('SunDirectionalLight', 'distance', value)
    this.#distance = value
  }

  override clone(): this {
    return new SunDirectionalLight(this.atmosphere, this.distance, this.source).copy(this) as this
  }

  /** Moves to where the sun is; rendering does this by itself. */
  update(): void {
    this.target.updateWorldMatrix(true, false)
    this.position.setFromMatrixPosition(this.target.matrixWorld)
    this.source.direction(_direction, this.position)
    this.position.addScaledVector(_direction, this.distance)
    this.parent?.worldToLocal(this.position)
  }

  override updateMatrixWorld(force?: boolean): void {
    this.update()
    watchScene('SunDirectionalLight', this)
    super.updateMatrixWorld(force)
  }
}

/** Per-fragment colour of a {@link SunDirectionalLight}. */
export class SunDirectionalLightNode extends DirectionalLightNode {
  static get type(): string {
    return 'SunDirectionalLightNode'
  }

  readonly #view: ViewNodes

  constructor(light: SunDirectionalLight) {
    super(light)
    this.#view = viewNodes(light.atmosphere, null, light.source)
    this.updateBeforeType = NodeUpdateType.RENDER
    this.updateType = NodeUpdateType.RENDER
    const node = this as unknown as { colorNode: Vec3 }
    const tint = node.colorNode
    node.colorNode = Fn(({ material }: NodeBuilder) => {
      const view = this.#view
      const { uniforms, transmittance } = view.air
      return lightAtFragment(material, view, 1, position => {
        const { altitude, cosLight } = view.localCoordinates(view.toMapped(position))
        const sunlight = lightTransmittance(uniforms, transmittance, altitude, cosLight)
        return [linearSRGB(uniforms, sunlight.mul(view.source.irradiance)).mul(tint)]
      })[0]
    })()
  }

  override updateBefore(frame: NodeFrame): undefined {
    this.#view.prepare(frame)
  }

  override update(frame: NodeFrame): undefined {
    super.update(frame)
    this.#view.update(frame)
  }
}

// In the same file: `sideEffects: false` would drop a separate one.
SunDirectionalLight.registerNode(SunDirectionalLightNode as never)

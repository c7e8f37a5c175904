import { Color, PointLight, SpotLight, Vector3 } from 'three'
import type { Camera, Light } from 'three'
import { smoothstep } from 'three/tsl'
import type { Float, Vec3 } from '../tsl-types'
import { vector4 } from '../uniforms'

/** A lamp that particles are lit by. */
export type Lamp = PointLight | SpotLight

export const isLamp = (light: Light): light is Lamp =>
  light instanceof PointLight || light instanceof SpotLight

const _position = new Vector3()
const _target = new Vector3()
const _color = new Color()

/** A point light or a spot light as three has them, for shaders; its shadow map is not sampled. */
export class LampUniforms {
  /** Position in view space [world units], and exponent of the decay. */
  readonly #place = vector4()
  /** Intensity, and distance at which it ends, 0 for none [world units]. */
  readonly #light = vector4()
  /** Direction from its target, in view space, and cosine of the cone's edge; −2 for a point light. */
  readonly #cone = vector4()
  /** Cosine at which the edge's falloff begins. */
  readonly #inside = vector4()

  constructor(readonly lamp: Lamp) {}

  /** Sets the lamp's values as a camera sees them. */
  update(camera: Camera): void {
    const { lamp } = this
    _color.copy(lamp.color).multiplyScalar(isShown(lamp) ? lamp.intensity : 0)
    this.#light.value.set(_color.r, _color.g, _color.b, lamp.distance)
    _position.setFromMatrixPosition(lamp.matrixWorld).applyMatrix4(camera.matrixWorldInverse)
    this.#place.value.set(_position.x, _position.y, _position.z, lamp.decay)
    this.#cone.value.set(0, 0, 0, -2)
    this.#inside.value.x = -1.5
    if (!(lamp instanceof SpotLight)) return
    _target.setFromMatrixPosition(lamp.target.matrixWorld).applyMatrix4(camera.matrixWorldInverse)
    const axis = _position.sub(_target).normalize()
    this.#cone.value.set(axis.x, axis.y, axis.z, Math.cos(lamp.angle))
    this.#inside.value.x = Math.cos(lamp.angle * (1 - lamp.penumbra))
  }

  /**
   * Illuminance of a place, in the unit of three's lights.
   *
   * @param place - In view space [world units].
   * @returns Illuminance, and direction to the lamp.
   */
  at(place: Vec3): { illuminance: Vec3; direction: Vec3 } {
    const way = this.#place.xyz.sub(place).toConst() as Vec3
    const distance = way.length().max(1e-3).toConst() as Float
    const direction = way.div(distance).toConst() as Vec3
    const { w: end } = this.#light
    const share = end.greaterThan(0).select(distance.div(end), 0).toConst() as Float
    const window = share.pow4().oneMinus().clamp().toConst() as Float
    const decay = distance.pow(this.#place.w).max(0.01).reciprocal().mul(window.mul(window))
    const { x: inside } = this.#inside
    const edge = this.#cone.w.min(inside.sub(1e-4))
    const cone = smoothstep(edge, inside, direction.dot(this.#cone.xyz))
    return { illuminance: this.#light.xyz.mul(decay).mul(cone), direction }
  }
}

/** False if it, or something that holds it, is not visible. */
function isShown(light: Light): boolean {
  for (let at: Light['parent'] = light; at !== null; at = at.parent) if (!at.visible) return false
  return true
}

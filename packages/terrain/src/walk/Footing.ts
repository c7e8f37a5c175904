import { Vector3 } from 'three'
import type { HeightSample } from '../heights/HeightSource'
import { sampleGround } from '../heights/sampleGround'
import { waterLevel, type Ground } from '../rays/Ground'
import { figureOf } from '../tiles/cpu/figure'

/** Distance about the feet over which the slope is taken: stones do not stop them [m]. */
const REACH = 0.3

const sample: HeightSample = { height: 0, gradient: new Vector3() }
const first = new Vector3()
const second = new Vector3()
const place = new Vector3()

/** Ground under a pair of feet, and the water over it. */
export class Footing {
  /** Point of the ellipsoid below, ECEF [m]. */
  readonly subpoint = new Vector3()
  /** Geodetic up. */
  readonly up = new Vector3()
  /** Slope over 0.6 m, level, ECEF axes [–]. */
  readonly gradient = new Vector3()
  /** Height of the ground above the ellipsoid [m]. */
  floor = 0
  /** Surface of the sea or a lake there; −Infinity for none [m]. */
  water = 0
  readonly #ground: Ground

  constructor(ground: Ground) {
    this.#ground = ground
  }

  /** Tangent of the slope. */
  get slope(): number {
    return this.gradient.length()
  }

  /** @param positionECEF - At any height [m]. */
  at(positionECEF: Vector3): this {
    const figure = figureOf(this.#ground.atmosphere)
    const { up, subpoint, gradient } = this
    figure.footPoint(positionECEF, subpoint)
    figure.surfaceNormal(subpoint, up)
    this.floor = this.#heightAt(subpoint)
    this.water = waterLevel(this.#ground, subpoint)
    first
      .set(Math.abs(up.z) < 0.9 ? 0 : 1, 0, Math.abs(up.z) < 0.9 ? 1 : 0)
      .cross(up)
      .normalize()
    second.crossVectors(up, first)
    gradient.setScalar(0)
    for (const axis of [first, second]) {
      const ahead = this.#heightAt(place.copy(subpoint).addScaledVector(axis, REACH))
      const behind = this.#heightAt(place.copy(subpoint).addScaledVector(axis, -REACH))
      gradient.addScaledVector(axis, (ahead - behind) / (2 * REACH))
    }
    return this
  }

  copy({ subpoint, up, gradient, floor, water }: Footing): this {
    this.subpoint.copy(subpoint)
    this.up.copy(up)
    this.gradient.copy(gradient)
    this.floor = floor
    this.water = water
    return this
  }

  #heightAt(position: Vector3): number {
    return sampleGround(this.#ground.source, position, sample).height
  }
}

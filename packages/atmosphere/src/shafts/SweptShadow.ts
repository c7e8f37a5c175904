import { Matrix4, type Camera, type Vector3 } from 'three'
import { texture } from 'three/tsl'
import type { Renderer } from 'three/webgpu'
import { sampleLevel0, type Float, type Vec3 } from '../tsl-types'
import { number } from '../uniforms'
import type { ParallelLight } from './shadowMaps'
import type { SweptHeights } from './SweptHeights'
import { isInField } from './tsl/isInField'

/** Error of heights in half floats, over their size, after some sweeps. Less: high ground shades itself in bands. */
const HALF_STEP = 2 ** -10

/** Hills that cast shadows, of which each camera may see a field of its own. */
export interface SweptHills {
  readonly matrix: Matrix4
  fieldOf(camera: Camera, frame?: number): SweptHills
  acquire(light: ParallelLight): SweptHeights
  release(light: ParallelLight): void
}

/** Shadow of hills in one light as a shader reads it: by the map of the field that the camera sees. */
export class SweptShadow {
  readonly #hills: SweptHills
  readonly #light: ParallelLight
  readonly #maps = new Map<SweptHills, SweptHeights>()
  readonly #map
  /** See `SweptHeights`. */
  readonly #blur = number(1)
  readonly #toField = new Matrix4()

  constructor(hills: SweptHills, light: ParallelLight) {
    this.#hills = hills
    this.#light = light
    this.#map = texture(this.#mapOf(hills).texture)
  }

  #mapOf(field: SweptHills): SweptHeights {
    let map = this.#maps.get(field)
    if (map === undefined) this.#maps.set(field, (map = field.acquire(this.#light)))
    return map
  }

  /**
   * Draws the map of a camera's field, if light or heights have changed.
   *
   * @param toLight - Direction to the light, in world space.
   * @returns World space to places and heights of the field.
   */
  update(renderer: Renderer, camera: Camera, toLight: Vector3): Matrix4 {
    const field = this.#hills.fieldOf(camera, renderer.info.frame)
    const map = this.#mapOf(field)
    const toField = this.#toField.copy(field.matrix).invert()
    map.update(renderer, toLight, toField)
    this.#map.value = map.texture
    this.#blur.value = map.blur
    return toField
  }

  /**
   * Part of the light that arrives at a place, in [0, 1].
   *
   * @param place - Place in the field, and height [m].
   * @param isSurface - True on the ground, which between texels of the field is lower than it at some places, and higher at others:
   *   it is as lit as the field there, raised by the height over which shadows end.
   */
  transmittance(place: Vec3, isSurface = false): Float {
    const { r: dark, g: ground } = sampleLevel0(this.#map, place.xy).toConst()
    const height = isSurface ? place.z.max(ground) : place.z
    const lit = height
      .sub(dark)
      .div(dark.abs().mul(HALF_STEP).add(this.#blur))
      .add(isSurface ? 2 : 1)
      .clamp()
    return isInField(place.xy).lessThan(0.5).select(1, lit).toConst()
  }

  /** Gives the maps back. */
  dispose(): void {
    for (const field of this.#maps.keys()) field.release(this.#light)
    this.#maps.clear()
  }
}

import { FragmentPass, tableTarget } from '@welkin/atmosphere'
import type { Vector3 } from 'three'
import { Fn, If, float, texture, uv, vec2, vec4 } from 'three/tsl'
import type { Renderer } from 'three/webgpu'
import type { Float, Int, LevelTexture, Vec2, Vec3, Vec4 } from '../tsl-types'
import { vector3 } from '../uniforms'
import type { CloudField } from './CloudField'
import { layerAt, type LayerNodes } from './tsl/layer'
import { weatherBackground, type PackedBackground } from './tsl/weatherBackground'

/** Texels along an edge of a layer's map. */
const SIZE = 256

/**
 * Greatest distance over the ground from the camera that the map has [m], and that within which its texels are about
 * as wide: 100 m below the camera, 1.1 km at its rim. Wider: clouds shift as one flies towards them (*Cockpit*).
 */
const MAXIMUM_DISTANCE = 30_000
const EVEN = 12_000

/** Position of that distance in the map, from its middle: ρ / (ρ + EVEN). */
const RIM = MAXIMUM_DISTANCE / (MAXIMUM_DISTANCE + EVEN)

/** Texels at each edge that bilinear look-ups must not leave. */
const MARGIN = 0.5

/** Texture coordinates of a layer's tile per unit of position, from its middle. */
const PER_POSITION = (SIZE - 2 * MARGIN) / (2 * RIM * SIZE)

/**
 * Weather's background of all layers around a camera's subpoint, drawn anew for each frame: rays that look it up
 * there take one texture read in place of two that wait for each other.
 *
 * Each layer has a tile, one above the other. Positions are displacements in the plane that touches the sphere at
 * the subpoint, at ρ / (ρ + EVEN) for a distance ρ from it.
 */
export class WeatherMap {
  readonly #field: CloudField
  readonly #target
  readonly #pass: FragmentPass
  readonly #map: LevelTexture<Vec2>
  /** Two directions along the ground at the subpoint, in the mapped space. */
  readonly #axes: readonly [ReturnType<typeof vector3>, ReturnType<typeof vector3>] = [
    vector3(),
    vector3()
  ]

  constructor(field: CloudField) {
    this.#field = field
    const { length } = field.layers
    this.#target = tableTarget('Welkin.CloudsWeather', SIZE, SIZE * length)
    this.#map = texture(this.#target.texture) as unknown as LevelTexture<Vec2>
    this.#pass = new FragmentPass('Welkin.CloudsWeather', this.#draw())
  }

  #draw(): Vec4 {
    const field = this.#field
    const { view, radius } = field
    const [x, y] = this.#axes
    return Fn(() => {
      const at = (uv() as unknown as Vec2).mul(vec2(1, field.layers.length)).toConst() as Vec2
      const layer = layerAt(field, at.y.floor().toInt().toConst())
      const position = vec2(at.x, at.y.fract()).sub(0.5).div(PER_POSITION).toConst() as Vec2
      const far = position.length().min(0.98).toConst() as Float
      const flat = position.mul(float(EVEN).div(far.oneMinus())).toConst() as Vec2
      const square = flat.dot(flat).toConst() as Float
      // What the sphere falls short of the plane.
      const drop = square.div(radius.add(radius.mul(radius).sub(square).sqrt()))
      const subpoint = x.mul(flat.x).add(y.mul(flat.y)).sub(view.up.mul(drop)).toConst() as Vec3
      const up = subpoint.div(radius).add(view.up).normalize().toConst() as Vec3
      const rise = layer.baseAltitude.sub(view.height)
      const footprint = square.add(rise.mul(rise)).sqrt().mul(field.pixelAngle).toConst() as Float
      return weatherBackground(field, layer, subpoint, { up }, footprint)
    })()
  }

  /** Draws the map; `CloudField.update` goes first. */
  render(renderer: Renderer, up: Vector3): void {
    const [x, y] = this.#axes
    const isPolar = Math.abs(up.z) >= 0.9
    x.value.set(isPolar ? 1 : 0, 0, isPolar ? 0 : 1)
    x.value.cross(up).normalize()
    y.value.copy(up).cross(x.value)
    this.#pass.render(renderer, this.#target)
  }

  /**
   * Background of a layer's weather: from the map, or by look-ups of noise farther away. To be called inside of a
   * shader function.
   *
   * @param subpoint - `subpointOffset` of the sample.
   * @param up - Zenith there.
   * @param footprint - Width of what the sample stands for [m].
   */
  sample(
    layer: LayerNodes,
    index: Int,
    subpoint: Vec3,
    up: Vec3,
    footprint: Float
  ): PackedBackground {
    const { layers } = this.#field
    const [x, y] = this.#axes
    const flat = vec2(subpoint.dot(x), subpoint.dot(y)).toConst() as Vec2
    const distance = flat.length().toConst() as Float
    const found = vec4(0).toVar() as Vec4
    If(distance.lessThan(MAXIMUM_DISTANCE), () => {
      const inTile = flat.div(distance.add(EVEN)).mul(PER_POSITION).add(0.5)
      const row = inTile.y.add(float(index)).div(layers.length)
      found.assign(this.#map.sample(vec2(inTile.x, row)).level(0))
    }).Else(() => {
      found.assign(weatherBackground(this.#field, layer, subpoint, { up }, footprint))
    })
    return found
  }

  /** Frees the map. */
  dispose(): void {
    this.#target.dispose()
    this.#pass.dispose()
  }
}

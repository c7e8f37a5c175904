import { FragmentPass, tableTarget } from '@welkin/atmosphere'
import { RGFormat, type Vector3 } from 'three'
import { Fn, If, float, texture, uv, vec2, vec4 } from 'three/tsl'
import type { Renderer } from 'three/webgpu'
import type { Float, Int, LevelTexture, Vec2, Vec3, Vec4 } from '../tsl-types'
import { vector3 } from '../uniforms'
import type { CloudField } from './CloudField'
import { layerAt, type LayerNodes } from './tsl/layer'
import { resolutionAt } from './tsl/resolution'
import { columnStrength } from './tsl/strength'
import { cloudWeather } from './tsl/weather'
import { unpackBackground, weatherBackground, type PackedBackground } from './tsl/weatherBackground'

/**
 * Map of the background: texels along an edge of a layer's tile; the greatest distance over the ground from the camera [m]; and
 * that within which texels are about as wide: 0.15 km below the camera, 1.5 km at the rim. Wider: clouds shift as one
 * flies towards them (*Cockpit*).
 */
const BACKGROUND = { size: 384, reach: 90_000, even: 40_000 } as const

/**
 * Map of columns: texels are 29 m wide below the camera, 0.2 km at the rim. Wider: small clouds are missed far away
 * (*Cumulus*).
 */
const COLUMNS = { size: 512, reach: 20_000, even: 12_000 } as const

/** Greatest distance over the ground from the camera up to which columns are known [m]. */
export const COLUMNS_DISTANCE = COLUMNS.reach

/** Strength of columns of which nothing is known [–]. */
const UNKNOWN = 1e3

/** Texels at each edge that bilinear look-ups must not leave. */
const MARGIN = 0.5

/** Form of a map. */
interface MapForm {
  /** Distance in the middle of positions [m]: that of ρ is ρ / (ρ + even). */
  readonly even: number
  /** Texture coordinates of a layer's tile per unit of position, from its middle. */
  readonly perPosition: number
}

const mapForm = ({ size, reach, even }: Record<'size' | 'reach' | 'even', number>): MapForm => ({
  even,
  perPosition: ((size - 2 * MARGIN) / (2 * size)) * ((reach + even) / reach)
})

const backgroundForm = /*#__PURE__*/ mapForm(BACKGROUND)
const columnsForm = /*#__PURE__*/ mapForm(COLUMNS)

/** Place that a texel of a layer's map stands for. */
interface MappedPlace {
  readonly index: Int
  readonly layer: LayerNodes
  /** `subpointOffset` of its samples [m]. */
  readonly subpoint: Vec3
  /** Zenith there. */
  readonly up: Vec3
  /** Width of what samples at the layer's base stand for [m]. */
  readonly footprint: Float
}

/**
 * Weather's background of all layers around a camera's subpoint, drawn anew for each frame: rays that look it up
 * there take one texture read in place of two that wait for each other.
 *
 * Each layer has a tile, one above the other. Positions are displacements in the plane that touches the sphere at
 * the subpoint.
 */
export class WeatherMap {
  readonly #field: CloudField
  readonly #target
  readonly #pass: FragmentPass
  readonly #map: LevelTexture<Vec2>
  readonly #columnsTarget
  readonly #columnsPass: FragmentPass
  readonly #columns: LevelTexture<Vec2>
  /** Two directions along the ground at the subpoint, in the mapped space. */
  readonly #axes: readonly [ReturnType<typeof vector3>, ReturnType<typeof vector3>] = [
    vector3(),
    vector3()
  ]

  constructor(field: CloudField) {
    this.#field = field
    const { length } = field.layers
    this.#target = tableTarget('Welkin.CloudsWeather', BACKGROUND.size, BACKGROUND.size * length)
    this.#map = texture(this.#target.texture) as unknown as LevelTexture<Vec2>
    this.#pass = new FragmentPass('Welkin.CloudsWeather', this.#draw())
    this.#columnsTarget = tableTarget('Welkin.CloudsColumns', COLUMNS.size, COLUMNS.size * length)
    this.#columnsTarget.texture.format = RGFormat
    this.#columns = texture(this.#columnsTarget.texture) as unknown as LevelTexture<Vec2>
    this.#columnsPass = new FragmentPass('Welkin.CloudsColumns', this.#drawColumns())
  }

  /** Place that a texel stands for. To be called inside of a shader function. */
  #placeAt({ even, perPosition }: MapForm): MappedPlace {
    const field = this.#field
    const { view, radius } = field
    const [x, y] = this.#axes
    const at = (uv() as unknown as Vec2).mul(vec2(1, field.layers.length)).toConst() as Vec2
    const index = at.y.floor().toInt().toConst() as Int
    const layer = layerAt(field, index)
    const position = vec2(at.x, at.y.fract()).sub(0.5).div(perPosition).toConst() as Vec2
    const far = position.length().min(0.98).toConst() as Float
    const flat = position.mul(float(even).div(far.oneMinus())).toConst() as Vec2
    const square = flat.dot(flat).toConst() as Float
    // What the sphere falls short of the plane.
    const drop = square.div(radius.add(radius.mul(radius).sub(square).sqrt()))
    const subpoint = x.mul(flat.x).add(y.mul(flat.y)).sub(view.up.mul(drop)).toConst() as Vec3
    const up = subpoint.div(radius).add(view.up).normalize().toConst() as Vec3
    const rise = layer.baseAltitude.sub(view.height)
    const footprint = square.add(rise.mul(rise)).sqrt().mul(field.pixelAngle).toConst() as Float
    return { index, layer, subpoint, up, footprint }
  }

  #draw(): Vec4 {
    return Fn(() => {
      const { layer, subpoint, up, footprint } = this.#placeAt(backgroundForm)
      return weatherBackground(this.#field, layer, subpoint, { up }, footprint)
    })()
  }

  #drawColumns(): Vec4 {
    const field = this.#field
    return Fn(() => {
      const { index, layer, subpoint, up, footprint } = this.#placeAt(columnsForm)
      const packed = this.sample(layer, index, subpoint, up, footprint)
      const background = unpackBackground(packed)
      const resolution = resolutionAt(layer, footprint)
      const still = vec2(0, 0) as Vec2
      const where = 'where unresolved'
      const weather = cloudWeather(field, layer, background, subpoint, still, resolution, where)
      const strength = columnStrength(layer, weather, background.coverage, resolution)
      const isResolved = resolution.unresolvedFraction.equal(0)
      return vec4(isResolved.select(strength, UNKNOWN), background.coverage, 0, 1)
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
    this.#columnsPass.render(renderer, this.#columnsTarget)
  }

  /** Texture coordinates of a place in a map [m]. */
  #coordinates({ even, perPosition }: MapForm, index: Int, flat: Vec2, distance: Float): Vec2 {
    const inTile = flat.div(distance.add(even)).mul(perPosition).add(0.5).toConst() as Vec2
    return vec2(inTile.x, inTile.y.add(float(index)).div(this.#field.layers.length))
  }

  /**
   * Strength of the column on a place of the ground, without billows and turbulence, and coverage there. Where it is not
   * known, the strength is beyond all bounds.
   *
   * @param subpoint - `subpointOffset` of the sample, less `leanAt`.
   */
  columnAt(index: Int, subpoint: Vec3): Vec2 {
    const [x, y] = this.#axes
    const flat = vec2(subpoint.dot(x), subpoint.dot(y)).toConst() as Vec2
    const distance = flat.length().toConst() as Float
    const at = this.#coordinates(columnsForm, index, flat, distance)
    const found = this.#columns.sample(at).level(0).xy.toConst() as Vec2
    return distance.lessThan(COLUMNS_DISTANCE).select(found, vec2(UNKNOWN, 0)).toConst()
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
    const [x, y] = this.#axes
    const flat = vec2(subpoint.dot(x), subpoint.dot(y)).toConst() as Vec2
    const distance = flat.length().toConst() as Float
    const found = vec4(0).toVar() as Vec4
    If(distance.lessThan(BACKGROUND.reach), () => {
      found.assign(
        this.#map.sample(this.#coordinates(backgroundForm, index, flat, distance)).level(0)
      )
    }).Else(() => {
      found.assign(weatherBackground(this.#field, layer, subpoint, { up }, footprint))
    })
    return found
  }

  /** Frees the map. */
  dispose(): void {
    for (const target of [this.#target, this.#columnsTarget]) target.dispose()
    for (const pass of [this.#pass, this.#columnsPass]) pass.dispose()
  }
}

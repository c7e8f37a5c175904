import { FragmentPass, tableTarget } from '@welkin/atmosphere'
import { Vector3, type Texture } from 'three'
import { Fn, If, float, texture, uv, vec2, vec4 } from 'three/tsl'
import type { Renderer } from 'three/webgpu'
import { select } from '../select'
import type { Float, Int, LevelTexture, Variable, Vec2, Vec3, Vec4 } from '../tsl-types'
import { number, vector3 } from '../uniforms'
import { fallColumn, type FallNodes } from '../precipitation/tsl/fallColumn'
import type { CloudField } from './CloudField'
import { layerAt, type LayerNodes } from './tsl/layer'
import { zenithAt } from './tsl/sample'
import {
  weatherBackground,
  weatherSystems,
  type PackedBackground,
  type WeatherSystems
} from './tsl/weatherBackground'

/** Texels along an edge of a layer's map, and of the map of whole regions. */
const SIZE = 384
const REGIONAL_SIZE = 256

/**
 * Greatest distance over the ground from the camera in the map, and the one within which its texels are nearly as wide as in its middle
 * [m]: 80 m below the camera, 1.3 km at its rim. Wider: clouds shift as one flies towards them (*Cockpit*).
 */
const MAXIMUM_DISTANCE = 60_000
const EVEN = 20_000

/**
 * Greatest distance over the ground from the camera at which the map has precipitation [m]: texels are 90 m wide below the
 * camera, 9 km there. Nearer: far shafts vanish (*Rain and snow*).
 */
const FALL_DISTANCE = 180_000

/**
 * Distance within which texels of the map of whole regions are about as wide, over that of the farthest clouds in sight. Greater:
 * fronts on the horizon blur (*World clouds*).
 */
const REGIONAL_EVEN = 0.7

/** Unit of displacements by cyclones in half floats [m]. */
const DISPLACEMENT = 1e5

/** Texels at each edge that bilinear look-ups must not leave. */
const MARGIN = 0.5

/**
 * Distance that camera and clouds may move before the maps are drawn anew [m]; look-ups are off by as much. Greater: clouds shift by jerks; smaller: slower.
 */
const STALE = 4

/** Greatest distance of a look-up from the middle of a tile, with neighbouring texels, in texture coordinates of the tile. */
const RIM = 0.5 + 2 / SIZE

/**
 * Texture coordinates of a tile per unit of position, from its middle.
 *
 * @param even - Even distance over the greatest: positions end at 1 / (1 + even).
 */
const perPosition = (size: number, even: number): number =>
  ((size - 2 * MARGIN) / (2 * size)) * (1 + even)

const PER_POSITION = perPosition(SIZE, EVEN / MAXIMUM_DISTANCE)
const FALL_PER_POSITION = perPosition(SIZE, EVEN / FALL_DISTANCE)
const REGIONAL_PER_POSITION = perPosition(REGIONAL_SIZE, REGIONAL_EVEN)

/** A place that a texel of a map stands for. */
interface PlaceInMap {
  /** Displacement in the plane, and that of the subpoint [m]. */
  readonly flat: Vec2
  readonly subpoint: Vec3
  /** Width of what a pixel sees of the clouds there [m]. */
  readonly footprint: Float
}

/**
 * Weather's background of all layers around a camera's subpoint, drawn anew where camera, clouds or layers have changed: rays that
 * look it up there take one texture read in place of three that wait for each other. Farther away they take four, but the long code of
 * fronts and belts is not in their shader: a second map has the weather of whole regions, for all layers, as far as clouds are in sight.
 *
 * Where there is precipitation, it is mapped as well, by the columns from which it falls: that is smooth, and the search
 * for storms is long. A layer from which nothing falls costs nothing there.
 *
 * Each layer has a tile, one above the other, and another one aside of it for what falls. Positions are displacements in the plane that touches the sphere at
 * the subpoint, at ρ / (ρ + EVEN) for a distance ρ from it.
 */
export class WeatherMap {
  readonly #field: CloudField
  /** Precipitation of a layer by its index, where there is any. */
  readonly #fallOf: ((index: Int) => FallNodes) | undefined
  readonly #target
  readonly #regionalTarget
  readonly #passes: readonly FragmentPass[]
  readonly #map: LevelTexture<Vec2>
  /** Two tiles side by side: of whole regions; of fronts and belts, and displacement by cyclones, in `DISPLACEMENT`. */
  readonly #regions: LevelTexture<Vec2>
  /** Distance within which texels of the map of regions are about as wide [m]. */
  readonly #even = number()
  /** Camera of the last frame, from the planet's centre, and distance that camera and clouds have moved since the maps were drawn [m]. */
  #camera = new Vector3()
  #way = 0
  /** Other inputs that they were drawn with. */
  #state: readonly unknown[] = []
  /** Two directions along the ground at the subpoint, in the mapped space. */
  readonly #axes: readonly [ReturnType<typeof vector3>, ReturnType<typeof vector3>] = [
    vector3(),
    vector3()
  ]

  /** @param fallOf - Precipitation of a layer by its index; left out, there is none. */
  constructor(field: CloudField, fallOf?: (index: Int) => FallNodes) {
    this.#field = field
    this.#fallOf = fallOf
    const { length } = field.layers
    this.#target = tableTarget('Welkin.CloudsWeather', SIZE * this.#columns, SIZE * length)
    this.#regionalTarget = tableTarget('Welkin.CloudsRegions', 2 * REGIONAL_SIZE, REGIONAL_SIZE)
    const node = (value: Texture): LevelTexture<Vec2> =>
      texture(value) as unknown as LevelTexture<Vec2>
    this.#map = node(this.#target.texture)
    this.#regions = node(this.#regionalTarget.texture)
    this.#passes = [
      new FragmentPass('Welkin.CloudsWeather', this.#draw()),
      new FragmentPass('Welkin.CloudsRegions', this.#drawRegions())
    ]
  }

  /**
   * The place of a position in a map.
   *
   * @param even - Distance within which texels are about as wide [m].
   * @param altitude - Altitude of the clouds there [m].
   */
  #placeAt(position: Vec2, even: Float, altitude: Float): PlaceInMap {
    const { view, radius, pixelAngle } = this.#field
    const [x, y] = this.#axes
    const far = position.length().min(0.98).toConst() as Float
    const flat = position.mul(even.div(far.oneMinus())).toConst() as Vec2
    const square = flat.dot(flat).min(radius.mul(radius)).toConst() as Float
    // Drop of the sphere below the plane.
    const drop = square.div(radius.add(radius.mul(radius).sub(square).sqrt()))
    const subpoint = x.mul(flat.x).add(y.mul(flat.y)).sub(view.up.mul(drop)).toConst() as Vec3
    const rise = altitude.sub(view.height)
    const footprint = square.add(rise.mul(rise)).sqrt().mul(pixelAngle).toConst() as Float
    return { flat, subpoint, footprint }
  }

  /** Tiles of a layer. */
  get #columns(): number {
    return this.#fallOf === undefined ? 1 : 2
  }

  #draw(): Vec4 {
    const field = this.#field
    const fallOf = this.#fallOf
    return Fn(() => {
      const tiles = vec2(this.#columns, field.layers.length)
      const at = (uv() as unknown as Vec2).mul(tiles).toConst() as Vec2
      const index = at.y.floor().toInt().toConst() as Int
      const layer = layerAt(field, index)
      const isFall = at.x.greaterThan(1).toConst()
      const perPosition = select(isFall, FALL_PER_POSITION, PER_POSITION)
      const position = at.fract().sub(0.5).div(perPosition).toConst() as Vec2
      const place = this.#placeAt(position, float(EVEN), layer.baseAltitude)
      const { flat, subpoint, footprint } = place
      // Nothing falls.
      const found = vec4(-1, 0, 0, 0).toVar() as Variable<Vec4>
      // Corners are never looked up.
      const isInCircle = at.fract().sub(0.5).length().lessThan(RIM)
      const fall = fallOf?.(index)
      const isWanted = fall && isFall.not().or(fall.rate.greaterThan(0))
      If(isWanted?.and(isInCircle) ?? isInCircle, () => {
        const around = this.#systemsAt(flat)
        const up = zenithAt(field, subpoint)
        found.assign(weatherBackground(field, layer, subpoint, { up }, footprint, around))
        if (fall === undefined) return
        If(isFall, () => {
          const far = flat.length().add(EVEN).toConst() as Float
          const texel = far.mul(far).mul(1 / (EVEN * SIZE * FALL_PER_POSITION))
          const width = footprint.max(texel).toConst() as Float
          found.assign(fallColumn(field, layer, fall, found, subpoint, width))
        })
      })
      return found
    })()
  }

  #drawRegions(): Vec4 {
    const field = this.#field
    return Fn(() => {
      const at = (uv() as unknown as Vec2).mul(vec2(2, 1)).toConst() as Vec2
      const position = vec2(at.x.fract(), at.y)
        .sub(0.5)
        .div(REGIONAL_PER_POSITION)
        .toConst() as Vec2
      const { subpoint, footprint } = this.#placeAt(position, this.#even, float(0))
      const found = weatherSystems(field, subpoint, footprint)
      const others = vec4(found.displacement.div(DISPLACEMENT), found.systems)
      return select(at.x.lessThan(1), found.regions, others)
    })()
  }

  /** Draws the maps where they are stale; `CloudField.update` goes first. */
  render(renderer: Renderer, up: Vector3): void {
    const [x, y] = this.#axes
    const { layers, view, radius, fadeIn, pixelAngle, drifts, worldMap } = this.#field
    const camera = up.clone().multiplyScalar(radius.value + view.height.value)
    this.#way += camera.distanceTo(this.#camera) + Math.max(...drifts.map(drift => drift.length()))
    this.#camera = camera
    const map = worldMap?.texture
    // What is drawn into, or computed, may change at any time.
    const isDrawn = map && (map.isRenderTargetTexture || 'isStorageTexture' in map)
    const version = isDrawn ? {} : map?.version
    const others = [version, worldMap?.bounds, fadeIn, pixelAngle.value]
    const state = [...others, ...Array.from(layers, layer => layer.parameters)]
    if (this.#way < STALE && state.every((value, i) => value === this.#state[i])) return
    this.#way = 0
    this.#state = state
    const top = Math.max(...[...layers].map(layer => layer.parameters.topAltitude))
    // To the horizon, and beyond it to clouds that stand over it.
    const angle = [view.height.value, top].reduce(
      (sum, height) => sum + Math.acos(radius.value / (radius.value + Math.max(height, 0))),
      0
    )
    const farthest = radius.value * Math.sin(Math.min(angle, Math.PI / 2))
    this.#even.value = REGIONAL_EVEN * Math.max(farthest, MAXIMUM_DISTANCE)
    const isPolar = Math.abs(up.z) >= 0.9
    x.value.set(isPolar ? 1 : 0, 0, isPolar ? 0 : 1)
    x.value.cross(up).normalize()
    y.value.copy(up).cross(x.value)
    const [near, regional] = this.#passes
    regional.render(renderer, this.#regionalTarget)
    near.render(renderer, this.#target)
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
      const at = inTile.add(vec2(0, float(index))).div(vec2(this.#columns, layers.length))
      found.assign(this.#map.sample(at).level(0))
    }).Else(() => {
      const around = this.#systemsAt(flat)
      found.assign(weatherBackground(this.#field, layer, subpoint, { up }, footprint, around))
    })
    return found
  }

  /**
   * The column from which precipitation of a layer falls: `fallColumn`. To be called inside of a shader function.
   *
   * @returns Undefined if the map has none.
   */
  fallAt(index: Int, subpoint: Vec3): Vec4 | undefined {
    if (this.#fallOf === undefined) return undefined
    const [x, y] = this.#axes
    const flat = vec2(subpoint.dot(x), subpoint.dot(y)).toConst() as Vec2
    const distance = flat.length().toConst() as Float
    const inTile = flat.div(distance.add(EVEN)).mul(FALL_PER_POSITION).add(0.5)
    const at = inTile.add(vec2(1, float(index))).div(vec2(2, this.#field.layers.length))
    const found = this.#map.sample(at).level(0).toConst() as Vec4
    return select(distance.lessThan(FALL_DISTANCE), found, vec4(-1, 0, 0, 0)).toConst()
  }

  /** Weather of whole regions at a displacement in the plane, from the map of it [m]. */
  #systemsAt(flat: Vec2): WeatherSystems {
    const at = flat
      .div(flat.length().add(this.#even))
      .mul(REGIONAL_PER_POSITION)
      .add(0.5)
      .clamp(MARGIN / REGIONAL_SIZE, 1 - MARGIN / REGIONAL_SIZE)
      .toConst() as Vec2
    const [regions, others] = [0, 0.5].map(
      tile =>
        this.#regions
          .sample(at.mul(vec2(0.5, 1)).add(vec2(tile, 0)))
          .level(0)
          .toConst() as Vec4
    )
    return {
      regions,
      systems: others.w,
      displacement: others.xyz.mul(DISPLACEMENT).toConst()
    }
  }

  /** Frees the map, which is drawn again when needed. */
  dispose(): void {
    this.#way = STALE
    for (const each of [this.#target, this.#regionalTarget, ...this.#passes]) each.dispose()
  }
}

import { FragmentPass, tableTarget } from '@welkin/atmosphere'
import { DataUtils, Vector3 } from 'three'
import { Fn, float, int, uniform, uv, vec2, vec4 } from 'three/tsl'
import type { Renderer } from 'three/webgpu'
import { viewpointMapped, type CloudField } from '../density/CloudField'
import { layerAt } from '../density/tsl/layer'
import { sampleLayer } from '../density/tsl/sampleLayer'
import { weatherBackground } from '../density/tsl/weatherBackground'
import { subpointOffset, type CloudSample } from '../density/tsl/sample'
import { loop, type Float, type Int, type Variable, type Vec2, type Vec3 } from '../tsl-types'
import { vector3 } from '../uniforms'
import type { Random } from './random'
import type { AtmosphereView } from '@welkin/atmosphere'

/** Columns along an edge: rows of 512 bytes, which WebGPU reads back. */
const SIZE = 64
/** Half width of the square about the camera's subpoint in which columns are looked for [m]. */
const COLUMNS_REACH = 20_000
/** Least optical depth of columns that charge, over the greatest around [–]. */
const STRONG = 0.5
/** Distance of flashes from the camera, at least [m]. */
const NEAREST = 1000
/** Samples of a column. */
const SAMPLES = 8

/** A column of cloud. */
interface Column {
  /** Its place on the sphere of altitude 0, from the planet's centre, in the mapped space [m]. */
  readonly place: Vector3
  /** Distance over the ground from the camera, when it was searched for [m]. */
  readonly distance: number
  /** Optical depth. */
  readonly depth: number
}

/** Optical depths of a layer's columns around the camera, read back from the GPU without a wait. */
export class StormColumns {
  /** Columns with cloud; null until they have been read back. */
  columns: readonly Column[] | null = null
  readonly #target = tableTarget('Welkin.LightningColumns', SIZE, SIZE)
  readonly #pass: FragmentPass
  readonly #x = vector3()
  readonly #y = vector3()
  readonly #layer = uniform(0, 'int')
  #isReading = false

  constructor(readonly field: CloudField) {
    const { view, radius } = field
    this.#pass = new FragmentPass(
      'Welkin.LightningColumns',
      Fn(() => {
        const layer = layerAt(field, int(this.#layer as unknown as Int).toConst())
        const flat = (uv() as unknown as Vec2).mul(2).sub(1).mul(COLUMNS_REACH).toConst() as Vec2
        const aside = this.#x.mul(flat.x).add(this.#y.mul(flat.y)).toConst() as Vec3
        const up = aside.div(radius).add(view.up).normalize().toConst() as Vec3
        const depth = float(0).toVar() as Variable<Float>
        loop('columnSample', SAMPLES, index => {
          const height = float(index).add(0.5).div(SAMPLES)
          const altitude = layer.baseAltitude.add(layer.thickness.mul(height)).toConst() as Float
          const offset = up
            .mul(radius.add(altitude))
            .sub(view.up.mul(radius.add(view.height)))
            .toConst() as Vec3
          const distance = offset.length().toConst() as Float
          const sample: CloudSample = { offset, altitude, up, distance }
          const footprint = distance.mul(field.pixelAngle).toConst() as Float
          const subpoint = subpointOffset(field, sample).toConst() as Vec3
          const background = weatherBackground(field, layer, subpoint, sample, footprint)
          depth.addAssign(
            sampleLayer(field, layer, background, sample, { detail: false }).extinction
          )
        })
        // Places go along: the order of rows read back differs between the backends.
        return vec4(depth.mul(layer.thickness.div(SAMPLES)).min(6e4), vec2(flat).div(1000), 1)
      })()
    )
  }

  /** Draws and reads back the columns of a layer; the answer comes frames later. The field is up to date. */
  look(renderer: Renderer, view: AtmosphereView, layer: number): void {
    if (this.#isReading) return
    this.#isReading = true
    const { up } = view
    const [x, y] = [this.#x.value, this.#y.value]
    x.set(Math.abs(up.z) < 0.9 ? 0 : 1, 0, Math.abs(up.z) < 0.9 ? 1 : 0)
    x.cross(up).normalize()
    y.copy(up).cross(x)
    this.#layer.value = layer
    this.#pass.render(renderer, this.#target)
    const centre = viewpointMapped(view, new Vector3())
    const radius = view.atmosphere.parameters.bottomRadius
    const [east, north] = [x.clone(), y.clone()]
    void renderer
      .readRenderTargetPixelsAsync(this.#target, 0, 0, SIZE, SIZE)
      .then(pixels => {
        const values = pixels as Uint16Array
        const columns: Column[] = []
        for (let i = 0; i < values.length; i += 4) {
          const [depth, e, n] = [0, 1, 2].map(k => DataUtils.fromHalfFloat(values[i + k]))
          if (!(depth > 0)) continue
          const place = centre
            .clone()
            .addScaledVector(east, 1000 * e)
            .addScaledVector(north, 1000 * n)
            .setLength(radius)
          columns.push({ place, distance: 1000 * Math.hypot(e, n), depth })
        }
        // The same order on both backends, for the same choice.
        this.columns = columns.sort((a, b) => a.place.x - b.place.x || a.place.y - b.place.y)
      })
      .finally(() => {
        this.#isReading = false
      })
  }

  /** Place of one of the strong columns; undefined if there is none. */
  choose(random: Random): Vector3 | undefined {
    const near = (this.columns ?? []).filter(
      ({ distance }) => distance > NEAREST && distance < COLUMNS_REACH
    )
    const most = near.reduce((depth, column) => Math.max(depth, column.depth), 0)
    const strong = near.filter(({ depth }) => depth >= STRONG * most)
    return strong[Math.floor(random() * strong.length)]?.place
  }

  /** Frees its texture. */
  dispose(): void {
    this.#target.dispose()
    this.#pass.dispose()
  }
}

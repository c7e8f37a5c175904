import { RepeatWrapping, Vector4 } from 'three'
import type { Matrix4, RenderTarget } from 'three'
import { Fn, If, renderGroup, texture, uniform, uv, vec4 } from 'three/tsl'
import type { Renderer } from 'three/webgpu'
import type { AtmosphereView } from './AtmosphereView'
import { CelestialFrame } from './CelestialFrame'
import { FragmentPass, tableTarget } from './FragmentPass'
import { DROWNS, type SkyLayer, type SkyRay } from './SkyLayer'
import { starIrradiance } from './stars/starColor'
import { galacticUV, milkyWayMap, toGalactic } from './tsl/milkyWay'
import { sampleLevel0, type Vec4 } from './tsl-types'

/** Options of {@link MilkyWay}. */
export interface MilkyWayOptions {
  /** Rotation from the stars' frame to ECEF; by default what the atmosphere's date makes it. */
  orientation?: Matrix4 | null
}

/** Texels of the map: a third of a degree along the band, a sixth across. */
const SIZE = [1024, 384] as const

/** B − V of the band where there is no dust [mag]. */
const COLOR_INDEX = 0.7

/** Luminance of 1 in the map [cd/m²]. */
const UNIT = 1e-4

/**
 * The Milky Way: a faint band along the galactic equator, brightest towards Sagittarius, split by the
 * dark rift; and the light of faint stars everywhere else.
 *
 * ```ts
 * atmosphere.add(milkyWay(), stars())
 * ```
 *
 * Photometric: 20.5 magnitudes per square second of arc at its brightest, 21.5 in the band, 24 at the
 * galactic poles. Its large shapes, the brightest clouds and the rift are where they are in the sky;
 * the rest is noise. Nothing is fetched: the map (3 MB) is drawn once, on the GPU.
 */
export class MilkyWay implements SkyLayer {
  readonly isAdditive = true
  /** Multiplies the physical brightness, ≥ 0. */
  intensity = 1
  readonly #frame = new CelestialFrame()
  readonly #target: RenderTarget = tableTarget('MilkyWay', ...SIZE)
  readonly #color = uniform(new Vector4()).setGroup(renderGroup)
  readonly #map
  #pass: FragmentPass | null = null
  #renderer: Renderer | null = null

  constructor({ orientation }: MilkyWayOptions = {}) {
    this.orientation = orientation ?? null
    this.#target.texture.wrapS = RepeatWrapping
    this.#map = texture(this.#target.texture)
  }

  /** Rotation from the stars' frame to ECEF; null to follow the atmosphere's date. */
  get orientation(): Matrix4 | null {
    return this.#frame.orientation
  }

  set orientation(value: Matrix4 | null) {
    this.#frame.orientation = value
  }

  prepare(renderer: Renderer): void {
    if (renderer === this.#renderer) return
    this.#renderer = renderer
    this.#pass ??= new FragmentPass('Welkin.MilkyWay', Fn(() => milkyWayMap(uv()))())
    this.#pass.render(renderer, this.#target)
  }

  update(view: AtmosphereView): void {
    this.#frame.update(view)
    const luminance = UNIT * Math.max(this.intensity, 0)
    const color = starIrradiance(view.atmosphere.parameters, COLOR_INDEX, luminance)
    this.#color.value.fromArray(color)
  }

  beyond(ray: SkyRay, farther: Vec4): Vec4 {
    const sum = farther.toVar()
    // By day it is less than a thousandth of the sky.
    If(ray.airlight.y.lessThan(this.#color.y.mul(DROWNS)), () => {
      const direction = toGalactic(this.#frame.toCelestial(ray.direction)).toConst()
      const light = sampleLevel0(this.#map, galacticUV(direction))
      sum.addAssign(vec4(light.mul(this.#color)))
    })
    return sum
  }

  /** Frees the map. It is drawn again when it is needed. */
  dispose(): void {
    this.#target.dispose()
    this.#pass?.dispose()
    this.#pass = null
    this.#renderer = null
  }
}

/** The Milky Way: see {@link MilkyWay}. */
export const milkyWay = (options?: MilkyWayOptions): MilkyWay => new MilkyWay(options)

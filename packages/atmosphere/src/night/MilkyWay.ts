import { Matrix3, Vector4 } from 'three'
import type { Matrix4, RenderTarget } from 'three'
import { Fn, If, renderGroup, texture, uniform, uv, vec4 } from 'three/tsl'
import type { Renderer } from 'three/webgpu'
import { checkNonNegative, setOptions } from '@welkin/geo'
import type { AtmosphereView } from '../view/AtmosphereView'
import { checkOrientation } from '../check'
import { CelestialFrame } from './CelestialFrame'
import { FragmentPass, tableTarget } from '../tables/FragmentPass'
import { DROWNS, type SkyLayer, type SkyRay } from '../view/SkyLayer'
import { starIrradiance } from '../stars/starColor'
import { CELESTIAL_TO_GALACTIC, milkyWayMap } from './tsl/milkyWay'
import { octahedralPoint } from '../math/tsl/octahedron'
import { sampleLevel0, type Vec4 } from '../tsl-types'

/** Options of {@link MilkyWay}. */
export interface MilkyWayOptions {
  /** Rotation from the stars' frame to ECEF; by default what the atmosphere's date makes it. */
  orientation?: Matrix4 | null
  /** Multiplies the physical brightness, finite, ≥ 0, default 1. */
  intensity?: number
}

/** Texels along an edge of the map: a sixth to a third of a degree each. */
const SIZE = 512

/** The map ends in the middle of its outermost texels: folded along its edges, it has no seam. */
const EDGE = SIZE / (SIZE - 1)

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
 * the rest is noise. Nothing is fetched: the map (2 MB) is drawn once, on the GPU.
 */
export class MilkyWay implements SkyLayer {
  readonly isAdditive = true
  #intensity = 1
  readonly #frame = new CelestialFrame(new Matrix3().set(...CELESTIAL_TO_GALACTIC))
  readonly #target: RenderTarget = tableTarget('MilkyWay', SIZE, SIZE)
  readonly #color = uniform(new Vector4()).setGroup(renderGroup)
  /** Green light of the air that hides it. */
  readonly #drowns = uniform(0).setGroup(renderGroup)
  readonly #map
  #pass: FragmentPass | null = null
  #renderer: Renderer | null = null

  /** @throws If an option is of the wrong kind. */
  constructor(options: MilkyWayOptions = {}) {
    this.set(options)
    this.#map = texture(this.#target.texture)
  }

  /**
   * Changes some settings.
   *
   * @throws If one is unknown or of the wrong kind; then nothing has changed.
   */
  set(settings: MilkyWayOptions): this {
    return setOptions('MilkyWay', this, settings, 'orientation', 'intensity')
  }

  /** Multiplies the physical brightness, finite, ≥ 0. */
  get intensity(): number {
    return this.#intensity
  }

  set intensity(value: number) {
    checkNonNegative('MilkyWay', 'intensity', value)
    this.#intensity = value
  }

  /** Rotation from the stars' frame to ECEF; null to follow the atmosphere's date. */
  get orientation(): Matrix4 | null {
    return this.#frame.orientation
  }

  set orientation(value: Matrix4 | null) {
    checkOrientation('MilkyWay', value)
    this.#frame.orientation = value
  }

  prepare(renderer: Renderer): void {
    if (renderer === this.#renderer) return
    this.#renderer = renderer
    this.#pass ??= new FragmentPass(
      'Welkin.MilkyWay',
      Fn(() =>
        milkyWayMap(
          uv()
            .sub(0.5)
            .mul(2 * EDGE)
        )
      )()
    )
    this.#pass.render(renderer, this.#target)
  }

  update(view: AtmosphereView): void {
    this.#frame.update(view)
    const luminance = UNIT * this.intensity
    const color = starIrradiance(view.atmosphere.parameters, COLOR_INDEX, luminance)
    this.#color.value.fromArray(color)
    this.#drowns.value = this.#color.value.y * DROWNS
  }

  beyond(ray: SkyRay, farther: Vec4): Vec4 {
    const sum = farther.toVar()
    // By day it is less than a thousandth of the sky.
    If(ray.airlight.y.lessThan(this.#drowns), () => {
      const point = octahedralPoint(this.#frame.turn(ray.direction).toConst())
      const light = sampleLevel0(this.#map, point.mul(0.5 / EDGE).add(0.5))
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

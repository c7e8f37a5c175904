import { Matrix3 } from 'three'
import type { Matrix4, RenderTarget } from 'three'
import { Fn, If, texture, uv, vec4 } from 'three/tsl'
import type { Renderer } from 'three/webgpu'
import { checkNonNegative, setOptions } from '@welkin/geo'
import type { AtmosphereView } from '../view/AtmosphereView'
import { checkOrientation } from '../check'
import { CelestialFrame } from './CelestialFrame'
import { FragmentPass, tableTarget } from '../tables/FragmentPass'
import { checkOwner } from '../view/renderers'
import { MASKING_RATIO, type SkyLayer, type SkyRay } from '../view/SkyLayer'
import { starIrradiance } from '../stars/starBrightness'
import { CELESTIAL_TO_GALACTIC, milkyWayMap } from './tsl/milkyWay'
import { octahedralPoint } from '../math/tsl/octahedron'
import { sampleLevel0, type Vec4 } from '../tsl-types'
import { number, vector4 } from '../uniforms'

/** Options of {@link MilkyWay}. */
export interface MilkyWayOptions {
  /** Rotation from the stars' frame (J2000) to ECEF; by default it follows the atmosphere's date. */
  orientation?: Matrix4 | null
  /** Factor on the physical brightness, finite, ≥ 0, default 1. */
  intensity?: number
}

/** Width of the map [texels], each a sixth to a third of a degree. */
const MAP_SIZE = 512

/** Scale of the map: it ends in the centres of its outermost texels, so that its folded edges have no seam. */
const MAP_SCALE = MAP_SIZE / (MAP_SIZE - 1)

/** Colour index B − V of the band where there is no dust [mag]. */
const COLOR_INDEX = 0.7

/** Luminance of a map value of 1 [cd/m²]. */
const MAP_LUMINANCE = 1e-4

/**
 * The Milky Way: a faint band along the galactic equator, brightest towards Sagittarius and split by the
 * Great Rift; and the unresolved starlight of the rest of the sky.
 *
 * ```ts
 * atmosphere.add(milkyWay(), stars())
 * ```
 *
 * Brightness is photometric: 20.5 magnitudes per square arc second at its brightest, 21.5 in the band, 24
 * at the galactic poles. The large shapes, the brightest star clouds and the rift are in their places; the
 * rest is noise. Nothing is fetched: the map (2 MB) is drawn once on the GPU.
 */
export class MilkyWay implements SkyLayer {
  readonly isAdditive = true
  #intensity = 1
  readonly #frame = new CelestialFrame(new Matrix3().set(...CELESTIAL_TO_GALACTIC))
  readonly #target: RenderTarget = tableTarget('Welkin.MilkyWay', MAP_SIZE, MAP_SIZE)
  readonly #color = vector4()
  /** Radiance of the air in the green that masks it [1/sr]. */
  readonly #maskingRadiance = number()
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

  /** Factor on the physical brightness, finite, ≥ 0. */
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
    checkOwner('MilkyWay', this.#renderer, renderer)
    this.#renderer = renderer
    this.#pass ??= new FragmentPass(
      'Welkin.MilkyWay',
      Fn(() =>
        milkyWayMap(
          uv()
            .sub(0.5)
            .mul(2 * MAP_SCALE)
        )
      )()
    )
    this.#pass.render(renderer, this.#target)
  }

  update(view: AtmosphereView): void {
    this.#frame.update(view)
    const luminance = MAP_LUMINANCE * this.intensity
    const color = starIrradiance(view.atmosphere.parameters, COLOR_INDEX, luminance)
    this.#color.value.fromArray(color)
    this.#maskingRadiance.value = this.#color.value.y * MASKING_RATIO
  }

  background(ray: SkyRay, farther: Vec4): Vec4 {
    const sum = farther.toVar()
    // By day the sky masks it.
    If(ray.airlight.y.lessThan(this.#maskingRadiance), () => {
      const point = octahedralPoint(this.#frame.fromMapped(ray.direction).toConst())
      const light = sampleLevel0(this.#map, point.mul(0.5 / MAP_SCALE).add(0.5))
      sum.addAssign(vec4(light.mul(this.#color)))
    })
    return sum
  }

  /** Frees the map, which is drawn again when needed. */
  dispose(): void {
    this.#target.dispose()
    this.#pass?.dispose()
    this.#pass = null
    this.#renderer = null
  }
}

/** The Milky Way: see {@link MilkyWay}. */
export const milkyWay = (options?: MilkyWayOptions): MilkyWay => new MilkyWay(options)

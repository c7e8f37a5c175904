import { renderGroup, uniform } from 'three/tsl'
import type { Atmosphere } from '../Atmosphere'
import type { AtmosphereView } from '../view/AtmosphereView'
import { visibleSun } from '../transmittance/cpu/transmittance'
import { HaloUniforms, type FlareOptions } from './HaloUniforms'
import type { SkyLayer, SkyRay } from '../view/SkyLayer'
import { addHalo } from './tsl/halo'
import type { Vec4 } from '../tsl-types'
import { checkAtmosphere } from '../view/ViewNodes'

/**
 * Default lobes, found by looking: standard deviations of 0.7° and 4.7° (1/√power). Larger strengths
 * outshine the corona and the sky around the sun, larger powers leave a bare disc. Story: Eclipse,
 * DiamondRing.
 */
const DEFAULTS = { innerPower: 6000, innerStrength: 0.006, outerPower: 150, outerStrength: 0.004 }

/**
 * Halo that an eye or a lens makes around the sun: a tight lobe inside a broad one. The air dims and
 * reddens it; it goes out when the sun sets or is eclipsed.
 *
 * ```ts
 * atmosphere.add(sunFlare(atmosphere))
 * ```
 *
 * It is drawn on the sky, not over objects in front of it.
 */
export class SunFlare implements SkyLayer {
  /** Shared, not owned. */
  readonly atmosphere: Atmosphere
  readonly #halo: HaloUniforms
  /** Fraction of the sun's disc above the horizon. */
  readonly #visibleFraction = uniform(0).setGroup(renderGroup)

  /** @throws If an argument is of the wrong kind or out of its range. */
  constructor(atmosphere: Atmosphere, options: FlareOptions = {}) {
    checkAtmosphere('SunFlare', atmosphere)
    this.atmosphere = atmosphere
    this.#halo = new HaloUniforms('SunFlare', DEFAULTS)
    this.set(options)
  }

  /**
   * Changes powers and strengths.
   *
   * @throws If one is unknown or out of its range; then nothing has changed.
   */
  set(options: FlareOptions): this {
    this.#halo.set(options)
    return this
  }

  update(view: AtmosphereView): void {
    const { parameters } = this.atmosphere
    const radius = parameters.bottomRadius + Math.max(view.height, 0)
    this.#visibleFraction.value = visibleSun(parameters, radius, view.up.dot(view.sunDirection))
    this.#halo.update(this.#visibleFraction.value > 0)
  }

  beyond(ray: SkyRay, farther: Vec4): Vec4 {
    const { direction, cosViewSun, view } = ray
    const light = farther.toVar()
    const irradiance = view.source.irradiance.mul(this.#visibleFraction)
    addHalo(light, this.#halo, irradiance, direction, view.sunDirection, cosViewSun)
    return light
  }
}

/** Halo of the sun: see {@link SunFlare}. */
export const sunFlare = (atmosphere: Atmosphere, options: FlareOptions = {}): SunFlare =>
  new SunFlare(atmosphere, options)

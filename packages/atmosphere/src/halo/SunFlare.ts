import type { AtmosphereView } from '../view/AtmosphereView'
import { visibleDisc } from '../transmittance/cpu/transmittance'
import { Flare, type FlareOptions } from './Flare'
import type { SkyLayer, SkyRay } from '../view/SkyLayer'
import { addHalo } from './tsl/halo'
import type { Vec4 } from '../tsl-types'
import { number } from '../uniforms'

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
 * atmosphere.add(sunFlare())
 * ```
 *
 * It is drawn on the sky, not over objects in front of it.
 */
export class SunFlare extends Flare implements SkyLayer {
  /** Fraction of the sun's disc above the horizon. */
  readonly #visibleFraction = number()

  /** @throws If an option is unknown or out of its range. */
  constructor(options: FlareOptions = {}) {
    super('SunFlare', DEFAULTS)
    this.set(options)
  }

  update(view: AtmosphereView): void {
    const { parameters } = view.atmosphere
    const radius = parameters.bottomRadius + Math.max(view.height, 0)
    this.#visibleFraction.value = visibleDisc(parameters, radius, view.up.dot(view.lightDirection))
    this.updateMaximumAngle(this.#visibleFraction.value > 0)
  }

  background(ray: SkyRay, farther: Vec4): Vec4 {
    const { direction, cosViewLight, view } = ray
    const light = farther.toVar()
    const irradiance = view.source.irradiance.mul(this.#visibleFraction)
    addHalo(light, this.uniforms, irradiance, direction, view.lightDirection, cosViewLight)
    return light
  }
}

/** Halo of the sun: see {@link SunFlare}. */
export const sunFlare = (options?: FlareOptions): SunFlare => new SunFlare(options)

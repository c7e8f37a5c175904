import { renderGroup, uniform } from 'three/tsl'
import type { AtmosphereView } from '../view/AtmosphereView'
import { visibleSun } from '../transmittance/cpu/transmittance'
import { Flare, type FlareOptions } from './Flare'
import type { SkyLayer, SkyRay } from '../view/SkyLayer'
import { addHalo } from './tsl/halo'
import type { Vec4 } from '../tsl-types'

const DEFAULTS = { innerPower: 6000, innerStrength: 0.006, outerPower: 150, outerStrength: 0.004 }

/**
 * The halo that an eye or a lens makes of the sun: a tight lobe inside a broad one. The air dims and
 * reddens it, and it goes when the sun sets or is eclipsed.
 *
 * ```ts
 * atmosphere.add(sunFlare())
 * ```
 *
 * Drawn on the sky, not over what stands in front of it.
 */
export class SunFlare extends Flare implements SkyLayer {
  /** Part of the sun's disc that is above the horizon. */
  readonly #visible = uniform(0).setGroup(renderGroup)

  /** @throws If an option is unknown or out of its range. */
  constructor(options: FlareOptions = {}) {
    super('SunFlare', DEFAULTS)
    this.set(options)
  }

  update(view: AtmosphereView): void {
    const { parameters } = view.atmosphere
    const radius = parameters.bottomRadius + Math.max(view.height, 0)
    this.#visible.value = visibleSun(parameters, radius, view.up.dot(view.sunDirection))
    this.setReach(this.#visible.value > 0)
  }

  beyond(ray: SkyRay, farther: Vec4): Vec4 {
    const { direction, cosViewSun, view } = ray
    const light = farther.toVar()
    const irradiance = view.source.irradiance.mul(this.#visible)
    addHalo(light, this.uniforms, irradiance, direction, view.sunDirection, cosViewSun)
    return light
  }
}

/** The sun's halo: see {@link SunFlare}. */
export const sunFlare = (options?: FlareOptions): SunFlare => new SunFlare(options)

import type { NightLightProbe, SkyLightProbe, SkyLitPlane, ViewNodes } from '@welkin/atmosphere'
import { checkRange } from '@welkin/atmosphere'
import { fail } from '@welkin/geo'
import { float, mix } from 'three/tsl'
import { checkClouds } from '../check'
import type { CloudsNode } from '../march/CloudsNode'
import { overcastIrradiance } from './tsl/overcast'
import type { Vec3, Vec4 } from '../tsl-types'
import { number } from '../uniforms'

/** The cloud light of each probe. */
const _ofProbe = new WeakMap<SkyLightProbe | NightLightProbe, CloudSkyLight>()

/**
 * Clouds in the light of the sky on surfaces: see {@link cloudSkyLight}.
 */
export class CloudSkyLight {
  /** Shared, not owned. */
  readonly probe: SkyLightProbe | NightLightProbe
  /** Clouds that change the light; shared, not owned. */
  readonly clouds: CloudsNode
  readonly #strength = number(1)
  readonly #overcast: SkyLightProbe['overcast']

  /** @throws If an argument is missing, or they are of two atmospheres. */
  constructor(probe: SkyLightProbe | NightLightProbe, clouds: CloudsNode) {
    if (probe?.overcast === undefined) {
      fail('CloudSkyLight', 'probe must be a SkyLightProbe or NightLightProbe', probe)
    }
    // One whose clouds were disposed of is replaced without an error.
    const before = _ofProbe.get(probe)
    if (before?.clouds.isDisposed === true) before.dispose()
    if (probe.overcast !== null) {
      fail('CloudSkyLight', 'probe must have no other CloudSkyLight: dispose of that first', probe)
    }
    checkClouds('CloudSkyLight', clouds)
    if (probe.atmosphere !== clouds.atmosphere) {
      fail('CloudSkyLight', "clouds must be in the probe's atmosphere")
    }
    this.probe = probe
    this.clouds = clouds
    this.#overcast = probe.overcast = (plane, clear) => this.#light(plane, clear)
    _ofProbe.set(probe, this)
  }

  /** Share of the clouds' effect on the light, in [0, 1]: 1 is right, 0 leaves a clear sky. */
  get strength(): number {
    return this.#strength.value
  }

  /** @throws If it is out of its range. */
  set strength(strength: number) {
    checkRange('CloudSkyLight', 'strength', strength, 0, 1)
    this.#strength.value = strength
  }

  #light(plane: SkyLitPlane, clear: Vec4): Vec4 {
    const { field, light, shadows, isDisposed } = this.clouds
    if (isDisposed) return clear
    // Displacement between two cameras. In float32 it may be a metre off, which the weather does not show.
    const viewpoint = ({ up, height }: ViewNodes): Vec3 => up.mul(field.radius.add(height))
    const offset = plane.offset
      .add(viewpoint(plane.view).sub(viewpoint(field.view)))
      .toConst() as Vec3
    const without = clear.toConst() as Vec4
    const cloudy = overcastIrradiance(field, light.nodes, plane, offset, without, shadows.falling)
    return mix(without, cloudy, float(this.#strength))
  }

  /** Leaves the probe as it was. */
  dispose(): void {
    this.strength = 0
    if (this.probe.overcast === this.#overcast) this.probe.overcast = null
  }
}

/**
 * Light that comes through clouds and from them, given by a `SkyLightProbe` or `NightLightProbe`: under an overcast less
 * than all of a clear day's light, but more than its blue sky's; above the clouds that of the white below.
 *
 * ```ts
 * const sky = new SkyLightProbe(atmosphere)
 * scene.add(sky)
 * cloudSkyLight(sky, cloudsNode) // before the first render; `dispose()` ends it
 * ```
 *
 * It is a mean over some kilometres, from the weather alone, and goes together with `cloudShadow`, which
 * takes from the sun what is given here. Layers whose `shadow` is false have no part in it. A moon's probe
 * takes it too, and that of the night sky. After the clouds' `dispose` the sky is clear again. Where materials were compiled before, it
 * comes with `renderer.contextNode.needsUpdate = true`.
 *
 * @throws If an argument is missing, or they are of two atmospheres.
 */
export const cloudSkyLight = (
  probe: SkyLightProbe | NightLightProbe,
  clouds: CloudsNode
): CloudSkyLight => new CloudSkyLight(probe, clouds)

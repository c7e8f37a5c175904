import type { Renderer } from 'three/webgpu'
import { SkyVolumes, type SkyVolume } from '../skyVolume/SkyVolumes'
import type { EyeScalars } from '../view/tsl/eye'

/** Sky volumes of a source that seldom matters: computed only while it does. */
export class MoonVolumes extends SkyVolumes {
  /** Whether anyone will look at them. */
  isNeeded = false
  readonly #none: SkyVolume = { slot: 0, eye: null, tablesVersion: -1, lastUsed: 0 }

  override volumeFor(
    renderer: Renderer,
    eye: EyeScalars<number>,
    tablesVersion: number
  ): SkyVolume {
    return this.isNeeded ? super.volumeFor(renderer, eye, tablesVersion) : this.#none
  }
}

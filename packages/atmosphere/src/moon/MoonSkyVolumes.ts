import type { Renderer } from 'three/webgpu'
import { SkyVolumes, type SkyVolume } from '../skyVolume/SkyVolumes'
import type { EyeScalars } from '../view/tsl/eye'

/** Sky volumes of moonlight, computed only while moonlit air can be seen. */
export class MoonSkyVolumes extends SkyVolumes {
  /** Set while moonlit air can be seen. */
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

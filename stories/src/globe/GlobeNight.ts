import { exposureFor } from '@welkin/atmosphere'
import type {
  Airglow,
  Atmosphere,
  CloudedSky,
  MilkyWay,
  Moon,
  MoonDirectionalLight,
  NightLightProbe,
  SkyLightProbe,
  Stars
} from '@welkin/atmosphere'
import { Ellipsoid } from '@welkin/geo'
import { PerspectiveCamera } from 'three'
import type { Camera } from 'three'

/** Light of day over that of the land below the camera from which it is night. */
const DUSK = 40
/** Height of the place whose light tells day from night, at most [m]. */
const HIGHEST = 10_000

/** Parts of a night sky that one can do without. */
export interface NightFeatures {
  /** Stars and the Milky Way. */
  stars: boolean
  moon: boolean
  airglow: boolean
}

/** Night sky and its lights. */
export interface Night {
  readonly sky: readonly [MilkyWay, Stars, Moon, Airglow]
  readonly lights: readonly [MoonDirectionalLight, SkyLightProbe, NightLightProbe]
}

/** Night over a globe, which is made when it first falls. */
export class GlobeNight {
  #night: Night | undefined
  #features: NightFeatures = { stars: true, moon: true, airglow: true }
  readonly #below = new PerspectiveCamera()

  /**
   * @param nightfall - Adds what a night has.
   * @param clouds - Clouds that dim the land's light; null for none.
   */
  constructor(
    private readonly atmosphere: Atmosphere,
    private readonly nightfall: () => Night,
    private readonly clouds: CloudedSky | null = null
  ) {}

  /** Switches parts of the night sky on and off; nothing is compiled. */
  show({ stars, moon, airglow }: NightFeatures): void {
    this.#features = { stars, moon, airglow }
    if (this.#night === undefined) return
    const [galaxy, starlight, luna, glow] = this.#night.sky
    galaxy.intensity = starlight.intensity = Number(stars)
    luna.strength = Number(moon)
    glow.intensity = Number(airglow)
  }

  /** Has night fall once the land below a camera is dark. */
  update(camera: Camera): void {
    if (this.#night !== undefined) return
    const { atmosphere, clouds } = this
    const { longitude, latitude, height } = Ellipsoid.WGS84.ecefToGeodetic(camera.position)
    const below = { longitude, latitude, height: Math.min(height, HIGHEST) }
    Ellipsoid.WGS84.geodeticToECEF(below, this.#below.position)
    this.#below.updateMatrixWorld()
    if (exposureFor(atmosphere, this.#below, { clouds }) <= DUSK) return
    this.#night = this.nightfall()
    this.show(this.#features)
  }

  dispose(): void {
    for (const light of this.#night?.lights ?? []) {
      light.removeFromParent()
      light.dispose()
    }
  }
}

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
import { MathUtils, PerspectiveCamera } from 'three'
import type { Camera } from 'three'

/** Illuminance of a street, and of what is seen from {@link HIGH} [lx]: pictures are exposed for no less. */
const FLOOR = { street: 2, orbit: 0.01 }
/** Altitude from which the floor is that of orbit [m]. */
const HIGH = 100_000
/** Stops that a picture may be darker than one that is exposed for: nights stay night, and days are as they are. */
const DARKER = 2
/** Height of the place that a picture from above is exposed for, at most [m]. */
const EXPOSED_HEIGHT = 10_000

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

/** Night over a globe, which is made when it first falls, and exposure for it. */
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

  /** Exposes for the land below a camera. */
  update(camera: Camera): void {
    const { atmosphere, clouds } = this
    const { longitude, latitude, height } = Ellipsoid.WGS84.ecefToGeodetic(camera.position)
    const below = { longitude, latitude, height: Math.min(height, EXPOSED_HEIGHT) }
    Ellipsoid.WGS84.geodeticToECEF(below, this.#below.position)
    this.#below.updateMatrixWorld()
    const part = Math.log(Math.max(height, 100) / 100) / Math.log(HIGH / 100)
    const [low, high] = [Math.log(FLOOR.street), Math.log(FLOOR.orbit)]
    const floor = Math.exp(MathUtils.lerp(low, high, Math.min(part, 1)))
    const exposure = exposureFor(atmosphere, this.#below, { floor, clouds }) / 2 ** DARKER
    atmosphere.luminanceScale = 1e-4 * Math.max(exposure, 1)
    if (exposure <= 1 || this.#night !== undefined) return
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

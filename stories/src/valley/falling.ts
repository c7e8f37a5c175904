import {
  precipitationOverlay,
  rainfall,
  raindrops,
  snowfall,
  SurfaceWater,
  type Precipitation
} from '@welkin/atmosphere'
import type { Atmosphere } from '@welkin/atmosphere'
import { precipitationShafts } from '@welkin/clouds'
import type { Light, PerspectiveCamera } from 'three'
import type { Node, TextureNode } from 'three/webgpu'
import { FadingBow } from './FadingBow'
import type { Weather } from './weather'

/** Seconds of drying and wetting in one second on the clock. */
const HASTE = 60
/** Drops and flakes of a class of size that are drawn, at most: farther off each stands for more. */
const PARTICLES = { rain: 16_384, snow: 20_480 }
/** Water of rain, and of snow, that lies where weather was before the scene began [mm]. */
const FALLEN = { rain: 0.5, snow: 12 }

/** Rain and snow of the valley: under its clouds, around the camera, and on the ground. */
export class ValleyPrecipitation {
  readonly drops = new FadingBow(raindrops({ rate: 12 })) // rainbows
  readonly shafts = precipitationShafts({ drops: this.drops }) // to `clouds`
  readonly water = new SurfaceWater() // to what gets wet
  #falling: readonly Precipitation[] = []
  #wets = true
  #weather: Pick<Weather, 'rain' | 'snow'> = { rain: 0, snow: 0 }

  /** Draws what falls around the camera over a picture with its air and clouds. */
  over(
    picture: Node,
    depth: TextureNode,
    camera: PerspectiveCamera,
    atmosphere: Atmosphere,
    lights: readonly Light[]
  ): Node {
    const options = {
      lights,
      depth,
      depthCamera: camera,
      rate: 0,
      wind: { east: 3, north: 1 },
      shutter: 1 / 60,
      aperture: 0.003
    }
    this.#falling = [
      rainfall(atmosphere, { ...options, maxParticles: PARTICLES.rain }),
      snowfall(atmosphere, { ...options, maxParticles: PARTICLES.snow })
    ]
    return precipitationOverlay(picture, camera, this.#falling)
  }

  /** True if the ground gets wet and white; set, it is at once as if weather had been as it is for long. */
  get wets(): boolean {
    return this.#wets
  }

  set wets(value: boolean) {
    if (value === this.#wets) return
    this.#wets = value
    this.#cover()
  }

  /** Takes what falls; at once, as if it had fallen for long. */
  set({ rain, snow }: Weather, atOnce: boolean): void {
    for (const [i, rate] of [rain, snow].entries()) {
      // Less than a drizzle is none.
      const falls = rate < 0.05 ? 0 : rate
      if (this.#falling[i].rate !== falls) this.#falling[i].rate = falls
    }
    this.#weather = { rain, snow }
    if (atOnce) this.#cover()
  }

  /** Covers the ground with what has fallen for long. */
  #cover(): void {
    const { rain, snow } = this.#weather
    this.water.water = this.#wets && rain > 0 ? FALLEN.rain : 0
    this.water.snow = this.#wets && snow > 0 ? FALLEN.snow : 0
  }

  /** Wets, whitens and dries the ground. */
  update(seconds: number, { rain, snow }: Weather): void {
    if (!this.#wets) return
    const isCold = snow > 0
    const temperature = isCold ? -1 : 14
    const irradiance = rain + snow > 0 ? 60 : 400
    this.water.update(seconds * HASTE, { rain, snow, temperature, wind: 3, irradiance })
  }

  /** Time of what falls [s]. */
  set time(seconds: number) {
    for (const each of this.#falling) each.time = seconds
  }

  dispose(): void {
    for (const each of this.#falling) each.dispose()
    this.drops.dispose()
  }
}

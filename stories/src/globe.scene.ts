import {
  airglow,
  milkyWay,
  moon,
  MoonDirectionalLight,
  NightLightProbe,
  SkyLightProbe,
  stars
} from '@welkin/atmosphere'
import { createCity } from './globe/city'
import { GlobeNight, type NightFeatures } from './globe/GlobeNight'
import { createLand, type Land } from './globe/land'
import { worldClouds } from './globe/worldClouds'
import { PLACES } from './globe/places'
import type { PlaceName } from './globe/places'
import { applyTime } from './scene'
import type { RendererArgs, SceneHandle, TimeArgs } from './scene'

export interface GlobeArgs extends RendererArgs, TimeArgs, NightFeatures {
  place: PlaceName
  /** The world's clouds, drawn over the finished picture. */
  clouds: boolean
}

/** The city is smaller than a pixel from higher up [m]. */
const CITY_CEILING = 60_000

/** The Earth from a street to 20,000 km: pictures of all of it and terrain of one valley, in tiles, in a world that is ECEF, in metres. */
export async function createGlobe(
  canvas: HTMLCanvasElement,
  args: GlobeArgs
): Promise<SceneHandle<GlobeArgs>> {
  const addClouds = args.clouds ? await worldClouds() : undefined
  const drawn: GlobeArgs = addClouds === undefined ? args : { ...args, path: 'post' }
  const create = (land: Land) => {
    const { renderer, scene, camera, air, noise, townScale } = land
    const { atmosphere } = air
    // #region globe
    atmosphere.frame = 'ecef' // the world's axes are the Earth's, its origin the Earth's centre
    // #endregion
    const city = createCity(noise)
    scene.add(city.object)
    const weather = addClouds?.(land)
    const nightfall = () => {
      // #region globe night
      const luna = moon()
      const nightSky = [milkyWay(), stars(), luna, airglow()] as const // far before near
      atmosphere.add(...nightSky)
      const moonlight = new MoonDirectionalLight(atmosphere, luna)
      const moonlitSky = new SkyLightProbe(atmosphere, luna.source)
      const dark = new NightLightProbe(atmosphere)
      scene.add(moonlight, moonlight.target, moonlitSky, dark)
      // #endregion
      const lights = [moonlight, moonlitSky, dark] as const
      weather?.shade(lights)
      return { sky: nightSky, lights }
    }
    const night = new GlobeNight(atmosphere, nightfall, weather?.cover)
    return {
      place: ({ place }: GlobeArgs) => PLACES[place],
      prepare: () => atmosphere.bake(renderer),
      apply(current: GlobeArgs) {
        applyTime(renderer, air, current)
        night.show(current)
      },
      beforeDraw(altitude: number) {
        night.update(camera)
        const { luminanceScale } = atmosphere
        city.scale.value = luminanceScale
        if (townScale !== undefined) townScale.value = luminanceScale
        city.object.visible = altitude < CITY_CEILING
      },
      dispose() {
        weather?.dispose()
        night.dispose()
        city.dispose()
      }
    }
  }
  return createLand(canvas, drawn, 50, create, { hasTowns: true })
}

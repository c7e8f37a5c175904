import { createCity } from './globe/city'
import { createLand } from './globe/land'
import { PLACES } from './globe/places'
import type { PlaceName } from './globe/places'
import { applyTime } from './scene'
import type { RendererArgs, SceneHandle, TimeArgs } from './scene'

export interface GlobeArgs extends RendererArgs, TimeArgs {
  place: PlaceName
}

/** The city is smaller than a pixel from higher up [m]. */
const CITY_CEILING = 60_000

/** The Earth from a street to 20,000 km: pictures of all of it and terrain of one valley, in tiles, in a world that is ECEF, in metres. */
export const createGlobe = (
  canvas: HTMLCanvasElement,
  args: GlobeArgs
): Promise<SceneHandle<GlobeArgs>> =>
  createLand(canvas, args, 50, ({ renderer, scene, air, noise }) => {
    const { atmosphere } = air
    // #region globe
    atmosphere.frame = 'ecef' // the world's axes are the Earth's, its origin the Earth's centre
    // #endregion
    const city = createCity(noise)
    scene.add(city.object)
    return {
      place: ({ place }) => PLACES[place],
      apply: current => applyTime(renderer, air, current),
      beforeDraw(altitude) {
        city.object.visible = altitude < CITY_CEILING
      },
      dispose: () => city.dispose()
    }
  })

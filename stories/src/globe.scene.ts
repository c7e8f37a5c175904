import {
  airglow,
  milkyWay,
  moon,
  MoonDirectionalLight,
  NightLightProbe,
  SkyLightProbe,
  stars
} from '@welkin/atmosphere'
import type { Vector3 } from 'three'
import { renderOutput, rtt } from 'three/tsl'
import type { RenderPipeline } from 'three/webgpu'
import { createCity } from './globe/city'
import { GlobeNight, type NightFeatures } from './globe/GlobeNight'
import { createLand, type Land } from './globe/land'
import { worldClouds } from './globe/worldClouds'
import { PLACES } from './globe/places'
import type { PlaceName } from './globe/places'
import { dateOf, EXPOSURE_FRAMES } from './scene'
import type { RendererArgs, SceneHandle, TimeArgs } from './scene'
import { smoothEdges } from './valley/SmoothEdgesNode'

export interface GlobeArgs extends RendererArgs, TimeArgs, NightFeatures {
  place: PlaceName
  /** The world's clouds, drawn over the finished picture. */
  clouds: boolean
}

/** The city is smaller than a pixel from higher up [m]. */
const CITY_CEILING = 60_000

/** Glare about the moon: little, since stars and the limb are beside it. */
const GLARE = { innerStrength: 0.006, outerStrength: 0.001 }

/** Strength by which nights lose their colours: of towns, some is left, as in pictures from space stations. */
const SIGHT = 0.3

/** Frames after which a still with clouds has settled. */
const CLOUD_FRAMES = 6

/** Smooths stairs along edges of a pipeline's picture, and leaves stars as they are. */
function smoothPicture(pipeline: RenderPipeline): void {
  pipeline.outputColorTransform = false
  const shown = rtt(renderOutput(pipeline.outputNode), null, null, { depthBuffer: false })
  pipeline.outputNode = smoothEdges(shown)
}

/** The Earth from a street to 20,000 km: pictures of all of it and terrain of one valley, in tiles, in a world that is ECEF, in metres. */
export async function createGlobe(
  canvas: HTMLCanvasElement,
  args: GlobeArgs
): Promise<SceneHandle<GlobeArgs>> {
  const isPost = args.clouds || args.path === 'post'
  const addClouds = isPost ? await worldClouds(args.frame) : undefined
  const drawn: GlobeArgs = isPost ? { ...args, path: 'post' } : args
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
      // #shown const luna = moon()
      const luna = moon({ flare: GLARE }) // #hidden
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
    const exposure = air.expose(weather?.node)
    exposure.purkinjeShift = SIGHT
    if (air.post !== undefined) smoothPicture(air.post.pipeline)
    return {
      exposure,
      warmUpFrames: isPost ? CLOUD_FRAMES : EXPOSURE_FRAMES,
      place: ({ place }: GlobeArgs) => PLACES[place],
      prepare: () => atmosphere.bake(renderer),
      apply(current: GlobeArgs) {
        atmosphere.date = dateOf(current.day, current.hour)
        exposure.compensation = current.exposure
        night.show(current)
        weather?.show(current.clouds)
      },
      roofAt: (position: Vector3) => city.roofAt(position),
      beforeDraw(altitude: number) {
        night.update(camera)
        const { luminanceScale } = atmosphere
        city.scale.value = luminanceScale
        if (townScale !== undefined) townScale.value = luminanceScale
        city.object.visible = altitude < CITY_CEILING
      },
      dispose() {
        exposure.dispose()
        weather?.dispose()
        night.dispose()
        city.dispose()
      }
    }
  }
  return createLand(canvas, drawn, 50, create, { hasTowns: true })
}

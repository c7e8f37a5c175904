import {
  Atmosphere,
  aerialPerspective,
  autoExposure,
  heightFog,
  NightLightProbe,
  precipitationOverlay,
  PrecipitationShelter,
  rainfall,
  SkyLightProbe,
  snowfall,
  SunDirectionalLight,
  type AutoExposureNode,
  type Precipitation
} from '@welkin/atmosphere'
import { MathUtils, MeshStandardMaterial, PerspectiveCamera, Scene } from 'three'
import { pass } from 'three/tsl'
import { RenderPipeline } from 'three/webgpu'
import type { WebGPURenderer } from 'three/webgpu'
import { createHouses, type Houses } from './houses'

/** Settings of the street's weather. */
export interface StreetWeather {
  /** Rates of water [mm/h]. */
  readonly rain: number
  readonly snow: number
  /** Speed of the wind along and across the street [m/s]. */
  readonly wind: number
  /** Elevation of the sun [°]. */
  readonly elevation: number
  /** Time for which the shutter is open [s]. */
  readonly shutter: number
}

/** Share of sunlight and of a clear sky's light that an overcast lets through. */
const OVERCAST = { sun: 0.02, sky: 1.5 }

/** A street in rain or snow, under a deck of haze. */
export class Street {
  readonly camera = new PerspectiveCamera(50, 16 / 9, 0.1, 4000)
  readonly atmosphere = new Atmosphere()
  readonly exposure: AutoExposureNode
  readonly rain: Precipitation
  readonly snow: Precipitation
  readonly scene = new Scene()
  readonly pipeline: RenderPipeline
  readonly #sun: SunDirectionalLight
  readonly #sky: SkyLightProbe
  readonly #houses: Houses
  readonly #shelter: PrecipitationShelter
  readonly #fog = heightFog({ density: 0.0015, falloff: 900 })
  #isNight = false

  constructor(renderer: WebGPURenderer, time: number | null) {
    const { atmosphere, camera, scene } = this
    atmosphere.add(this.#fog)
    this.#sun = new SunDirectionalLight(atmosphere, 80)
    const sky = (this.#sky = new SkyLightProbe(atmosphere))
    const night = new NightLightProbe(atmosphere, 0.05)
    const ground = new MeshStandardMaterial({ color: '#4a4a48', roughness: 0.8 })
    this.#houses = createHouses(ground)
    scene.add(this.#sun, this.#sun.target, sky, night, this.#houses.object, camera)
    camera.position.set(0.6, 1.7, 4)
    camera.lookAt(-0.4, 2.6, -12)
    const scenePass = pass(scene, camera, { samples: 0 })
    const depth = scenePass.getTextureNode('depth')
    const air = aerialPerspective(scenePass.getTextureNode(), depth, camera, atmosphere)
    const shelter = (this.#shelter = new PrecipitationShelter(scene))
    // #region rain and snow
    const lights = [this.#sun, sky, night, ...this.#houses.lamps]
    const options = { lights, shelter, depth, depthCamera: camera, time }
    const rain = rainfall(atmosphere, { ...options, rate: 12 }) // mm/h
    const snow = snowfall(atmosphere, { ...options, rate: 0 })
    const picture = precipitationOverlay(air, camera, [rain, snow])
    // #endregion
    this.rain = rain
    this.snow = snow
    this.exposure = autoExposure(picture, atmosphere)
    this.pipeline = new RenderPipeline(renderer)
    this.pipeline.outputNode = this.exposure
  }

  set({ rain, snow, wind, elevation, shutter }: StreetWeather): void {
    const { atmosphere } = this
    this.rain.set({ rate: rain, shutter, wind: { east: wind, north: 0.3 * wind } })
    this.snow.set({ rate: snow, shutter, wind: { east: wind, north: 0.3 * wind } })
    atmosphere.setSunAngles(elevation, 200)
    this.#sun.intensity = OVERCAST.sun
    this.#sky.intensity = OVERCAST.sky
    this.#isNight = elevation < -3
    this.#fog.set({ density: 0.0006 + 0.0003 * rain ** 0.64 + 0.001 * snow ** 0.7 })
  }

  /** Turns the camera about its place [°]. */
  look(heading: number, pitch: number): void {
    this.camera.rotation.set(MathUtils.degToRad(pitch), -MathUtils.degToRad(heading), 0, 'YXZ')
  }

  render(): void {
    this.#houses.light(this.#isNight ? 1 : 0.15, this.atmosphere.luminanceScale)
    this.pipeline.render()
  }

  dispose(): void {
    this.pipeline.dispose()
    this.exposure.dispose()
    this.rain.dispose()
    this.snow.dispose()
    this.#shelter.dispose()
    this.#houses.dispose()
    this.#sun.dispose()
    this.atmosphere.dispose()
  }
}

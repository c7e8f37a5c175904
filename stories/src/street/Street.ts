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
  SurfaceWater,
  wetSurface,
  type AutoExposureNode,
  type Precipitation
} from '@welkin/atmosphere'
import {
  BackSide,
  HemisphereLight,
  MathUtils,
  Mesh,
  MeshBasicMaterial,
  PerspectiveCamera,
  Scene,
  SphereGeometry,
  Vector3
} from 'three'
import { pass, uniform } from 'three/tsl'
import { MeshStandardNodeMaterial, RenderPipeline } from 'three/webgpu'
import type { WebGPURenderer } from 'three/webgpu'
import type { Obstacle } from '../moving/obstacles'
import { createHouses, type Houses } from './houses'
import { StreetMirror } from './StreetMirror'

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
const OVERCAST = { sun: 0.02, sky: 0.1 }
/** Illuminance under an overcast: with the sun at the horizon, and what is added with it in the zenith [lx] (Krochmann & Seidl 1974). */
const OVERCAST_ILLUMINANCE = [300, 21_000] as const
/**
 * Luminance of clouds over a city [cd/m²], and its colour: some 10 times that of the clear sky there (Kyba et al. 2011, "Cloud coverage acts as
 * an amplifier for ecological light pollution", PLoS ONE 6, e17307), which is 8 mcd/m², 17.8 mag per square arcsecond.
 */
const TOWN_GLOW = 0.08
const TOWN_COLOR = '#ffd9b0'
/** Luminance of clouds over a town in snow [cd/m²]: Jechow & Hölker 2019, "Snowglow", J. Imaging 5(8), 69, who had 0.25 in a suburb. */
const SNOW_GLOW = 0.25
/**
 * Lamplight off the ground, by which walls above the lamps and what falls there is seen: illuminance of the street [lx], share of it that gets
 * there, and albedo of wet ground and of snow.
 */
const BOUNCE = { illuminance: 15, share: 0.15, wet: 0.1, snow: 0.8, color: '#ffc98a' }
/** Radius of the dome that shows it [m]. Greater: it is lost in the haze. */
const DOME = 190
/** Water that rain has left on the ground [mm], and snow [mm of water]. */
const FALLEN = { rain: 1.5, snow: 5 }

const _bounced = new Vector3()

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
  readonly #mirror = new StreetMirror()
  readonly #shelter: PrecipitationShelter
  readonly #fog = heightFog({ density: 0.0015, falloff: 900 })
  readonly #water: SurfaceWater
  /** Light of overcast clouds: of surfaces by `#clouds`, of what falls by the lamp. */
  readonly #overcast = new HemisphereLight()
  readonly #clouds = uniform(new Vector3())
  readonly #dome = new Mesh(
    new SphereGeometry(DOME, 16, 8),
    new MeshBasicMaterial({ side: BackSide, fog: false })
  )
  #weather: StreetWeather = { rain: 0, snow: 0, wind: 0, elevation: 25, shutter: 1 / 60 }

  constructor(renderer: WebGPURenderer, time: number | null) {
    const { atmosphere, camera, scene } = this
    atmosphere.add(this.#fog)
    const sun = (this.#sun = new SunDirectionalLight(atmosphere, 80))
    const sky = (this.#sky = new SkyLightProbe(atmosphere))
    const night = new NightLightProbe(atmosphere, 0.05)
    // #region wet ground
    const water = new SurfaceWater() // update it with the weather, or set what has fallen
    const ground = new MeshStandardNodeMaterial({ color: '#4a4a48', roughness: 0.8 })
    Object.assign(ground, wetSurface(water))
    // #endregion
    this.#water = water
    const houses = (this.#houses = createHouses(ground, water))
    ground.envNode = this.#mirror.environment(this.#clouds)
    this.#mirror.leaveOut(camera, houses.ground, ...houses.globes)
    const overcast = this.#overcast
    scene.add(sun, sun.target, sky, night, houses.object, this.#dome, camera)
    scene.environmentNode = this.#clouds
    overcast.updateMatrixWorld() // it is in no scene: what falls alone sees it
    camera.position.set(0.6, 1.7, 4)
    camera.lookAt(-0.4, 2.6, -12)
    const scenePass = pass(scene, camera, { samples: 0 })
    const depth = scenePass.getTextureNode('depth')
    const color = aerialPerspective(scenePass.getTextureNode(), depth, camera, atmosphere)
    // #region rain and snow
    const shelter = new PrecipitationShelter(scene) // dry under roofs
    // #shown const lights = [sun, sky] // and lamps, and all else that lights
    const lights = [sun, sky, night, overcast, ...houses.lamps] // #hidden
    // #shown const options = { lights, shelter, depth, depthCamera: camera }
    const options = { lights, shelter, depth, depthCamera: camera, time } // #hidden
    const rain = rainfall(atmosphere, { ...options, rate: 12 }) // mm/h
    const snow = snowfall(atmosphere, { ...options, rate: 0 })
    const picture = precipitationOverlay(color, camera, [rain, snow])
    // #shown pipeline.outputNode = picture
    // #endregion
    this.#shelter = shelter
    this.rain = rain
    this.snow = snow
    this.exposure = autoExposure(picture, atmosphere)
    this.pipeline = new RenderPipeline(renderer)
    this.pipeline.outputNode = this.exposure
  }

  set(weather: StreetWeather): void {
    const { rain, snow, wind, elevation, shutter } = (this.#weather = weather)
    const { atmosphere } = this
    this.rain.set({ rate: rain, shutter, wind: { east: wind, north: 0.3 * wind } })
    this.snow.set({ rate: snow, shutter, wind: { east: wind, north: 0.3 * wind } })
    atmosphere.setSunAngles(elevation, 200)
    this.#sun.intensity = OVERCAST.sun
    this.#sky.intensity = OVERCAST.sky
    this.#fog.set({ density: 0.0006 + 0.0003 * rain ** 0.64 + 0.001 * snow ** 0.7 })
    this.#water.water = rain > 0 ? FALLEN.rain : 0
    this.#water.snow = snow > 0 ? FALLEN.snow : 0
    this.#water.update(0, { rain, snow })
  }

  /** Light of the clouds over the street. */
  #lightClouds(): void {
    const { luminanceScale } = this.atmosphere
    const [atHorizon, more] = OVERCAST_ILLUMINANCE
    const { elevation, snow } = this.#weather
    const isNight = this.#isNight
    const sine = Math.sin(MathUtils.degToRad(elevation))
    const glow = snow > 0 ? SNOW_GLOW : TOWN_GLOW
    const luminance = isNight ? glow : (atHorizon + more * Math.max(sine, 0)) / Math.PI
    const { color, groundColor } = this.#overcast
    color.set(isNight ? TOWN_COLOR : '#ffffff').multiplyScalar(luminance * luminanceScale)
    this.#dome.material.color.copy(color)
    this.#clouds.value.setFromColor(color)
    groundColor.copy(color).multiplyScalar(0.2)
    this.#overcast.intensity = Math.PI
    if (isNight) {
      const { illuminance, share, wet, snow: white, color: lamps } = BOUNCE
      const lit = (illuminance * share * (snow > 0 ? white : wet)) / Math.PI
      groundColor.set(lamps).multiplyScalar(lit * luminanceScale)
      this.#clouds.value.add(_bounced.setFromColor(groundColor))
    }
    this.#dome.visible = isNight
  }

  get #isNight(): boolean {
    return this.#weather.elevation < -3
  }

  /** Turns the camera about its place [°]. */
  look(heading: number, pitch: number): void {
    this.camera.rotation.set(MathUtils.degToRad(pitch), -MathUtils.degToRad(heading), 0, 'YXZ')
  }

  /** Walls along the street, for those on foot. */
  get obstacles(): readonly Obstacle[] {
    return this.#houses.obstacles
  }

  render(): void {
    this.#lightClouds()
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
    this.#mirror.dispose()
    this.#dome.geometry.dispose()
    this.#dome.material.dispose()
    this.#sun.dispose()
    this.atmosphere.dispose()
  }
}

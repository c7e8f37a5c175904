import {
  airglow,
  airStyle,
  DayCycle,
  milkyWay,
  moon,
  skyEnvironment,
  stars
} from '@welkin/atmosphere'
import type { Atmosphere } from '@welkin/atmosphere'
import { cloudEnvironment, CloudLayers } from '@welkin/clouds'
import type { CloudQuality, CloudQualityName, Lightning } from '@welkin/clouds'
import { MathUtils, PerspectiveCamera, Scene, Vector3 } from 'three'
import { RenderPipeline } from 'three/webgpu'
import type { WebGPURenderer } from 'three/webgpu'
import { EYE_HEIGHT } from '../moving/Walk'
import { valleyAir, type ValleyAir } from '../valleyAir'
import { PictureFinish, type PostEffects } from './finish'
import { ValleyPrecipitation } from './falling'
import {
  applyFactors,
  type FactorTargets,
  type ValleyFactors,
  type ValleyFeatures
} from '../valleyFactors'
import { CascadeTurns } from './CascadeTurns'
import { groundHeight } from './ground'
import { LAKE, VILLAGE } from './places'
import { createLake } from './lake'
import { LakeMirror } from './LakeMirror'
import { Land } from './Land'
import { MoonShadow } from './MoonShadow'
import { StreetLamps } from './StreetLamps'
import { StepClock } from './StepClock'
import { setLit } from './litLights'
import { SkyLightMap } from './SkyLightMap'
import { shaftsQuality } from './shaftsQuality'
import { setDistant, setMapped } from './VertexLitMaterial'
import { createVillage, doors } from './village'
import { VIEWS, type ValleyName } from './views'
import { valleyFlashes } from './flashes'
import { valleyLayers, type Weather, WeatherBlend, type WeatherName } from './weather'

/** State of the valley. */
export interface ValleyState extends ValleyFeatures, PostEffects, ValleyFactors {
  /** Reflections of the screen (SSR): the lake mirrors the picture itself. */
  reflections: boolean
  weather: WeatherName
  /** Lightning in storms. */
  flashes: boolean
  /** Place on the Earth [degrees]. */
  latitude: number
  longitude: number
  /** A moment of the day, UTC [ms since 1970]. */
  date: number
  /** Solar time at which it begins [h]. */
  hour: number
  /** Length of a day on the clock [s]. */
  dayLength: number
  paused: boolean
  quality: CloudQualityName | CloudQuality
}

/** Elevations of the sun between which lamps are lit [degrees]. */
const LAMPS = [3, -2] as const

/** Steps of the air's tables that a frame bakes while the weather changes, of 28. */
const BAKE_STEPS = 3

/** Elevation of the sun over which moon and night sky light nothing that one sees: a full moon gives a hundredth of the light of dusk [degrees]. */
const NIGHT_LIGHTS = -4

/** Elevation of the sun below which it lights no mountain of the valley [degrees]. */
const SUNLIGHT = -3

/** Elevation of the sun below which the sky that it lights is darker than that of stars and airglow [degrees]. */
const TWILIGHT = -20

/** Brighter pictures of nights, or what the moon lights is black [stops], and elevation of the sun by which they are [degrees]. */
const NIGHT_COMPENSATION = 0.9
const NIGHT = -10

/** Darker pictures from above the clouds, where all that one sees is bright [EV], and heights between which they become so [m]. */
const ABOVE_COMPENSATION = -0.2
const ABOVE = [1500, 3500] as const

/** Turn of the sun after which the sky that the lake mirrors beside the picture is drawn anew [degrees]. */
const MIRRORED_TURN = 1

/** Altitude of the lake's water [m]. */
const ALTITUDE = 600

/** A valley in the mountains with all that Welkin has, at any hour and in any weather. */
export class Valley {
  readonly scene = new Scene()
  readonly camera = new PerspectiveCamera(60, 16 / 9, 0.5, 120_000)
  readonly atmosphere: Atmosphere
  readonly cycle: DayCycle
  readonly exposure
  /** Sky, light and clouds. */
  readonly air: ValleyAir
  readonly pipeline: RenderPipeline
  /** Lightning; dark unless it is asked for, which takes 0.03 ms. */
  readonly storm: Lightning
  readonly #renderer: WebGPURenderer
  readonly #state: ValleyState
  readonly #weather: WeatherBlend
  readonly #layers = new CloudLayers(valleyLayers)
  readonly #falling = new ValleyPrecipitation()
  readonly #style = airStyle()
  readonly #moon = moon()
  readonly #glows = [milkyWay(), stars(), airglow()] as const
  readonly #lamps = new StreetLamps(doors())
  readonly #land = new Land(this.#falling, this.#lamps)
  readonly #village = createVillage(groundHeight, VILLAGE, this.#lamps, this.#falling.water)
  readonly #mirror: LakeMirror
  readonly #water
  readonly #targets: FactorTargets
  readonly #cascadeTurns: CascadeTurns
  readonly #moonShadow: MoonShadow
  readonly #moonlights
  readonly #skyMap: SkyLightMap
  readonly #daySky
  readonly #nightSky
  readonly #sun
  readonly #environment
  readonly #finish: PictureFinish
  readonly #dispose: (() => void)[] = []
  #turbidity = NaN
  readonly #clock = new StepClock()

  constructor(renderer: WebGPURenderer, state: ValleyState) {
    this.#state = { ...state }
    this.#weather = new WeatherBlend(state.weather)
    const { scene, camera } = this
    const sky = [...this.#glows, this.#moon] as const
    const air = valleyAir(scene, camera, this.#layers, state.quality, sky, this.#falling)
    this.air = air
    const { atmosphere, clouds: node, shafts, exposure, flare } = air
    this.#targets = { shafts, node, sky: this.#glows, luna: this.#moon, flare, exposure }
    this.#cascadeTurns = new CascadeTurns(air.cascades)
    this.#daySky = air.daySky
    this.#nightSky = air.nightSky[1]
    const probes = [air.daySky, ...air.nightSky]
    this.#skyMap = new SkyLightMap(probes, (x, z) => this.groundAt({ x, z }))
    setMapped(probes, this.#skyMap)
    const [sun, moonlight] = air.directLights
    this.#sun = sun
    this.#moonShadow = new MoonShadow(moonlight)
    this.#moonlights = [moonlight, air.nightSky[0]] as const
    this.atmosphere = atmosphere
    const { longitude, latitude } = state
    atmosphere.place({ longitude, latitude, height: ALTITUDE })
    atmosphere.add(this.#style)
    scene.add(this.#land, this.#village.object)

    this.storm = valleyFlashes(scene, node)
    setDistant(this.storm.light)
    this.exposure = exposure
    // Coarse: the lake mirrors the picture itself where it can.
    const overlay = cloudEnvironment(node, { size: 128 })
    this.#environment = skyEnvironment(atmosphere, { overlay, angle: MIRRORED_TURN })
    this.#mirror = new LakeMirror(air.picture)
    this.#water = createLake(this.#environment, this.#mirror, air.directLights)
    scene.add(this.#water.mesh)
    this.#renderer = renderer
    this.pipeline = new RenderPipeline(renderer)
    this.#finish = new PictureFinish(renderer, this.pipeline, camera, air)
    this.cycle = new DayCycle(atmosphere, { autoExposure: exposure })
    this.#setDay(state.hour)
    this.#dispose.push(
      () => this.pipeline.dispose(),
      () => this.storm.dispose(),
      ...[this.#finish, exposure, overlay, this.#falling, this.#environment, node, shafts].map(
        each => () => each.dispose()
      ),
      () => air.dispose(),
      () => atmosphere.dispose()
    )
    this.set(state, true)
  }

  /** Weather that is shown now. */
  get weather(): Weather {
    return this.#weather.current
  }

  /** Height of the ground below a place, or of the lake [m]. */
  groundAt({ x, z }: { x: number; z: number }): number {
    return Math.max(groundHeight(x, z), LAKE.height)
  }

  /** Height of the top of the trunk at a place: −∞ beside trees [m]. */
  readonly trunkAt = (place: { x: number; z: number }): number => this.#land.trunkAt(place)

  /** Place of a view, above the ground, and direction of sight. */
  placeOf(name: ValleyName): { position: Vector3; direction: Vector3 } {
    const view = VIEWS[name]
    const position = new Vector3(...view.position)
    position.y = Math.max(position.y, this.groundAt(position) + EYE_HEIGHT)
    return { position, direction: new Vector3(...view.target).sub(position).normalize() }
  }

  /** Puts the camera at a view. */
  lookFrom(name: ValleyName): void {
    const { position, direction } = this.placeOf(name)
    this.camera.position.copy(position)
    this.camera.lookAt(position.add(direction))
  }

  /** Follows its settings: nothing but post effects is compiled anew. */
  set(changes: Partial<ValleyState>, atOnce = false): void {
    const before = { ...this.#state }
    Object.assign(this.#state, changes)
    const { weather, latitude, longitude, date, hour, paused, quality } = this.#state
    const { trees, village, water, environment, reflections } = this.#state
    this.#weather.set(weather, atOnce)
    this.cycle.paused = paused
    if (latitude !== before.latitude || longitude !== before.longitude) {
      const { hour } = this.cycle // solar: it stays
      this.atmosphere.place({ longitude, latitude, height: ALTITUDE })
      this.cycle.hour = hour
    }
    // The clock goes on from where these were set.
    if (date !== before.date) this.#setDay(this.cycle.hour)
    if (hour !== before.hour) this.cycle.hour = hour
    const fineness = typeof quality === 'string' ? quality : 'low'
    this.air.shafts.quality = shaftsQuality[fineness]
    this.#land.setQuality(fineness)
    this.#land.show(trees, village)
    applyFactors(this.#state, this.#style, this.#targets)
    // The lake alone has an environment.
    this.scene.environmentIntensity = Number(environment)
    this.#village.object.visible = village
    this.#water.mesh.visible = water
    this.#mirror.isOn = reflections
    this.#falling.wets = this.#state.wetGround
    this.#falling.drops.strength = Number(this.#state.rainbow)
    const keys = ['trees', 'village', 'water', 'quality'] as const
    if (keys.some(key => this.#state[key] !== before[key])) this.#redrawShadows()
    this.#applyWeather(atOnce)
    this.#skyMap.reset()
    this.#finish.set(this.#state)
  }

  /** Goes to an hour of the day of the date [h]. */
  #setDay(hour: number): void {
    const day = 86_400_000
    this.cycle.time = (Math.floor(this.#state.date / day) + 0.5) * day
    this.cycle.hour = hour
  }

  /** Has shadow maps and ambient occlusion drawn anew: other things cast shadows now. */
  #redrawShadows(): void {
    this.#cascadeTurns.reset()
    this.#moonShadow.reset()
    this.#finish.redrawOcclusion()
  }

  #applyWeather(atOnce = false): void {
    const { turbidity, flashes: rate } = this.#weather.current
    const { clouds, flashes, cloudShadows, precipitation, quality } = this.#state
    this.air.clouds.quality = this.#weather.qualityOf(quality, this.#state.mist)
    this.#falling.set(this.#falls(), atOnce)
    this.storm.set({ enabled: flashes && clouds && rate > 0, rate })
    this.#weather.apply(this.#layers, clouds, this.#state.mist, cloudShadows, precipitation)
    // In steps: the tables are made anew for each.
    const stepped = Math.round(turbidity * 4) / 4
    if (stepped !== this.#turbidity) this.atmosphere.parameters.set({ turbidity: stepped })
    this.#turbidity = stepped
  }

  /** Weather, dry where rain and snow are switched off. */
  #falls(): Weather {
    const { current } = this.#weather
    return this.#state.precipitation ? current : { ...current, rain: 0, snow: 0 }
  }

  /** Draws the next frame. */
  render(deltaSeconds: number): void {
    if (this.#weather.update(deltaSeconds)) this.#applyWeather()
    this.#falling.update(deltaSeconds, this.#falls())
    this.camera.updateMatrixWorld()
    if (this.#land.update(this.camera)) this.#redrawShadows()
    const exposed = this.atmosphere.luminanceScale
    const { dayLength, paused } = this.#state
    this.cycle.rate = this.#clock.rateNow(deltaSeconds, paused ? 0 : 86_400 / dayLength)
    this.cycle.update(deltaSeconds)
    if (!this.#state.autoExposure) this.atmosphere.luminanceScale = exposed // stays as it is
    const { sunDirection, luminanceScale } = this.atmosphere
    this.#cascadeTurns.update(this.camera, sunDirection, ALTITUDE + this.camera.position.y)
    // Cascades have no lights before the first frame.
    for (const { shadow } of [...this.air.cascades.lights, this.#moonlights[0]]) {
      if (shadow !== undefined) shadow.intensity = Number(this.#state.shadows)
    }
    const [from, to] = LAMPS
    const elevation = MathUtils.radToDeg(Math.asin(sunDirection.y))
    const { lamps, moonlight } = this.#state
    const dusk = MathUtils.clamp((from - elevation) / (from - to), 0, 1)
    const share = lamps ? dusk : 0
    const night = MathUtils.smoothstep(-elevation, 0, -NIGHT)
    const above = MathUtils.smoothstep(this.camera.position.y, ...ABOVE)
    const day = this.weather.exposure + above * ABOVE_COMPENSATION
    this.exposure.compensation = MathUtils.lerp(day, NIGHT_COMPENSATION, night)
    const isNight = elevation < NIGHT_LIGHTS
    const isMoonlit = this.#moonShadow.update(this.camera, isNight && moonlight)
    for (const light of this.#moonlights) setLit(light, isMoonlit)
    setLit(this.#daySky, elevation > TWILIGHT)
    setLit(this.#nightSky, isNight)
    setLit(this.#sun, elevation > SUNLIGHT)
    setLit(this.storm.light, this.storm.light.intensity > 0)
    this.#skyMap.update(this.#renderer, this.camera, luminanceScale)
    this.#village.light(share, luminanceScale)
    this.#mirror.scaleTo(luminanceScale)
    this.#finish.beforeDrawn(luminanceScale, night)
    const { autoClear } = this.#renderer
    this.#renderer.autoClear = false // every pixel of the canvas is drawn: passes before it clear for themselves
    this.pipeline.render()
    this.#finish.afterDrawn(luminanceScale)
    this.#renderer.autoClear = autoClear
    // The first tables were baked at once; those of another haze come over some frames.
    this.atmosphere.bakeStepsPerFrame = BAKE_STEPS
    if (this.#water.mesh.visible) this.#mirror.update(this.#renderer, this.camera, luminanceScale)
  }

  /** Time of the water's waves and the clouds' drift [s]. */
  set time(seconds: number) {
    this.#water.setTime(seconds)
    this.air.clouds.time = seconds
    this.#falling.time = seconds
  }

  /** Makes all that the first frame needs. */
  async bake(renderer: WebGPURenderer): Promise<void> {
    this.#mirror.prepare(renderer)
    await this.air.clouds.bake(renderer)
  }

  dispose(): void {
    for (const dispose of this.#dispose) dispose()
    this.#skyMap.dispose()
    this.#land.dispose()
    this.#village.dispose()
    this.#water.dispose()
    this.#mirror.dispose()
  }
}

import {
  Atmosphere,
  AtmosphereParameters,
  moon,
  MoonDirectionalLight,
  SkyLightProbe,
  sunFlare
} from '@welkin/atmosphere'
import type { AtmosphereParametersInit, AutoExposureNode, FlareOptions } from '@welkin/atmosphere'
import { Vector3 } from 'three'
import type { DirectionalLight, PerspectiveCamera, Scene } from 'three'
import type { WebGPURenderer } from 'three/webgpu'
import { Air } from '../air'
import type { AirPath } from '../air'

/** Flare of the sun or the moon, as sliders have it. */
export type FlareArgs<Name extends string> = Record<
  `${Name}${Capitalize<keyof FlareOptions>}`,
  number
>

/** Places of sun and moon in the sky, the moon and both flares. */
export interface LightsArgs extends FlareArgs<'sunFlare'>, FlareArgs<'moonFlare'> {
  /** Elevation of the sun [°]. */
  sunElevation: number
  /** Azimuth of the sun from north, clockwise [°]. */
  sunAzimuth: number
  /** Elevation of the moon [°]. */
  moonElevation: number
  /** Azimuth of the moon from north, clockwise [°]. */
  moonAzimuth: number
  /** 0 new, 0.5 full, 1 new. */
  moonPhase: number
  /** [km] */
  moonRadius: number
  /** [1000 km] */
  moonDistance: number
  /** Factor on the moon's light. */
  moonStrength: number
  /** [EV] */
  compensation: number
}

/** Half width of the box of shadows, and distance of the lights from its middle [m]. */
const SHADOW_SIZE = 60
const SHADOW_DISTANCE = 150

/** Suffices for a small picture [texels]. */
const FRAME_MAP_SIZE = 256

export interface SandboxSkyOptions {
  renderer: WebGPURenderer
  scene: Scene
  camera: PerspectiveCamera
  path: AirPath
  /** One reproducible frame. */
  frame: boolean
}

const direction = (elevation: number, azimuth: number): Vector3 =>
  new Vector3().setFromSphericalCoords(
    1,
    ((90 - elevation) * Math.PI) / 180,
    ((180 - azimuth) * Math.PI) / 180
  )

/** Atmosphere of the sandbox on a planet of one size, with all that shines in it. */
export class SandboxSky {
  readonly parameters: AtmosphereParameters
  readonly atmosphere: Atmosphere
  readonly exposure: AutoExposureNode
  readonly #air: Air
  readonly #scene: Scene
  readonly #isLive: boolean
  readonly #flare = sunFlare()
  readonly #moon
  readonly #moonlight: MoonDirectionalLight
  readonly #moonlitSky: SkyLightProbe

  /** @throws Error if the parameters are refused. */
  constructor(init: AtmosphereParametersInit, options: SandboxSkyOptions) {
    const { renderer, scene, camera, path, frame } = options
    this.#scene = scene
    const parameters = new AtmosphereParameters(init) // { mieScaleHeight: 3000, … }: metres, 1/m
    const atmosphere = new Atmosphere({ parameters })
    const luna = moon({ mapSize: frame ? FRAME_MAP_SIZE : 1024 })
    atmosphere.add(this.#flare, luna) // far before near
    const moonlight = new MoonDirectionalLight(atmosphere, luna, SHADOW_DISTANCE)
    const moonlitSky = new SkyLightProbe(atmosphere, luna.source)
    scene.add(moonlight, moonlight.target, moonlitSky)
    this.#isLive = !frame
    this.parameters = parameters
    this.atmosphere = atmosphere
    this.#moon = luna
    this.#moonlight = moonlight
    this.#moonlitSky = moonlitSky
    this.#air = new Air(renderer, scene, camera, path, atmosphere)
    this.exposure = this.#air.expose()
    for (const light of [this.#air.sun, moonlight]) castShadows(light)
    this.#air.sun.distance = SHADOW_DISTANCE
  }

  /** @throws Error if a value is refused. */
  apply(args: LightsArgs): void {
    this.atmosphere.setSunAngles(args.sunElevation, args.sunAzimuth)
    this.#flare.set(flareOf(args, 'sunFlare'))
    this.#moon.set({
      direction: direction(args.moonElevation, args.moonAzimuth),
      phase: args.moonPhase,
      radius: args.moonRadius * 1e3,
      distance: args.moonDistance * 1e6,
      strength: args.moonStrength
    })
    this.#moon.flare.set(flareOf(args, 'moonFlare'))
    this.exposure.compensation = args.compensation
  }

  render(): void {
    this.#air.render()
    // The first bake was at once, not to begin with a black sky.
    if (this.#isLive) this.atmosphere.bakeStepsPerFrame = 5
  }

  dispose(): void {
    this.#scene.remove(this.#moonlight, this.#moonlight.target, this.#moonlitSky)
    this.#moonlight.dispose()
    this.#moonlitSky.dispose()
    this.exposure.dispose()
    this.#air.dispose()
  }
}

function flareOf(args: LightsArgs, name: 'sunFlare' | 'moonFlare'): Required<FlareOptions> {
  return {
    innerPower: args[`${name}InnerPower`],
    innerStrength: args[`${name}InnerStrength`],
    outerPower: args[`${name}OuterPower`],
    outerStrength: args[`${name}OuterStrength`]
  }
}

function castShadows(light: DirectionalLight): void {
  const { camera, mapSize } = light.shadow
  light.castShadow = true
  mapSize.setScalar(2048)
  camera.left = camera.bottom = -SHADOW_SIZE
  camera.right = camera.top = SHADOW_SIZE
  camera.far = 2 * SHADOW_DISTANCE
  light.shadow.normalBias = 0.06
}

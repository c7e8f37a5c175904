import {
  airglow,
  aerialPerspective,
  Atmosphere,
  autoExposure,
  droplets,
  heightFog,
  iceCrystals,
  lightShafts,
  marsParameters,
  milkyWay,
  moon,
  MoonDirectionalLight,
  NightLightProbe,
  planetGround,
  raindrops,
  SkyLightProbe,
  standardEarthParameters,
  stars,
  SunDirectionalLight,
  sunFlare,
  type AutoExposureNode,
  type LightShafts
} from '@welkin/atmosphere'
import {
  cloudAirShadow,
  cloudPreset,
  clouds,
  DropletLightTable,
  cloudShadow,
  lightning,
  cloudSkyLight,
  precipitationShafts,
  type CloudLayers,
  type CloudQuality,
  type CloudQualityName,
  type CloudsNode,
  type Lightning,
  type PrecipitationShafts
} from '@welkin/clouds'
import { Ellipsoid } from '@welkin/geo'
import { MathUtils, PerspectiveCamera, RenderTarget, Scene, Vector3 } from 'three'
import { pass, shadow } from 'three/tsl'
import { RenderPipeline, type Node, type WebGPURenderer } from 'three/webgpu'
import { Landscape } from './landscape'
import type { Still } from './scenes'
import { meadow, redDust, snow } from './soil'
import { readPicture } from './readPicture'

/** Vertical field of view [°]. */
const FIELD_OF_VIEW = 55
/** Distance of the sun from its target: its shadows begin there [m]. */
const LIGHT_DISTANCE = 20_000
/** Half width of the hills' shadow map [m]. */
const SHADOW_EXTENT = 6000
/** Clouds have drifted for so long [s]. */
const TIME = 300

function atmosphereOf({ planet, place, sun, turbidity }: Still): Atmosphere {
  const atmosphere =
    planet === 'mars' ? marsBody() : new Atmosphere({ parameters: standardEarthParameters() })
  if (turbidity !== undefined) atmosphere.parameters.set({ turbidity })
  atmosphere.place(place ?? { longitude: 139.77, latitude: 35.68 })
  if (sun instanceof Date) atmosphere.date = sun
  else atmosphere.setSunAngles(sun.elevation, sun.azimuth)
  return atmosphere
}

function marsBody(): Atmosphere {
  const parameters = marsParameters()
  const radius = parameters.bottomRadius
  return new Atmosphere({ parameters, ellipsoid: new Ellipsoid(radius, radius) })
}

function sunOf(atmosphere: Atmosphere): SunDirectionalLight {
  const sun = new SunDirectionalLight(atmosphere, LIGHT_DISTANCE)
  sun.castShadow = true
  sun.shadow.mapSize.setScalar(4096)
  const { camera } = sun.shadow
  camera.left = camera.bottom = -SHADOW_EXTENT
  camera.right = camera.top = SHADOW_EXTENT
  camera.far = 3 * LIGHT_DISTANCE
  sun.shadow.normalBias = 20
  return sun
}

function cameraOf({ altitude, view, land }: Still, aspect: number): PerspectiveCamera {
  const isFar = land === 'planet'
  const camera = new PerspectiveCamera(FIELD_OF_VIEW, aspect, isFar ? 2000 : 1, isFar ? 2e7 : 4e5)
  camera.position.y = altitude
  camera.rotation.order = 'YXZ'
  camera.rotation.x = MathUtils.degToRad(view.pitch)
  camera.rotation.y = -MathUtils.degToRad(view.azimuth)
  camera.updateMatrixWorld()
  return camera
}

/** Rain with its bows and snow under layers that have any. */
function fallOf(layers: CloudLayers): PrecipitationShafts | undefined {
  const rate = Math.max(...[...layers].map(layer => layer.precipitation?.rate ?? 0))
  return rate > 0
    ? precipitationShafts({ drops: raindrops({ rate: Math.max(rate, 0.5) }) })
    : undefined
}

/** Time over which a picture gathers a flash's light [s]. */
const EXPOSURE = 0.5

/** A flash that stays in the picture: time stands still at its end. */
function flashOf(
  node: CloudsNode,
  { kind, azimuth, distance }: NonNullable<Still['lightning']>
): Lightning {
  const storm = lightning(node, { limit: null, exposure: EXPOSURE, time: TIME })
  const angle = MathUtils.degToRad(azimuth)
  const at = new Vector3(Math.sin(angle), 0, -Math.cos(angle)).multiplyScalar(distance)
  storm.addEventListener('strike', () => {
    storm.time = TIME + EXPOSURE
  })
  storm.strike({ kind, at })
  return storm
}

/** A still's scene, drawn as an app would draw it: a pass, the air, the clouds. */
export class StillView {
  readonly #renderer: WebGPURenderer
  readonly #target: RenderTarget
  readonly #pipeline: RenderPipeline
  readonly #atmosphere: Atmosphere
  readonly #sun: SunDirectionalLight
  readonly #landscape: Landscape | undefined
  readonly #shafts: LightShafts | undefined
  readonly #clouds: CloudsNode | undefined
  readonly #lightning: Lightning | undefined
  readonly #exposure: AutoExposureNode

  constructor(
    renderer: WebGPURenderer,
    still: Still,
    [width, height]: readonly [number, number],
    quality: CloudQualityName | CloudQuality
  ) {
    this.#renderer = renderer
    this.#target = new RenderTarget(width, height)
    const atmosphere = (this.#atmosphere = atmosphereOf(still))
    const camera = cameraOf(still, width / height)
    const scene = new Scene()
    const sun = (this.#sun = sunOf(atmosphere))
    const sky = new SkyLightProbe(atmosphere)
    scene.add(sun, sun.target, sky)
    // Continents and seas are the Earth's alone.
    if (still.planet === undefined) atmosphere.add(planetGround())
    if (still.sun instanceof Date) this.#addNight(scene)
    else atmosphere.add(sunFlare())
    if (still.land !== 'planet') {
      const isMars = still.planet === 'mars'
      const soil = isMars ? redDust : still.land === 'snow' ? snow : meadow
      const radius = atmosphere.parameters.bottomRadius
      this.#landscape = new Landscape(radius, soil, !isMars)
      scene.add(this.#landscape)
    }

    if (still.fog !== undefined) {
      const { dropletRadius: radius, ...fog } = still.fog
      const drops = radius === undefined ? null : droplets({ radius })
      atmosphere.add(heightFog({ ...fog, droplets: drops }))
    }
    if (still.rain !== undefined) {
      const rain = raindrops({ rate: still.rain })
      atmosphere.add(heightFog({ density: rain.extinction, falloff: 250, droplets: rain }))
    }
    const scenePass = pass(scene, camera, { samples: 0 })
    const depth = scenePass.getTextureNode('depth')
    const shafts = still.shafts && lightShafts(atmosphere, camera, sun)
    this.#shafts = shafts
    const air = aerialPerspective(scenePass.getTextureNode(), depth, camera, atmosphere, { shafts })
    let picture: Node = air
    if (still.clouds !== undefined) {
      const { preset, coverage, precipitation: falls } = still.clouds
      const layers = cloudPreset(preset)
      if (falls !== undefined) layers.at(0).set({ precipitation: falls })
      if (coverage !== undefined) layers.at(0).set({ coverage })
      const { dropletRadius } = still
      const light =
        dropletRadius === undefined
          ? undefined
          : new DropletLightTable({ dropletRadius, crystals: iceCrystals() })
      const node = clouds(air, depth, camera, atmosphere, layers, {
        quality,
        light,
        precipitation: fallOf(layers)
      })
      Object.assign(sun.shadow, { shadowNode: cloudShadow(node, shadow(sun)) })
      cloudSkyLight(sky, node)
      shafts?.add(cloudAirShadow(node))
      node.field.bake(renderer)
      node.time = TIME
      if (still.lightning !== undefined) {
        this.#lightning = flashOf(node, still.lightning)
        scene.add(this.#lightning.light)
      }
      this.#clouds = node
      picture = node
    }
    this.#exposure = autoExposure(picture, atmosphere)
    this.#pipeline = new RenderPipeline(renderer)
    this.#pipeline.outputNode = this.#exposure
  }

  /** Luminance that it is exposed for [cd/m²]. */
  get luminance(): number {
    return this.#exposure.luminance ?? NaN
  }

  /** Exposes the next picture as the last one asks for. */
  async expose(): Promise<void> {
    await this.#exposure.settle()
  }

  draw(): void {
    this.#renderer.setRenderTarget(this.#target)
    this.#pipeline.render()
    this.#renderer.setRenderTarget(null)
  }

  /** Picture of the canvas as a viewer sees it, RGBA, rows top-down. */
  picture(): Promise<Uint8Array> {
    return readPicture(this.#renderer, this.#target)
  }

  dispose(): void {
    this.#pipeline.dispose()
    this.#exposure.dispose()
    this.#lightning?.dispose()
    this.#clouds?.dispose()
    this.#landscape?.dispose()
    this.#shafts?.dispose()
    this.#sun.dispose()
    this.#atmosphere.dispose()
    this.#target.dispose()
  }

  #addNight(scene: Scene): void {
    const atmosphere = this.#atmosphere
    const luna = moon()
    atmosphere.add(milkyWay(), stars(), luna, airglow())
    const moonlight = new MoonDirectionalLight(atmosphere, luna, LIGHT_DISTANCE)
    const moonSky = new SkyLightProbe(atmosphere, luna.source)
    scene.add(moonlight, moonlight.target, moonSky, new NightLightProbe(atmosphere))
  }
}

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
import { pass } from 'three/tsl'
import { RenderPipeline, type Node, type WebGPURenderer } from 'three/webgpu'
import { createNoiseTexture } from '../../stories/src/globe/detailNoise'
import { createCity, type City } from '../../stories/src/globe/city'
import { cloudReference, REFERENCE_SKIPPING } from '../bench/clouds'
import { Landscape } from '../../stories/src/hills/Landscape'
import { aeroplaneShadow } from '../../stories/src/shafts/aeroplaneShadow'
import { castLandShadow, landShadow, LIGHT_DISTANCE } from '../../stories/src/shafts/landShadow'
import { Ridge } from '../../stories/src/shafts/Ridge'
import type { Still } from './Still'
import { meadow, redDust, snow } from '../../stories/src/hills/soil'
import { finish } from './finish'
import { readPicture } from './readPicture'

/** Vertical field of view by default [°]. */
const FIELD_OF_VIEW = 55
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

/** Direction in the Y-up frame on the ground, north along −z. */
const directionOf = ({ elevation, azimuth }: { elevation: number; azimuth: number }): Vector3 =>
  new Vector3().setFromSphericalCoords(
    1,
    MathUtils.degToRad(90 - elevation),
    MathUtils.degToRad(180 - azimuth)
  )

function cameraOf({ altitude, view, fieldOfView, land }: Still, aspect: number): PerspectiveCamera {
  const isFar = land === 'planet'
  const camera = new PerspectiveCamera(
    fieldOfView ?? FIELD_OF_VIEW,
    aspect,
    isFar ? 2000 : 1,
    isFar ? 2e7 : 4e5
  )
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
  return rate > 0 ? precipitationShafts({ drops: raindrops({ rate }) }) : undefined
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

/** A still's scene, drawn as an app would draw it: a pass, the air, the clouds, the finish. */
export class StillView {
  readonly #renderer: WebGPURenderer
  readonly #target: RenderTarget
  readonly #pipeline: RenderPipeline
  readonly #atmosphere: Atmosphere
  readonly #sun: SunDirectionalLight
  readonly #landscape: Landscape | Ridge | undefined
  readonly #city: City | undefined
  readonly #shafts: LightShafts | undefined
  readonly #clouds: CloudsNode | undefined
  readonly #lightning: Lightning | undefined
  readonly #exposure: AutoExposureNode
  /** Picture whose edges are smoothed. */
  readonly #shown: { dispose(): void }

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
    const sun = (this.#sun = castLandShadow(new SunDirectionalLight(atmosphere), still.land))
    const sky = new SkyLightProbe(atmosphere)
    scene.add(sun, sun.target, sky)
    const isNight = still.sun instanceof Date || still.moon !== undefined
    const moonlight = isNight ? this.#addNight(scene, still.moon) : undefined
    const key = still.moon === undefined ? sun : moonlight!
    // Continents and seas are the Earth's alone.
    if (still.planet === undefined) atmosphere.add(planetGround())
    if (!isNight) atmosphere.add(sunFlare())
    if (still.land === 'city') {
      this.#city = createCity(createNoiseTexture())
      const { object } = this.#city
      object.position.setScalar(0)
      object.quaternion.identity()
      scene.add(object)
    } else if (still.land !== 'planet') {
      const isMars = still.planet === 'mars'
      const soil = isMars ? redDust : still.land === 'snow' ? snow : meadow
      const radius = atmosphere.parameters.bottomRadius
      this.#landscape =
        still.land === 'ridge' ? new Ridge(radius) : new Landscape(renderer, radius, soil)
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
    const shafts = still.shafts && lightShafts(atmosphere, camera, key)
    this.#shafts = shafts
    const air = aerialPerspective(scenePass.getTextureNode(), depth, camera, atmosphere, { shafts })
    let picture: Node = air
    if (still.clouds !== undefined) {
      const { preset, coverage, precipitation: falls, layer } = still.clouds
      const layers = cloudPreset(preset)
      if (falls !== undefined) layers.at(0).set({ precipitation: falls })
      if (coverage !== undefined) layers.at(0).set({ coverage })
      if (layer !== undefined) layers.at(0).set(layer)
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
      const source = still.moon && moonlight?.source
      Object.assign(key.shadow, {
        shadowNode: cloudShadow(
          node,
          landShadow(key, still.land === 'hills' || still.land === 'snow'),
          source
        )
      })
      cloudSkyLight(sky, node)
      shafts?.add(cloudAirShadow(node))
      if (still.aeroplane) shafts?.add(aeroplaneShadow())
      node.field.bake(renderer)
      if (quality === cloudReference) node.field.skipping.value = REFERENCE_SKIPPING
      node.time = TIME
      if (still.lightning !== undefined) {
        this.#lightning = flashOf(node, still.lightning)
        scene.add(this.#lightning.light)
      }
      this.#clouds = node
      picture = node
    }
    this.#exposure = autoExposure(picture, atmosphere, { compensation: still.compensation })
    this.#pipeline = new RenderPipeline(renderer)
    this.#shown = finish(this.#pipeline, this.#exposure)
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
    this.#shown.dispose()
    this.#exposure.dispose()
    this.#lightning?.dispose()
    this.#clouds?.dispose()
    this.#landscape?.dispose()
    this.#city?.dispose()
    this.#shafts?.dispose()
    this.#sun.dispose()
    this.#atmosphere.dispose()
    this.#target.dispose()
  }

  /** Moon and stars of the atmosphere's date, or a full moon that stands elsewhere. */
  #addNight(scene: Scene, at: Still['moon']): MoonDirectionalLight {
    const atmosphere = this.#atmosphere
    const luna = at === undefined ? moon() : moon({ direction: directionOf(at), phase: 0.5 })
    atmosphere.add(milkyWay(), stars(), luna, airglow())
    const moonlight = new MoonDirectionalLight(atmosphere, luna, LIGHT_DISTANCE)
    if (at !== undefined) castLandShadow(moonlight, 'hills')
    const moonSky = new SkyLightProbe(atmosphere, luna.source)
    scene.add(moonlight, moonlight.target, moonSky, new NightLightProbe(atmosphere))
    return moonlight
  }
}

import {
  aerialPerspective,
  autoExposure,
  heightFog,
  lightShafts,
  moon,
  MoonDirectionalLight,
  NightLightProbe,
  planetGround,
  SkyLightProbe,
  sunFlare
} from '@welkin/atmosphere'
import type { Atmosphere } from '@welkin/atmosphere'
import { cloudAirShadow, cloudPreset, clouds, cloudShadow, cloudSkyLight } from '@welkin/clouds'
import type { CloudsNode } from '@welkin/clouds'
import { MathUtils, PerspectiveCamera, Scene } from 'three'
import type { Object3D, Vector3 } from 'three'
import type { Node, WebGPURenderer } from 'three/webgpu'
import { Air } from './air'
import { STILL_QUALITY } from './clouds/still'
import { createCity } from './globe/city'
import { createNoiseTexture } from './globe/detailNoise'
import { hillHeight } from './hills/hillHeight'
import { Landscape } from './hills/Landscape'
import { meadow } from './hills/soil'
import { Explorer } from './moving/Explorer'
import { createRenderer, drawSettled, exposureOf, frameClock } from './scene'
import type { RendererArgs, SceneHandle } from './scene'
import { castLandShadow, landShadow, LIGHT_DISTANCE } from './shafts/landShadow'
import { Ridge, ridgeHeight } from './shafts/Ridge'
import { shaftViews, type ShaftView } from './shafts/views'
import { storyHandle } from './storyHandle'

export interface LightShaftsArgs extends RendererArgs {
  view: keyof typeof shaftViews
  /** Part of the light that shadowed air loses; 1 is physical, 0 has no shafts. */
  strength: number
  /** Aerosol of the air: 1 is clear, 6 thick haze. */
  turbidity: number
  /** Elevation of the sun, or of the moon by night [degrees]. */
  elevation: number
  /** Its azimuth, clockwise from north [degrees]. */
  azimuth: number
  /** [stops], 0 as the picture asks for. */
  exposure: number
}

/** Time of the clouds' drift: there are gaps in the views then [s]. */
const TIME = 300

/** Frames after which a still has settled. */
const FRAMES = 4

/** Hills, a ridge or a city about the camera, if a view has any, in a Y-up frame on the ground. */
function landOf(
  renderer: WebGPURenderer,
  { land }: ShaftView,
  { parameters }: Atmosphere
): { object: Object3D; dispose: () => void } | undefined {
  if (land === 'planet') return undefined
  if (land === 'hills' || land === 'ridge') {
    const radius = parameters.bottomRadius
    const object = land === 'ridge' ? new Ridge(radius) : new Landscape(renderer, radius, meadow)
    return { object, dispose: () => object.dispose() }
  }
  const city = createCity(createNoiseTexture())
  city.object.position.setScalar(0)
  city.object.quaternion.identity()
  return city
}

/** Height of the ground below a place [m]: streets and seas are level. */
const groundBelow =
  ({ land }: ShaftView) =>
  ({ x, z }: Vector3): number =>
    land === 'ridge' ? ridgeHeight(x, z) : land === 'hills' ? hillHeight(x, z) : 0

function cameraOf({ altitude, view, land }: ShaftView): PerspectiveCamera {
  const camera = new PerspectiveCamera(55, 1, 1, land === 'planet' ? 2e7 : 4e5)
  camera.position.y = altitude
  const [pitch, turn] = [view.pitch, -view.azimuth].map(MathUtils.degToRad)
  camera.rotation.set(pitch, turn, 0, 'YXZ')
  camera.updateMatrixWorld()
  return camera
}

/** Shadows in the air: of ridges, towers and clouds, in sunlight and moonlight. */
export async function createLightShafts(
  canvas: HTMLCanvasElement,
  args: LightShaftsArgs
): Promise<SceneHandle<LightShaftsArgs>> {
  const view: ShaftView = shaftViews[args.view]
  const renderer = await createRenderer(canvas, args.forceWebGL, false, true)
  const scene = new Scene()
  const camera = cameraOf(view)
  const explorer = args.frame
    ? undefined
    : new Explorer(camera, canvas, { groundAt: groundBelow(view) })
  const elapsed = frameClock(args.frame)
  const current = { ...args }
  const air = new Air(renderer, scene, camera, 'post')
  const { atmosphere, sun, sky } = air
  const { pipeline, picture, depth } = air.post!
  atmosphere.place(view.place ?? { longitude: 139.77, latitude: 35.68 })
  atmosphere.add(planetGround(), sunFlare())
  castLandShadow(sun, view.land)
  if (view.fog !== undefined) atmosphere.add(heightFog(view.fog))
  const luna = moon()
  const moonlight = new MoonDirectionalLight(atmosphere, luna, LIGHT_DISTANCE)
  if (view.isMoonlit) {
    atmosphere.add(luna)
    castLandShadow(moonlight, view.land)
    const moonSky = new SkyLightProbe(atmosphere, luna.source)
    scene.add(moonlight, moonlight.target, moonSky, new NightLightProbe(atmosphere))
  }
  const land = landOf(renderer, view, atmosphere)
  if (land !== undefined) scene.add(land.object)

  const light = view.isMoonlit ? moonlight : sun
  // #region light shafts
  // #shown const picture = scenePass.getTextureNode() // without its air
  // #shown const light = sun // or a moon's
  const shafts = lightShafts(atmosphere, camera, light)
  const lit = aerialPerspective(picture, depth, camera, atmosphere, { shafts })
  // #endregion
  let color: Node = lit
  let node: CloudsNode | undefined
  if (view.clouds !== undefined) {
    const { preset, coverage } = view.clouds
    // #region shafts of clouds
    // #shown const preset = 'stratocumulus'
    const layers = cloudPreset(preset)
    const deck = clouds(lit, depth, camera, atmosphere, layers)
    // #shown import { shadow } from 'three/tsl'
    // #shown const onLand = shadow(light)
    const onLand = landShadow(light, view.land === 'hills') // #hidden
    const shadows = cloudShadow(deck, onLand, light.source)
    Object.assign(light.shadow, { shadowNode: shadows }) // clouds shade the land
    cloudSkyLight(sky, deck)
    shafts.add(cloudAirShadow(deck)) // and the air
    // #endregion
    node = deck
    if (coverage !== undefined) layers.at(0).set({ coverage })
    if (args.frame) node.quality = STILL_QUALITY
    node.field.bake(renderer)
    node.time = TIME
    color = node
  }
  // #region exposure under clouds
  const exposed = autoExposure(color, atmosphere) // as bright as the picture is
  pipeline.outputNode = exposed
  // #endregion

  const apply = (): void => {
    const { strength, turbidity, elevation, azimuth, exposure } = current
    shafts.strength = strength
    atmosphere.parameters.set({ turbidity })
    const direction = atmosphere.setSunAngles(elevation, azimuth).sunDirection
    if (view.isMoonlit) {
      luna.set({ direction, phase: 0.5 })
      atmosphere.setSunAngles(-40, azimuth + 180)
    }
    renderer.toneMappingExposure = exposureOf(exposure)
  }
  apply()

  const draw = (): void => {
    explorer?.update(elapsed())
    air.render()
  }
  return storyHandle({
    renderer,
    scene,
    camera,
    explorer,
    current,
    apply,
    draw,
    warmUp: () => drawSettled(current.frame ? FRAMES : 0, draw, () => exposed),
    dispose() {
      land?.dispose()
      node?.dispose()
      exposed.dispose()
      shafts.dispose()
      moonlight.dispose()
      air.dispose()
    }
  })
}

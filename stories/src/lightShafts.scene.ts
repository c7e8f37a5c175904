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
import { FLIGHT_SECONDS, travel } from './moving/travel'
import { ViewChange } from './moving/ViewChange'
import { createRenderer, drawSettled, exposureOf, frameClock } from './scene'
import type { RendererArgs, SceneHandle } from './scene'
import { castLandShadow, landShadow, LIGHT_DISTANCE } from './shafts/landShadow'
import { Ridge, ridgeHeight } from './shafts/Ridge'
import { argsOf, shaftViews, type ShaftView } from './shafts/views'
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
): { object: Object3D; roofAt?: (place: Vector3) => number; dispose: () => void } | undefined {
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

/** Step of the turbidity on the way to another view: the air's tables are made anew for each. */
const TURBIDITY_STEP = 0.25

/** Shadows in the air: of ridges, towers and clouds, in sunlight and moonlight; for views with the same land, clouds and light. */
export async function createLightShafts(
  canvas: HTMLCanvasElement,
  args: LightShaftsArgs
): Promise<SceneHandle<LightShaftsArgs>> {
  const view: ShaftView = shaftViews[args.view]
  const renderer = await createRenderer(canvas, args.forceWebGL, false, true)
  const scene = new Scene()
  const current = { ...args }
  const camera = new PerspectiveCamera(55, 1, 1, view.land === 'planet' ? 2e7 : 4e5)
  const placeCamera = (moved: PerspectiveCamera): void => {
    const { altitude, view: sight }: ShaftView = shaftViews[current.view]
    const [pitch, turn] = [sight.pitch, -sight.azimuth].map(MathUtils.degToRad)
    moved.position.set(0, altitude, 0)
    moved.rotation.set(pitch, turn, 0, 'YXZ')
  }
  travel(undefined, camera, placeCamera, 0)
  const explorer = args.frame
    ? undefined
    : new Explorer(camera, canvas, {
        groundAt: groundBelow(view),
        footingAt: place => groundBelow(view)(place) + Math.max(land?.roofAt?.(place) ?? 0, 0)
      })
  const elapsed = frameClock(args.frame)
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
    if (args.frame) {
      node.quality = STILL_QUALITY
      node.field.bake(renderer)
    }
    node.time = TIME
    color = node
  }
  // #region exposure under clouds
  const exposed = autoExposure(color, atmosphere) // as bright as the picture is
  pipeline.outputNode = exposed
  // #endregion

  const numbers = () => {
    const { strength, turbidity, elevation, azimuth, exposure } = current
    return { strength, turbidity, elevation, azimuth, exposure }
  }
  const change = new ViewChange(current.view, numbers())
  /** Shows the change of views as far as it has come. */
  const show = (): void => {
    const { strength, turbidity, elevation, azimuth, exposure } = change.numbers
    shafts.strength = strength
    const isThere = turbidity === current.turbidity
    const stepped = Math.round(turbidity / TURBIDITY_STEP) * TURBIDITY_STEP
    atmosphere.parameters.set({ turbidity: isThere ? turbidity : stepped })
    const direction = atmosphere.setSunAngles(elevation, azimuth).sunDirection
    if (view.isMoonlit) {
      luna.set({ direction, phase: 0.5 })
      atmosphere.setSunAngles(-40, azimuth + 180)
    }
    renderer.toneMappingExposure = exposureOf(exposure)
  }
  show()

  const draw = (): void => {
    const seconds = elapsed()
    explorer?.update(seconds)
    if (change.update(seconds)) show()
    air.render()
  }
  const handle = storyHandle({
    renderer,
    scene,
    camera,
    explorer,
    current,
    apply(before) {
      const isView = before.view !== current.view
      if (isView) {
        const own = argsOf(current.view)
        Object.assign(current, own)
        handle.onArgs?.(own)
        travel(explorer, camera, placeCamera, FLIGHT_SECONDS)
        change.go(current.view, numbers(), explorer ? FLIGHT_SECONDS : 0)
      } else change.set(numbers())
      show()
    },
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
  return handle
}

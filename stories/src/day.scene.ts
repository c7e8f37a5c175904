import {
  airglow,
  Atmosphere,
  DayCycle,
  milkyWay,
  moon,
  MoonDirectionalLight,
  NightLightProbe,
  SkyLightProbe,
  standardEarthParameters,
  stars
} from '@welkin/atmosphere'
import {
  BoxGeometry,
  CircleGeometry,
  Mesh,
  MeshStandardMaterial,
  PerspectiveCamera,
  Scene,
  SphereGeometry
} from 'three'
import { Air } from './air'
import { Explorer } from './moving/Explorer'
import { createRenderer, disposeMeshes, drawSettled, EXPOSURE_FRAMES, frameClock } from './scene'
import type { RendererArgs, SceneHandle } from './scene'
import { ShownHour } from './ShownHour'
import { storyHandle } from './storyHandle'

export interface DayArgs extends RendererArgs {
  /** [degrees] */
  latitude: number
  /** Part of the year since the equinox of March. */
  season: number
  /** Solar time at which it begins, and stays in a single frame [h]. */
  hour: number
  /** Length of a day and night on the clock [s]. */
  dayLength: number
  /** Part of it between 6 and 18 h. */
  daylight: number
  paused: boolean
}

/** A day and a night in a minute: sun, moon, stars and exposure, from one clock. */
export async function createDay(
  canvas: HTMLCanvasElement,
  args: DayArgs
): Promise<SceneHandle<DayArgs>> {
  const renderer = await createRenderer(canvas, args.forceWebGL)
  const scene = new Scene()
  const camera = new PerspectiveCamera(65, 1, 0.1, 30_000)
  camera.position.set(-14, 2.5, 0)
  camera.lookAt(0, 6.35, 0)
  const explorer = args.frame ? undefined : new Explorer(camera, canvas)
  const current = { ...args }

  const material = new MeshStandardMaterial({ color: '#8f8a7c', roughness: 0.95 })
  const ground = new Mesh(new CircleGeometry(15_000, 96).rotateX(-Math.PI / 2), material)
  const ball = new Mesh(new SphereGeometry(1.6, 48, 32), material)
  ball.position.set(-2, 1.6, -4)
  const tower = new Mesh(new BoxGeometry(3, 9, 3), material)
  tower.position.set(6, 4.5, 6)
  const meshes = [ground, ball, tower]
  for (const mesh of meshes) mesh.castShadow = mesh.receiveShadow = true
  scene.add(...meshes)

  // #region day
  // #shown // new Atmosphere({ parameters: standardEarthParameters() }) has twilight as it is
  const atmosphere = new Atmosphere({ parameters: standardEarthParameters() }) // #hidden
  const luna = moon()
  atmosphere.add(milkyWay(), stars(), luna, airglow()) // far before near
  const moonlight = new MoonDirectionalLight(atmosphere, luna, 50) // 50 m from its target
  const moonlitSky = new SkyLightProbe(atmosphere, luna.source)
  const night = new NightLightProbe(atmosphere)
  moonlight.castShadow = true
  scene.add(moonlight, moonlight.target, moonlitSky, night)
  // #endregion
  const air = new Air(renderer, scene, camera, args.path, atmosphere)
  const exposure = air.expose()
  // #region cycle
  // #shown import { autoExposure } from '@welkin/atmosphere'
  // #shown import { pass } from 'three/tsl'
  // #shown import { RenderPipeline } from 'three/webgpu'
  // #shown const exposure = autoExposure(pass(scene, camera), atmosphere)
  // #shown const pipeline = new RenderPipeline(renderer)
  // #shown pipeline.outputNode = exposure
  const cycle = new DayCycle(atmosphere, {
    rate: 1440, // a day in a minute
    autoExposure: exposure
  })
  // #endregion
  air.sun.castShadow = true
  air.sun.distance = 50
  for (const { shadow } of [air.sun, moonlight]) {
    shadow.camera.left = shadow.camera.bottom = -25
    shadow.camera.right = shadow.camera.top = 25
    shadow.camera.far = 150
    shadow.normalBias = 0.03
  }

  const shownHour = new ShownHour(current.hour)
  const apply = (before: DayArgs): void => {
    const { dayLength, daylight, paused, frame, latitude, season, hour } = current
    cycle.rate = 86_400 / dayLength
    cycle.daylight = daylight
    cycle.paused = paused || frame
    cycle.latitude = latitude
    // The clock goes on from where these were set.
    if (season !== before.season) cycle.season = season
    if (shownHour.take(hour, before.hour)) cycle.hour = hour
  }
  atmosphere.place({ longitude: 0, latitude: current.latitude })
  cycle.time = Date.UTC(2026, 2, 21, 12)
  cycle.season = current.season
  cycle.hour = current.hour
  apply(current)

  const elapsed = frameClock(args.frame)
  const draw = (): void => {
    const deltaSeconds = elapsed()
    explorer?.update(deltaSeconds)
    camera.updateMatrixWorld()
    // #region each frame
    cycle.update(deltaSeconds) // moves sun, moon and stars, and exposure with them
    // #endregion
    air.render()
    const hour = cycle.paused ? undefined : shownHour.next(cycle.hour)
    if (hour !== undefined) handle.onArgs?.({ hour })
  }

  const handle = storyHandle({
    renderer,
    scene,
    camera,
    explorer,
    current,
    apply,
    draw,
    async warmUp() {
      if (current.frame) await drawSettled(EXPOSURE_FRAMES, draw, () => exposure)
    },
    dispose() {
      for (const light of [moonlight, moonlitSky, night]) light.dispose()
      exposure.dispose()
      air.dispose()
      disposeMeshes(meshes)
    }
  })
  return handle
}

import {
  aerialPerspectiveFog,
  airglow,
  Atmosphere,
  DayCycle,
  milkyWay,
  NightLightProbe,
  skyBackground,
  SkyLightProbe,
  stars,
  SunDirectionalLight
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
import { OrbitControls } from 'three/addons/controls/OrbitControls.js'
import { createRenderer, WARM_UP_FRAMES } from './scene'
import type { RendererArgs, SceneHandle } from './scene'

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

/** A day and a night in a minute: sun, stars and exposure, from one clock. */
export async function createDay(
  canvas: HTMLCanvasElement,
  args: DayArgs
): Promise<SceneHandle<DayArgs>> {
  const renderer = await createRenderer(canvas, args.forceWebGL)
  const scene = new Scene()
  const camera = new PerspectiveCamera(65, 1, 0.1, 30_000)
  camera.position.set(-14, 2.5, 0)
  const controls = new OrbitControls(camera, args.frame ? null : canvas)
  controls.target.set(0, 6.35, 0)
  controls.update()
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

  const atmosphere = new Atmosphere()
  atmosphere.add(milkyWay(), stars(), airglow())
  scene.backgroundNode = skyBackground(atmosphere)
  scene.fogNode = aerialPerspectiveFog(atmosphere)
  const sun = new SunDirectionalLight(atmosphere, 60)
  sun.castShadow = true
  sun.shadow.camera.left = sun.shadow.camera.bottom = -25
  sun.shadow.camera.right = sun.shadow.camera.top = 25
  sun.shadow.camera.far = 150
  sun.shadow.normalBias = 0.03
  const lights = [sun, new SkyLightProbe(atmosphere), new NightLightProbe(atmosphere)]
  scene.add(sun.target, ...lights)

  const cycle = new DayCycle(atmosphere, { date: new Date('2026-03-21T12:00:00Z'), holdDay: true })
  const apply = (changes: Partial<DayArgs>): void => {
    cycle.rate = 86_400 / current.dayLength
    cycle.daylight = current.daylight
    cycle.paused = current.paused || current.frame
    cycle.latitude = current.latitude
    cycle.season = current.season
    if (changes.hour !== undefined) cycle.hour = current.hour % 24
  }
  apply(current)

  let last: number | undefined
  const draw = (): void => {
    const now = performance.now()
    const delta = current.frame || last === undefined ? 0 : (now - last) / 1000
    last = now
    camera.updateMatrixWorld()
    // Hidden pages get no frames: time goes on from where it was.
    cycle.update(Math.min(delta, 0.1), camera)
    renderer.render(scene, camera)
  }
  let ready: Promise<void> = Promise.resolve()
  return {
    renderer,
    scene,
    camera,
    get ready() {
      return ready
    },
    progress: 1,
    render() {
      if (!current.frame) controls.update()
      draw()
    },
    resize(width, height, pixelRatio) {
      renderer.setPixelRatio(pixelRatio)
      renderer.setSize(width, height, false)
      camera.aspect = width / height
      camera.updateProjectionMatrix()
      ready = (async () => {
        // One exposure, from the same tables, in every single frame.
        if (current.frame) {
          await atmosphere.bake(renderer)
          cycle.adaptation = 0
        }
        for (let i = 0; current.frame && i < WARM_UP_FRAMES; i++) draw()
      })()
    },
    update(changes) {
      Object.assign(current, changes)
      apply(changes)
    },
    dispose() {
      if (controls.domElement !== null) controls.dispose()
      for (const light of lights) light.dispose()
      atmosphere.dispose()
      for (const { geometry } of meshes) geometry.dispose()
      material.dispose()
      void renderer.dispose()
    }
  }
}

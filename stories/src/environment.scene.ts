import { skyEnvironment } from '@welkin/atmosphere'
import {
  BoxGeometry,
  IcosahedronGeometry,
  Mesh,
  MeshPhysicalMaterial,
  MeshStandardMaterial,
  PerspectiveCamera,
  Scene,
  SphereGeometry
} from 'three'
import { Air } from './air'
import { createWater } from './environment/water'
import { Explorer } from './moving/Explorer'
import { createRenderer, disposeMeshes, exposureOf, frameClock } from './scene'
import type { RendererArgs, SceneHandle } from './scene'
import { storyHandle } from './storyHandle'

export interface EnvironmentArgs extends RendererArgs {
  /** Elevation of the sun [degrees]. */
  elevation: number
  /** Azimuth of the sun, clockwise from north [degrees]. The camera looks north. */
  azimuth: number
  /** Mean square slope of the water, in thousandths. */
  ripples: number
  /** [stops], 0 for daylight. */
  exposure: number
}

/** Past the horizon of a camera a few metres up [m]. */
const SEA_RADIUS = 20_000

/** A stone slab in calm water, with metals from polished to matt in front and glass behind. */
function populate(scene: Scene): Mesh[] {
  const meshes: Mesh[] = []
  const add = (mesh: Mesh, x: number, y: number, z: number): void => {
    mesh.position.set(x, y, z)
    mesh.castShadow = mesh.receiveShadow = true
    meshes.push(mesh)
  }
  const stone = new MeshStandardMaterial({ color: '#8c877d', roughness: 0.85 })
  add(new Mesh(new BoxGeometry(13, 0.5, 5), stone), 0, 0, 0)

  const ball = new SphereGeometry(0.75, 64, 48)
  for (let i = 0; i < 7; i++) {
    const roughness = i / 6
    const steel = new MeshStandardMaterial({ color: '#e8e8ea', metalness: 1, roughness })
    add(new Mesh(ball, steel), (i - 3) * 1.75, 1, 1.2)
  }
  const gold = new MeshStandardMaterial({ color: '#f0b840', metalness: 1, roughness: 0.18 })
  const paint = new MeshPhysicalMaterial({ color: '#7a1410', roughness: 0.5, clearcoat: 1 })
  const glass = new MeshPhysicalMaterial({
    roughness: 0,
    transmission: 1,
    thickness: 2.3,
    attenuationColor: '#c8e6dc',
    attenuationDistance: 3,
    ior: 1.5
  })
  add(new Mesh(ball, gold), -4.4, 1, -1)
  add(new Mesh(ball, paint), -2.2, 1, -1)
  add(new Mesh(new SphereGeometry(1.15, 64, 48), glass), 0.4, 1.4, -1)
  add(new Mesh(new BoxGeometry(1.7, 2.4, 0.2), glass), 3, 1.45, -1)
  add(new Mesh(new IcosahedronGeometry(0.9), glass), 5, 1, -1)
  meshes[meshes.length - 2].rotation.y = -0.5
  scene.add(...meshes)
  return meshes
}

/** Environment map of the scene, for materials that mirror: the sky itself. */
export async function createEnvironment(
  canvas: HTMLCanvasElement,
  args: EnvironmentArgs
): Promise<SceneHandle<EnvironmentArgs>> {
  const renderer = await createRenderer(canvas, args.forceWebGL)
  const scene = new Scene()
  const camera = new PerspectiveCamera(44, 1, 0.1, 2 * SEA_RADIUS)
  camera.position.set(-1.5, 2.6, 12)
  camera.lookAt(0, 1.5, 0)
  const explorer = args.frame ? undefined : new Explorer(camera, canvas)
  const elapsed = frameClock(args.frame)

  const current = { ...args }
  const air = new Air(renderer, scene, camera, args.path)
  const { atmosphere, sun } = air
  // #region environment
  atmosphere.parameters.set({ groundAlbedo: [0.07, 0.06, 0.05, 0.04] }) // a dark, bluish sea
  const environment = skyEnvironment(atmosphere) // without the sun: its light has a highlight
  scene.environmentNode = environment
  // #endregion
  const meshes = populate(scene)
  const water = createWater(SEA_RADIUS)
  scene.add(water.mesh)

  sun.shadow.mapSize.setScalar(2048)
  sun.shadow.camera.left = sun.shadow.camera.bottom = -10
  sun.shadow.camera.right = sun.shadow.camera.top = 10
  sun.shadow.camera.far = 100
  sun.shadow.normalBias = 0.02

  const apply = (): void => {
    atmosphere.setSunAngles(current.elevation, current.azimuth)
    water.setSlope(current.ripples / 1000)
    renderer.toneMappingExposure = exposureOf(current.exposure)
    // One frame must show it all; a running scene draws it over fifteen.
    if (current.frame) environment.needsRedraw = true
  }
  apply()

  const start = performance.now()
  const draw = (): void => {
    explorer?.update(elapsed())
    if (!current.frame) water.setTime((performance.now() - start) / 1000)
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
    dispose() {
      environment.dispose()
      air.dispose()
      water.dispose()
      disposeMeshes(meshes)
    }
  })
}

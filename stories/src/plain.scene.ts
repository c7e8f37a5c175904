import {
  BoxGeometry,
  CircleGeometry,
  Mesh,
  MeshPhysicalMaterial,
  MeshStandardMaterial,
  PerspectiveCamera,
  Scene,
  SphereGeometry,
  TorusKnotGeometry
} from 'three'
import { Air } from './air'
import { Explorer } from './moving/Explorer'
import { applyTime, createRenderer, disposeMeshes, frameClock } from './scene'
import type { RendererArgs, SceneHandle, TimeArgs } from './scene'
import { storyHandle } from './storyHandle'

export interface PlainArgs extends RendererArgs, TimeArgs {
  /** [degrees] */
  longitude: number
  /** [degrees] */
  latitude: number
  /** Height of the scene's ground above the ellipsoid [m]. */
  height: number
}

/** Radius of the ground: to the horizon of a camera a few metres up [m]. */
const GROUND_RADIUS = 15_000

/** A scene like any other of three: y up, metres, built-in materials. */
function populate(scene: Scene): Mesh[] {
  const standing = (mesh: Mesh, x: number, y: number, z: number): Mesh => {
    mesh.position.set(x, y, z)
    mesh.castShadow = true
    mesh.receiveShadow = true
    return mesh
  }
  const ground = new Mesh(
    new CircleGeometry(GROUND_RADIUS, 96).rotateX(-Math.PI / 2),
    new MeshStandardMaterial({ color: '#7d7a6d', roughness: 0.95 })
  )
  ground.receiveShadow = true
  const meshes: Mesh[] = [ground]

  const ball = new SphereGeometry(0.8, 48, 32)
  for (let i = 0; i < 5; i++) {
    const roughness = 0.1 + i * 0.2
    const x = (i - 2) * 2
    const metal = new MeshStandardMaterial({ color: '#d9a441', metalness: 0.3, roughness })
    const paint = new MeshStandardMaterial({ color: '#a8322a', metalness: 0, roughness })
    meshes.push(
      standing(new Mesh(ball, metal), x, 0.8, -2.5),
      standing(new Mesh(ball, paint), x, 0.8, 0)
    )
  }

  const white = new MeshStandardMaterial({ color: '#d8d8d4', roughness: 0.8 })
  meshes.push(
    standing(new Mesh(new BoxGeometry(2, 5, 2), white), -7, 2.5, -5),
    standing(new Mesh(new BoxGeometry(3, 1.5, 1.5), white), 7, 0.75, -1),
    standing(
      new Mesh(
        new TorusKnotGeometry(1.2, 0.38, 160, 24),
        new MeshStandardMaterial({ color: '#2f6f8f', roughness: 0.3 })
      ),
      6,
      3.4,
      -6
    )
  )

  const glass = new MeshPhysicalMaterial({
    color: '#cfe8e4',
    roughness: 0.03,
    transparent: true,
    opacity: 0.25
  })
  const pane = standing(new Mesh(new BoxGeometry(3.4, 2.4, 0.06), glass), -3.4, 1.3, 2.4)
  const bubble = standing(new Mesh(ball, glass), 2.6, 0.8, 2.6)
  pane.castShadow = bubble.castShadow = false
  meshes.push(pane, bubble)
  scene.add(...meshes)
  return meshes
}

export async function createPlain(
  canvas: HTMLCanvasElement,
  args: PlainArgs
): Promise<SceneHandle<PlainArgs>> {
  const renderer = await createRenderer(canvas, args.forceWebGL)
  const scene = new Scene()
  const camera = new PerspectiveCamera(48, 1, 0.1, 2 * GROUND_RADIUS)
  camera.position.set(3.5, 3, 11.5)
  camera.lookAt(0.2, 1.5, -1)
  const explorer = args.frame ? undefined : new Explorer(camera, canvas)
  const elapsed = frameClock(args.frame)
  const meshes = populate(scene)

  const current = { ...args }
  const air = new Air(renderer, scene, camera, args.path)
  const { shadow } = air.sun
  shadow.mapSize.setScalar(2048)
  shadow.camera.left = shadow.camera.bottom = -14
  shadow.camera.right = shadow.camera.top = 14
  shadow.camera.far = 100
  shadow.normalBias = 0.02

  const apply = (): void => {
    air.atmosphere.place(current)
    applyTime(renderer, air, current)
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
    dispose() {
      air.dispose()
      disposeMeshes(meshes)
    }
  })
}

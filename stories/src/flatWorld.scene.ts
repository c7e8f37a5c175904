import { Atmosphere } from '@welkin/atmosphere'
import {
  latticeNoise,
  latticeNoiseOnCPU,
  Terrain,
  Walker,
  type HeightSource,
  type TerrainOptions
} from '@welkin/terrain'
import { BoxGeometry, Mesh, MeshStandardMaterial, PerspectiveCamera, Scene, Vector3 } from 'three'
import { float, vec4 } from 'three/tsl'
import { Air } from './air'
import { aimShadow, prepareShadow } from './globe/sunShadow'
import { Explorer } from './moving/Explorer'
import {
  applyTime,
  createRenderer,
  disposeMeshes,
  frameClock,
  WARM_UP_FRAMES,
  type RendererArgs,
  type SceneHandle,
  type TimeArgs
} from './scene'
import { storyHandle } from './storyHandle'

export interface FlatWorldArgs extends RendererArgs, TimeArgs {
  /** Level of the lakes [m]. */
  seaLevel: number
}

/** Fewer texels in a still: a software renderer draws it. */
const STILL = { pageMemory: 64 }

const UP = new Vector3(0, 1, 0)

const noise = { x: 0, y: 0, z: 0, value: 0 }
/** Wavelengths and amplitudes of hills [m]: powers of two, so that numbers stay exact. */
const hills = [4096, 2048, 1024, 512, 256, 128].map(length => ({ length, amplitude: length / 24 }))
const most = hills.reduce((sum, { amplitude }) => sum + amplitude, 0)

const rolling: HeightSource = {
  lowest: -most,
  highest: most,
  variation: distance => Math.min(0.75 * distance, 2 * most),
  sampleAt({ x, y, z }, target) {
    target.height = 0
    target.gradient.set(0, 0, 0)
    for (const { length, amplitude } of hills) {
      latticeNoiseOnCPU(x, y, z, 1 / length, 0, noise)
      target.height += amplitude * noise.value
      target.gradient.x += (amplitude * noise.x) / length
      target.gradient.z += (amplitude * noise.z) / length
    }
    return target
  },
  sample({ reference, offset }, shortest) {
    return hills
      .map(({ length, amplitude }) => {
        const { xyz, w } = latticeNoise(reference, offset, float(1 / length), float(0))
        const kept = float(length).div(shortest).sub(1).clamp(0, 1)
        return vec4(xyz.div(length), w).mul(kept.mul(amplitude))
      })
      .reduce((sum, next) => sum.add(next))
  }
}

/** A plane with hills on it: y is up, north is −z, and units are metres. */
function flatWorld(options: TerrainOptions): Terrain {
  // #region flat world
  // #shown import { MountainHeights } from '@welkin/terrain'
  // #shown const rolling = new MountainHeights() // or any HeightSource
  // #shown const options = { seaLevel: -10 }
  const atmosphere = new Atmosphere({ flat: true })
  const terrain = new Terrain(atmosphere, rolling, options) // heights at places (x, 0, z)
  // #endregion
  return terrain
}

/** Blocks of a city upon the hills, and the ground on which each stands. */
function populate(scene: Scene, terrain: Terrain): Mesh[] {
  const material = new MeshStandardMaterial({ color: '#cfc8ba', roughness: 0.85 })
  const geometry = new BoxGeometry(1, 1, 1).translate(0, 0.5, 0)
  const meshes: Mesh[] = []
  for (let i = 0; i < 24; i++) {
    const mesh = new Mesh(geometry, material)
    const [column, row] = [i % 6, Math.floor(i / 6)]
    mesh.position.set(40 * column - 70, 0, 45 * row - 150)
    mesh.position.y = terrain.heightBelow(mesh.position) - 3
    mesh.scale.set(14, 12 + ((7 * i) % 19), 18)
    if (mesh.position.y < terrain.seaLevel) continue // none in a lake
    mesh.castShadow = mesh.receiveShadow = true
    meshes.push(mesh)
  }
  scene.add(...meshes)
  return meshes
}

/** Blocks on hills by lakes, in a world that is a plane. */
export async function createFlatWorld(
  canvas: HTMLCanvasElement,
  args: FlatWorldArgs
): Promise<SceneHandle<FlatWorldArgs>> {
  const renderer = await createRenderer(canvas, args.forceWebGL)
  const scene = new Scene()
  const camera = new PerspectiveCamera(50, 1, 0.2, 1e6)
  const current = { ...args }
  const terrain = flatWorld({ seaLevel: args.seaLevel, ...(args.frame && STILL) })
  const air = new Air(renderer, scene, camera, args.path, terrain.atmosphere)
  terrain.castShadow = terrain.receiveShadow = true
  scene.add(terrain)
  prepareShadow(air.sun)
  const meshes = populate(scene, terrain)
  camera.position.z = -320
  camera.position.y = terrain.heightBelow(camera.position) + 25
  camera.rotation.set(-0.1, Math.PI, 0, 'YXZ') // south, over the lake
  air.sun.shadow.normalBias = 0.5
  const groundAt = (place: Vector3): number => terrain.heightBelow(place)
  const explorer = args.frame
    ? undefined
    : new Explorer(camera, canvas, { groundAt, walker: new Walker(terrain) })
  const elapsed = frameClock(args.frame)
  const apply = (): void => {
    terrain.seaLevel = current.seaLevel
    applyTime(renderer, air, current)
  }
  apply()
  const draw = (): void => {
    explorer?.update(elapsed())
    camera.updateMatrixWorld()
    aimShadow(air.sun, camera, Math.max(camera.position.y - groundAt(camera.position), 2), UP)
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
    async warmUp() {
      for (let i = 0; args.frame && i < WARM_UP_FRAMES; i++) {
        camera.updateMatrixWorld()
        terrain.update(renderer, camera, Infinity)
        draw()
        await new Promise(requestAnimationFrame)
      }
    },
    dispose() {
      terrain.dispose()
      air.dispose()
      disposeMeshes(meshes)
    }
  })
}

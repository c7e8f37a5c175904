import { Atmosphere } from '@welkin/atmosphere'
import { MountainHeights, Terrain, terrainView, Walker } from '@welkin/terrain'
import { Matrix4, PerspectiveCamera, Scene, Vector3 } from 'three'
import { Air } from './air'
import { moveCamera } from './globe/places'
import { aimShadow, prepareShadow } from './globe/sunShadow'
import { Explorer } from './moving/Explorer'
import {
  applyTime,
  createRenderer,
  frameClock,
  WARM_UP_FRAMES,
  type RendererArgs,
  type SceneHandle,
  type TimeArgs
} from './scene'
import { storyHandle } from './storyHandle'

/** A view of the made-up planet, above its ground. */
interface TerrainView {
  readonly label: string
  readonly longitude: number
  readonly latitude: number
  /** Height above the ground [m]. */
  readonly height: number
  readonly heading: number
  readonly pitch: number
}

export const VIEWS = {
  meadow: {
    label: 'Meadow, 2 m',
    longitude: 0.43,
    latitude: 47.12,
    height: 2,
    heading: 150,
    pitch: 8
  },
  shore: {
    label: 'Shore, 30 m',
    longitude: 0.94,
    latitude: 46.12,
    height: 30,
    heading: 10,
    pitch: 5
  },
  summit: { label: 'Summit, 2 m', longitude: 1, latitude: 47, height: 2, heading: 250, pitch: -5 },
  range: {
    label: 'Range, 8 km',
    longitude: 1,
    latitude: 46.2,
    height: 8000,
    heading: 0,
    pitch: -10
  },
  orbit: {
    label: 'Orbit, 400 km',
    longitude: 1,
    latitude: 42,
    height: 4e5,
    heading: 0,
    pitch: -25
  },
  globe: {
    label: 'Globe, 20,000 km',
    longitude: 1,
    latitude: 30,
    height: 2e7,
    heading: 0,
    pitch: -90
  }
} satisfies Record<string, TerrainView>

/** Colours of the ground: its own, or those that tell how it is drawn. */
export const COLORS = {
  ground: { label: 'Ground' },
  levels: { label: 'Levels of detail' },
  tiles: { label: 'Tiles' },
  pages: { label: 'Pages: there, fading in, missing' }
} as const

export interface TerrainArgs extends RendererArgs, TimeArgs {
  view: keyof typeof VIEWS
  color: keyof typeof COLORS
  wireframe: boolean
}

/** Place of the world's origin [°]. */
const ORIGIN = { longitude: 0.43, latitude: 47.12 }

/** Cells along a tile's edge in a still: a software renderer draws it. */
const STILL_RESOLUTION = 16

/** A made-up planet from a walker's feet to orbit: one mesh, without a byte of data. */
export async function createTerrain(
  canvas: HTMLCanvasElement,
  args: TerrainArgs
): Promise<SceneHandle<TerrainArgs>> {
  const renderer = await createRenderer(canvas, args.forceWebGL)
  const scene = new Scene()
  const camera = new PerspectiveCamera(50, 1, 0.2, 1e8)
  const current = { ...args }
  const atmosphere = new Atmosphere()
  atmosphere.place(ORIGIN)
  const air = new Air(renderer, scene, camera, args.path, atmosphere)
  const options = args.frame ? { resolution: STILL_RESOLUTION } : {}
  // #region terrain
  const heights = new MountainHeights({ seed: 1 }) // a function: nothing is loaded
  const terrain = new Terrain(atmosphere, heights, options)
  terrain.castShadow = terrain.receiveShadow = true
  scene.add(terrain)
  // #endregion
  prepareShadow(air.sun)
  const groundColor = terrain.material.colorNode
  let color: keyof typeof COLORS = 'ground'

  const { ellipsoid, worldToECEF } = atmosphere
  const ecefToWorld = new Matrix4().copy(worldToECEF).invert()
  const position = new Vector3()
  const toECEF = (place: Vector3): Vector3 => position.copy(place).applyMatrix4(worldToECEF)
  const upAt = (place: Vector3, target: Vector3): Vector3 =>
    ellipsoid.surfaceNormal(toECEF(place), target).transformDirection(ecefToWorld)
  const heightAt = (place: Vector3): number => ellipsoid.heightAt(toECEF(place))
  const groundAt = (place: Vector3): number => terrain.heightBelow(place)

  const explorer = args.frame
    ? undefined
    : new Explorer(camera, canvas, { upAt, heightAt, groundAt, walker: new Walker(terrain) })
  const elapsed = frameClock(args.frame)

  const goTo = (view: TerrainView): void => {
    const height = terrain.heightAt(view.longitude, view.latitude) + view.height
    const aim = moveCamera(new PerspectiveCamera(), { ...view, height })
    aim.applyMatrix4(ecefToWorld)
    if (explorer === undefined || camera.position.lengthSq() === 0) {
      camera.position.copy(aim.position)
      camera.quaternion.copy(aim.quaternion)
      return
    }
    aim.updateMatrixWorld()
    const direction = aim.getWorldDirection(new Vector3())
    const distance = camera.position.distanceTo(aim.position)
    void explorer.flyTo({ position: aim.position, direction }, 2 + Math.log10(1 + distance))
  }

  const apply = (): void => {
    applyTime(renderer, air, current)
    terrain.material.wireframe = current.wireframe
    if (current.color === color) return
    color = current.color
    terrain.material.colorNode = color === 'ground' ? groundColor : terrainView(color)
    terrain.material.needsUpdate = true
  }
  apply()
  goTo(VIEWS[current.view])

  const up = new Vector3()
  const draw = (): void => {
    explorer?.update(elapsed())
    camera.updateMatrixWorld()
    const height = Math.max(heightAt(camera.position) - groundAt(camera.position), 2)
    camera.near = Math.min(height / 10, 1e4)
    camera.updateProjectionMatrix()
    aimShadow(air.sun, camera, height, upAt(camera.position, up))
    air.render()
  }

  return storyHandle<TerrainArgs>({
    renderer,
    scene,
    camera,
    explorer,
    current,
    apply(before) {
      apply()
      if (current.view !== before.view) goTo(VIEWS[current.view])
    },
    draw,
    async warmUp() {
      for (let i = 0; current.frame && i < WARM_UP_FRAMES; i++) {
        camera.updateMatrixWorld()
        terrain.update(renderer, camera, Infinity)
        draw()
        await new Promise(requestAnimationFrame)
      }
    },
    dispose() {
      terrain.dispose()
      air.dispose()
    }
  })
}

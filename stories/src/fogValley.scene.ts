import type { TilesRenderer } from '3d-tiles-renderer'
import { GlobeControls } from '3d-tiles-renderer'
import { distanceFog, heightFog } from '@welkin/atmosphere'
import { Ellipsoid, fitGlobeCamera } from '@welkin/geo'
import { Group, PerspectiveCamera, Scene, Vector3 } from 'three'
import { Air } from './air'
import { createNoiseTexture } from './globe/detailNoise'
import { createEarthSurface } from './globe/earthSurface'
import { loadTiles, tilesProgress } from './globe/loadTiles'
import type { Place } from './globe/places'
import { moveCamera } from './globe/places'
import { aimShadow, prepareShadow } from './globe/sunShadow'
import { createTerrain } from './globe/terrain'
import { createRenderer, dateOf, exposureOf, fitToCanvas, WARM_UP_FRAMES } from './scene'
import type { RendererArgs, SceneHandle } from './scene'

/** Where the camera stands and looks. */
export const VIEWS = {
  ridge: {
    label: 'Above the mist',
    longitude: -84.163,
    latitude: 36.492,
    height: 760,
    heading: 36,
    pitch: -5
  },
  slope: {
    label: 'At its upper edge',
    longitude: -84.178,
    latitude: 36.622,
    height: 372,
    heading: 60,
    pitch: 4
  },
  floor: {
    label: 'In the mist',
    longitude: -84.178,
    latitude: 36.622,
    height: 342,
    heading: 318,
    pitch: 4
  },
  high: {
    label: 'From 4 km',
    longitude: -84.1517,
    latitude: 36.43,
    height: 4000,
    heading: 10,
    pitch: -22
  }
} satisfies Record<string, Place>

export interface FogValleyArgs extends RendererArgs {
  view: keyof typeof VIEWS
  /** Extinction of the mist at its base [1/km]. */
  density: number
  /** Altitude over which it falls to 1/e [m]. */
  falloff: number
  /** Of its base [m]. */
  base: number
  /** Of fog by distance [1/km]. */
  distance: number
  /** A moment of the day [ms since 1970]. */
  day: number
  /** Hour of that day, UTC [h]. */
  hour: number
  /** [stops], 0 for daylight. */
  exposure: number
}

/** Mist in the valleys along the Jacksboro fault at sunrise: real heights, in ECEF metres. */
export async function createFogValley(
  canvas: HTMLCanvasElement,
  args: FogValleyArgs
): Promise<SceneHandle<FogValleyArgs>> {
  const renderer = await createRenderer(canvas, args.forceWebGL)
  const scene = new Scene()
  const camera = new PerspectiveCamera(46, 1, 1, 1e6)
  const noise = createNoiseTexture()
  const data = new URL('world-data/', document.baseURI)
  const surface = createEarthSurface(new URL('natural-earth/', data).href, noise)
  const terrain = createTerrain(new URL('terrain/', data).href, noise)
  const tilesets: TilesRenderer[] = [surface.tiles, terrain.tiles]
  const land = new Group()
  land.add(surface.tiles.group, terrain.tiles.group)
  scene.add(land)

  const air = new Air(renderer, scene, camera, args.path)
  const { atmosphere } = air
  // #region fog
  atmosphere.frame = 'ecef' // the world's axes are the Earth's, its origin the Earth's centre
  const mist = heightFog({ base: 300, falloff: 40, density: 0.006 }) // metres, 1/m: in the valleys
  const murk = distanceFog({ density: 1 / 8000 }) // 1/m: where the scene ends
  atmosphere.add(murk, mist) // before the first render
  // #endregion
  prepareShadow(air.sun)

  const controls = new GlobeControls(land, camera, args.frame ? undefined : canvas)
  controls.setEllipsoid(surface.tiles.ellipsoid, surface.tiles.group)
  controls.cameraRadius = 1.7
  controls.enableDamping = true
  const { pivotMesh } = controls as unknown as { pivotMesh: { material: { visible: boolean } } }
  // Its GLSL material is not for WebGPURenderer.
  pivotMesh.material.visible = false
  for (const tiles of tilesets) {
    tiles.setCamera(camera)
  }

  const current = { ...args }
  const up = new Vector3()
  let ready: Promise<void> = Promise.resolve()
  let disposed = false

  const prepare = (): void => {
    camera.updateMatrixWorld()
    fitGlobeCamera(camera, { depth: renderer.reversedDepthBuffer ? 'reversed' : 'standard' })
    for (const tiles of tilesets) {
      tiles.update()
    }
  }

  const draw = (): void => {
    prepare()
    const altitude = Ellipsoid.WGS84.heightAt(camera.position)
    Ellipsoid.WGS84.surfaceNormal(camera.position, up)
    aimShadow(air.sun, camera, Math.max(altitude, 2), up)
    air.render()
  }

  const load = (): void => {
    ready = loadTiles(tilesets, prepare, () => disposed).then(() => {
      for (let i = 0; current.frame && !disposed && i < WARM_UP_FRAMES; i++) {
        draw()
      }
    })
    // A failure is reported to whoever awaits `ready`.
    ready.catch(() => {})
  }

  const goTo = (view: keyof typeof VIEWS): void => {
    moveCamera(camera, VIEWS[view])
    controls.setCamera(camera)
    load()
  }

  const apply = (): void => {
    atmosphere.date = dateOf(current.day, current.hour)
    renderer.toneMappingExposure = exposureOf(current.exposure)
    const { density, falloff, base } = current
    mist.set({ density: density / 1000, falloff, base })
    murk.density = current.distance / 1000
  }

  apply()
  goTo(current.view)

  return {
    renderer,
    scene,
    camera,
    get ready() {
      return ready
    },
    get progress() {
      return tilesProgress(tilesets)
    },
    render() {
      if (!current.frame) {
        controls.update()
      }
      draw()
    },
    resize(width, height, pixelRatio) {
      fitToCanvas(renderer, camera, width, height, pixelRatio)
      for (const tiles of tilesets) {
        tiles.setResolution(camera, width * pixelRatio, height * pixelRatio)
      }
      load()
    },
    update(changes) {
      const view = changes.view ?? current.view
      const moved = view !== current.view
      Object.assign(current, changes)
      apply()
      if (moved) {
        goTo(view)
      }
    },
    dispose() {
      disposed = true
      controls.dispose()
      surface.dispose()
      terrain.dispose()
      air.dispose()
      noise.dispose()
      void renderer.dispose()
    }
  }
}

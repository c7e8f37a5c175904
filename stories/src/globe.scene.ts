import { GlobeControls } from '3d-tiles-renderer'
import type { TilesRenderer } from '3d-tiles-renderer'
import { Ellipsoid, fitGlobeCamera } from '@welkin/geo'
import { Group, PerspectiveCamera, Scene, Vector3 } from 'three'
import { createCity } from './globe/city'
import { createNoiseTexture } from './globe/detailNoise'
import { createEarthSurface } from './globe/earthSurface'
import { moveCamera, PLACES } from './globe/places'
import type { PlaceName } from './globe/places'
import { aimShadow, prepareShadow } from './globe/sunShadow'
import { createTerrain } from './globe/terrain'
import { Air } from './air'
import { applyTime, createRenderer, fitToCanvas, WARM_UP_FRAMES } from './scene'
import type { RendererArgs, SceneHandle, TimeArgs } from './scene'
import { loadTiles, tilesProgress } from './globe/loadTiles'

export interface GlobeArgs extends RendererArgs, TimeArgs {
  place: PlaceName
}

/** The city is smaller than a pixel from higher up [m]. */
const CITY_CEILING = 60_000

/** The Earth from a street to 20,000 km: streamed imagery and terrain in a world that is ECEF, in metres. */
export async function createGlobe(
  canvas: HTMLCanvasElement,
  args: GlobeArgs
): Promise<SceneHandle<GlobeArgs>> {
  const renderer = await createRenderer(canvas, args.forceWebGL)
  const scene = new Scene()
  const camera = new PerspectiveCamera(50, 1, 1, 1e7)
  const noise = createNoiseTexture()
  const data = new URL('world-data/', document.baseURI)
  const surface = createEarthSurface(new URL('natural-earth/', data).href, noise)
  const terrain = createTerrain(new URL('terrain/', data).href, noise)
  const city = createCity(noise)
  const tilesets: TilesRenderer[] = [surface.tiles, terrain.tiles]
  const land = new Group()
  land.add(surface.tiles.group, terrain.tiles.group)
  scene.add(land, city.object)

  const air = new Air(renderer, scene, camera, args.path)
  const { atmosphere } = air
  // #region globe
  atmosphere.frame = 'ecef' // the world's axes are the Earth's, its origin the Earth's centre
  // #endregion
  prepareShadow(air.sun)

  const controls = new GlobeControls(land, camera, args.frame ? undefined : canvas)
  controls.setEllipsoid(surface.tiles.ellipsoid, surface.tiles.group)
  controls.cameraRadius = 1.7
  controls.enableDamping = true
  hidePivot(controls)

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
    city.object.visible = altitude < CITY_CEILING
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

  const goTo = (place: PlaceName): void => {
    moveCamera(camera, PLACES[place])
    controls.setCamera(camera)
    load()
  }

  applyTime(renderer, air, current)
  goTo(current.place)

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
      const place = changes.place ?? current.place
      const moved = place !== current.place
      Object.assign(current, changes)
      applyTime(renderer, air, current)
      if (moved) {
        goTo(place)
      }
    },
    dispose() {
      disposed = true
      controls.dispose()
      surface.dispose()
      terrain.dispose()
      city.dispose()
      air.dispose()
      noise.dispose()
      void renderer.dispose()
    }
  }
}

/** The ring that marks the point of a drag has a GLSL material, which WebGPURenderer cannot draw. */
function hidePivot(controls: GlobeControls): void {
  const { pivotMesh } = controls as unknown as { pivotMesh: { material: { visible: boolean } } }
  pivotMesh.material.visible = false
}

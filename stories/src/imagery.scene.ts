import { Atmosphere } from '@welkin/atmosphere'
import { GridHeights, ImageTiles, Terrain } from '@welkin/terrain'
import { PerspectiveCamera, Scene } from 'three'
import { Air } from './air'
import { prepareShadow } from './globe/sunShadow'
import { overlayOn } from './overlay'
import {
  applyTime,
  createRenderer,
  type RendererArgs,
  type SceneHandle,
  type TimeArgs
} from './scene'
import { GroundCamera } from './terrain/GroundCamera'
import { groundHandle } from './terrain/groundHandle'
import type { GroundView } from './terrain/viewAlong'

const PLACE = { longitude: 12, latitude: 36 }

export const VIEWS = {
  globe: { label: 'Globe, 12,000 km', ...PLACE, height: 1.2e7, heading: 0, pitch: -90 },
  orbit: { label: 'Orbit, 900 km', ...PLACE, height: 9e5, heading: 0, pitch: -35 },
  near: {
    label: 'Eye height, 2 m',
    longitude: 10.5,
    latitude: 45,
    height: 2,
    heading: 40,
    pitch: -25
  }
} satisfies Record<string, GroundView>

export interface ImageryArgs extends RendererArgs, TimeArgs {
  view: keyof typeof VIEWS
  /** Template of tiles in Web Mercator; empty for those that come with the stories. */
  url: string
}

/** Fewer cells and texels in a still: a software renderer draws it. */
const STILL = { resolution: 16, pageMemory: 100, pagesPerFrame: 4 }

/** Heights of land and of the sea's bed [m]: where there is water is all that is known here. */
const LAND = 40
const BED = -200

/** Frames before a still, in which tiles arrive. */
const STILL_FRAMES = 60

const dataUrl = (name: string): string => new URL(`world-data/${name}`, document.baseURI).href

/** Land and sea of the Earth, as a picture of open water has them. */
async function loadHeights(): Promise<GridHeights> {
  const response = await fetch(dataUrl('earth/earth-water.png'))
  if (!response.ok) throw new Error(`${response.url}: ${response.status}`)
  const bitmap = await createImageBitmap(await response.blob())
  const { width, height } = bitmap
  const context = new OffscreenCanvas(width, height).getContext('2d')!
  context.drawImage(bitmap, 0, 0)
  const { data } = context.getImageData(0, 0, width, height)
  const heights = Float32Array.from(
    { length: width * height },
    (_, i) => LAND + ((BED - LAND) * data[4 * i]) / 255
  )
  return new GridHeights(heights, { width, height, west: -180, east: 180, south: -90, north: 90 })
}

/** Pictures of the arguments. */
function imageryOf({ url }: ImageryArgs): ImageTiles {
  if (url !== '') return new ImageTiles(url, { maxZoom: 17, attribution: new URL(url).host })
  const tiles = `${dataUrl('natural-earth/')}{z}/{x}/{-y}.jpg`
  // #region imagery
  // #shown const tiles = 'natural-earth/{z}/{x}/{-y}.jpg'
  const imagery = new ImageTiles(tiles, {
    scheme: 'geographic', // two tiles at level 0, rows from the south
    maxZoom: 2,
    attribution: 'Natural Earth'
  })
  // #shown import { MountainHeights, Terrain } from '@welkin/terrain'
  // #shown scene.add(new Terrain(atmosphere, new MountainHeights(), { imagery }))
  // #endregion
  return imagery
}

/** Pictures of the Earth on its ground, from orbit down; near the eye with blades and stones. */
export async function createImagery(
  canvas: HTMLCanvasElement,
  args: ImageryArgs
): Promise<SceneHandle<ImageryArgs>> {
  const heights = await loadHeights()
  const renderer = await createRenderer(canvas, args.forceWebGL)
  const scene = new Scene()
  const camera = new PerspectiveCamera(50, 1, 0.2, 1e8)
  const current = { ...args }
  const atmosphere = new Atmosphere()
  atmosphere.place(PLACE)
  const air = new Air(renderer, scene, camera, args.path, atmosphere)
  const imagery = imageryOf(args)
  const terrain = new Terrain(atmosphere, heights, {
    ...(args.frame && STILL),
    imagery,
    imageAlbedo: 0.5 // of a pale map
  })
  terrain.castShadow = terrain.receiveShadow = true
  scene.add(terrain)
  prepareShadow(air.sun)
  const ground = new GroundCamera(camera, canvas, terrain, args.frame)
  const overlay = args.frame ? undefined : overlayOn(canvas)
  if (overlay !== undefined) overlay.textContent = imagery.attribution

  return groundHandle<Omit<ImageryArgs, 'view'>, typeof VIEWS>({
    renderer,
    scene,
    camera,
    current,
    air,
    terrain,
    ground,
    views: VIEWS,
    apply: () => applyTime(renderer, air, current),
    // Draws until the pictures of a still are there.
    async load() {
      for (let i = 0; args.frame && i < STILL_FRAMES; i++) {
        camera.updateMatrixWorld()
        terrain.update(renderer, camera, Infinity)
        await new Promise(requestAnimationFrame)
      }
    },
    dispose() {
      overlay?.remove()
      imagery.dispose()
    }
  })
}

import { Atmosphere } from '@welkin/atmosphere'
import { GridHeights, heightsFromGeoTIFF, Terrain, TerrariumTiles } from '@welkin/terrain'
import { PerspectiveCamera, Scene, Vector3 } from 'three'
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
import { askServer } from './tileServer'
import { villageTops } from './valley/footing'
import { createVillage } from './valley/village'

/** Middle of the made-up village, on level ground between two ridges [°]. */
const VILLAGE = { longitude: -84.216, latitude: 36.592 }

export const VIEWS = {
  village: {
    label: 'Village, 40 m',
    longitude: -84.2205,
    latitude: 36.5885,
    height: 40,
    heading: 40,
    pitch: -3
  },
  ridge: {
    label: 'Ridge, 2 m',
    longitude: -84.2335,
    latitude: 36.6035,
    height: 2,
    heading: 110,
    pitch: -12
  },
  range: {
    label: 'Ridges, 1.2 km',
    longitude: -84.19,
    latitude: 36.5,
    height: 1200,
    heading: 330,
    pitch: -12
  },
  orbit: {
    label: 'Orbit, 400 km',
    longitude: -84.2,
    latitude: 33,
    height: 4e5,
    heading: 0,
    pitch: -35
  }
} satisfies Record<string, GroundView>

/** Views of the same kinds about another place. */
function viewsAbout({ longitude, latitude }: typeof VILLAGE): typeof VIEWS {
  const moved = Object.entries<GroundView>(VIEWS).map(([name, view]) => [
    name,
    {
      ...view,
      longitude: view.longitude + longitude - VILLAGE.longitude,
      latitude: view.latitude + latitude - VILLAGE.latitude
    }
  ])
  return Object.fromEntries(moved) as typeof VIEWS
}

export interface RealHeightsArgs extends RendererArgs, TimeArgs {
  view: keyof typeof VIEWS
  /** Template of Terrarium tiles, or a GeoTIFF; empty for the grid that comes with the stories. */
  url: string
  /** Line that names the source of the tiles. */
  attribution: string
  wireframe: boolean
}

/** Fewer cells and texels in a still: a software renderer draws it. */
const STILL = { resolution: 16, pageMemory: 100, pagesPerFrame: 4 }

/** Description of the grid in `data/`. */
interface GridFile {
  readonly rows: number
  readonly columns: number
  readonly west: number
  readonly east: number
  readonly south: number
  readonly north: number
  readonly source: string
}

async function load(name: string): Promise<Response> {
  const url = new URL(`world-data/heights/${name}`, document.baseURI)
  const response = await fetch(url)
  if (!response.ok || response.body === null) throw new Error(`${url.href}: ${response.status}`)
  return response
}

/** Heights measured from space, 28 × 32 km of ridges in Tennessee; a plain about them. */
async function loadGrid(): Promise<GridHeights> {
  const file = (await (await load('jacksboro-dem.json')).json()) as GridFile
  const packed = (await load('jacksboro-dem.i16.gz')).body!
  const cells = packed.pipeThrough(new DecompressionStream('gzip'))
  const numbers = await new Response(cells).arrayBuffer()
  const { columns: width, rows: height, west, east, south, north, source } = file
  // #region heights
  // #shown const numbers = await (await fetch('heights.i16')).arrayBuffer() // metres, from the north
  // #shown const [width, height, source] = [1001, 1115, 'Who measured them']
  // #shown const [west, east, south, north] = [-84.4, -84.1, 36.2, 36.5]
  const heights = new GridHeights(new Int16Array(numbers), {
    width,
    height,
    west, // edges [°]
    east,
    south,
    north,
    outside: 300, // a plain, from 6 km beyond the edges on
    fade: 6000,
    attribution: source
  })
  // #endregion
  return heights
}

/** Heights that are drawn. */
interface Given {
  readonly heights: GridHeights | TerrariumTiles
  /** Line about them. */
  readonly note: string
  /** Middle of a file [°]. */
  readonly middle?: { longitude: number; latitude: number }
}

/** Heights of a GeoTIFF in degrees or in a projection that is near enough to them. */
async function openGeoTIFF(url: string): Promise<Given> {
  const { fromUrl } = await import('geotiff')
  // #region GeoTIFF
  // #shown import { fromUrl } from 'geotiff'
  // #shown const url = 'heights.tif'
  const file = await fromUrl(url)
  const image = await file.getImage()
  const measured = await heightsFromGeoTIFF(image, { outside: 0 })
  // #endregion
  const [west, south, east, north] = image.getBoundingBox()
  const middle = { longitude: (west + east) / 2, latitude: (south + north) / 2 }
  return { heights: measured, middle, note: new URL(url, document.baseURI).pathname }
}

/** Heights of the arguments. */
async function heightsOf({ url, attribution }: RealHeightsArgs): Promise<Given> {
  if (/\.tiff?($|[?#])/i.test(url)) {
    try {
      return await openGeoTIFF(url)
    } catch (error) {
      const grid = await loadGrid()
      return { heights: grid, note: `No GeoTIFF: ${String(error)}. The local grid instead.` }
    }
  }
  const answer = url === '' ? undefined : await askServer(url, VILLAGE)
  if (answer !== undefined && 'minZoom' in answer) {
    const tiles = new TerrariumTiles(url, { minZoom: answer.minZoom, maxZoom: 14, attribution })
    const { host } = new URL(url, document.baseURI)
    return { heights: tiles, note: `Tiles of ${host}\n${tiles.attribution}` }
  }
  const grid = await loadGrid()
  const note = answer === undefined ? '' : `No tiles: ${answer.problem}. The local grid instead.\n`
  return { heights: grid, note: note + grid.attribution }
}

/** Measured heights around a village; a grid of numbers, or tiles from a server. */
export async function createRealHeights(
  canvas: HTMLCanvasElement,
  args: RealHeightsArgs
): Promise<SceneHandle<RealHeightsArgs>> {
  const { heights, note, middle = VILLAGE } = await heightsOf(args)
  const renderer = await createRenderer(canvas, args.forceWebGL)
  const scene = new Scene()
  const camera = new PerspectiveCamera(50, 1, 0.2, 1e8)
  const current = { ...args }
  const atmosphere = new Atmosphere()
  atmosphere.place(middle)
  const air = new Air(renderer, scene, camera, args.path, atmosphere)
  const terrain = new Terrain(atmosphere, heights, args.frame ? STILL : {})
  terrain.castShadow = terrain.receiveShadow = true
  scene.add(terrain)
  prepareShadow(air.sun)

  const place = new Vector3()
  const groundAt = (x: number, z: number): number => terrain.heightBelow(place.set(x, 0, z))
  const isLocal = !(heights instanceof TerrariumTiles) && middle === VILLAGE
  // On tiles the village's ground is not there yet.
  const village = isLocal ? createVillage(groundAt, { x: 0, z: 0 }) : undefined
  if (village !== undefined) scene.add(village.object)

  const roofAt = village && villageTops(groundAt, { x: 0, z: 0 })
  const ground = new GroundCamera(camera, canvas, terrain, args.frame, roofAt)
  const overlay = args.frame ? undefined : overlayOn(canvas)
  if (overlay !== undefined) overlay.textContent = note

  const apply = (): void => {
    applyTime(renderer, air, current)
    terrain.material.wireframe = current.wireframe
    const evening = Math.min(Math.max((0.1 - atmosphere.sunDirection.y) / 0.15, 0), 1)
    village?.light(evening, atmosphere.luminanceScale)
  }
  return groundHandle<Omit<RealHeightsArgs, 'view'>, typeof VIEWS>({
    renderer,
    scene,
    camera,
    current,
    air,
    terrain,
    ground,
    views: viewsAbout(middle),
    apply,
    dispose() {
      overlay?.remove()
      village?.dispose()
      if (heights instanceof TerrariumTiles) heights.dispose()
    }
  })
}

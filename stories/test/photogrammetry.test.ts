import { Ellipsoid } from '@welkin/geo'
import { Group, PerspectiveCamera, Vector3 } from 'three'
import { afterEach, beforeEach, expect, it, vi } from 'vitest'
import { lookFrom, type View } from '../src/globe/places'
import { ShownTiles } from '../src/photogrammetry/ShownTiles'
import type { SightName } from '../src/photogrammetry/places'

const ORIGIN = 'http://stories.example'
const LOCAL = `${ORIGIN}/world-data/terrain/tileset.json`
const PARIS = Ellipsoid.WGS84.geodeticToECEF({ longitude: 2.294, latitude: 48.858, height: 150 })

/** A tileset of one empty tile in a box, half as wide as `half` [m]. */
const tileset = (half: number, { x, y, z } = new Vector3()): object => ({
  asset: { version: '1.0' },
  geometricError: half,
  root: {
    boundingVolume: { box: [x, y, z, half, 0, 0, 0, half, 0, 0, 0, half] },
    geometricError: half,
    refine: 'REPLACE'
  }
})

interface Request {
  url: string
  authorization: string | null
}

/** Tiles in a scene without a picture, over a network that answers by the address. */
function stage(answers: Record<string, object>) {
  const requests: Request[] = []
  vi.stubGlobal('fetch', async (url: URL | string, options?: RequestInit) => {
    const authorization = new Headers(options?.headers).get('Authorization')
    requests.push({ url: String(url), authorization })
    const key = Object.keys(answers).find(start => String(url).startsWith(start))
    if (key === undefined) throw new TypeError('Failed to fetch')
    return Response.json(answers[key])
  })
  const camera = new PerspectiveCamera(50, 16 / 9, 1, 1e8)
  const group = new Group()
  const flights: View[] = []
  const scene = {
    camera,
    place: 'manhattan' as SightName,
    prepare() {
      camera.updateMatrixWorld()
      tiles.update()
    },
    goTo(view: View, flies: boolean) {
      if (flies) flights.push(view)
      lookFrom(camera, view)
    }
  }
  const tiles = new ShownTiles(group, scene)
  const ask = (url: string, key = '', onLine = true): Promise<void> => {
    tiles.ask({ url, key }, { onLine, origin: ORIGIN })
    return tiles.ready
  }
  const place = () => Ellipsoid.WGS84.ecefToGeodetic(camera.position)
  return { camera, group, scene, tiles, requests, flights, ask, place }
}

beforeEach(() => {
  vi.stubGlobal('document', { baseURI: `${ORIGIN}/` })
  vi.stubGlobal('requestAnimationFrame', (callback: () => void) => setTimeout(callback))
  vi.stubGlobal('cancelAnimationFrame', clearTimeout)
  vi.stubGlobal('window', { location: { href: `${ORIGIN}/` } })
  vi.spyOn(console, 'error').mockImplementation(() => undefined) // of the loader
})
afterEach(() => {
  vi.unstubAllGlobals()
  vi.restoreAllMocks()
})

const URL_OF_PARIS = 'https://tiles.example/paris/tileset.json'

it('flies to where a tileset stands, with its key, and has all of it in the picture', async () => {
  const { ask, camera, flights, requests, tiles } = stage({ [URL_OF_PARIS]: tileset(400, PARIS) })
  await ask(URL_OF_PARIS, 'secret')
  expect(requests).toEqual([{ url: URL_OF_PARIS, authorization: 'Bearer secret' }])
  expect(flights).toHaveLength(1)
  const radius = 400 * Math.sqrt(3)
  const towards = PARIS.clone().sub(camera.position)
  expect(towards.angleTo(camera.getWorldDirection(new Vector3()))).toBeLessThan(1e-3)
  const angle = Math.asin(radius / towards.length())
  expect(angle).toBeLessThan((25 * Math.PI) / 180)
  expect(angle).toBeGreaterThan((15 * Math.PI) / 180)
  expect(Ellipsoid.WGS84.heightAt(camera.position)).toBeGreaterThan(150 + radius)
  expect(tiles.text).toBe('This tileset stands at 48.858° N 2.294° E.')
  // It is the only place that there is.
  tiles.revisit()
  expect(flights[1].position.distanceTo(flights[0].position)).toBeLessThan(1)
})

it('leaves a camera where a link has put it meanwhile', async () => {
  const { ask, camera, flights } = stage({ [URL_OF_PARIS]: tileset(400, PARIS) })
  const loaded = ask(URL_OF_PARIS)
  const linked = PARIS.clone().multiplyScalar(1.0001)
  camera.position.copy(linked)
  await loaded
  expect(flights).toHaveLength(0)
  expect(camera.position).toEqual(linked)
})

it('stays at the chosen place of tiles of the whole world, and flies to the next one', async () => {
  const url = 'https://tiles.example/world.json'
  const { ask, flights, place, scene, tiles } = stage({ [url]: tileset(7e6) })
  await ask(url)
  expect(flights).toHaveLength(0)
  expect(place().longitude).toBeCloseTo(-74.02, 1)
  scene.place = 'fuji'
  tiles.revisit()
  expect(flights).toHaveLength(1)
  expect(place().longitude).toBeCloseTo(138.79, 1)
  expect(tiles.text).toBe('')
})

it('puts a tileset with coordinates of its own down on the ground', async () => {
  const url = 'https://tiles.example/scan.json'
  const { ask, group, place, tiles } = stage({ [url]: tileset(30, new Vector3(10, 0, 5)) })
  await ask(url)
  expect(place().latitude).toBeCloseTo(36.49, 2)
  const foot = group.children[0].localToWorld(new Vector3(10, 0, 5 - 30))
  expect(Ellipsoid.WGS84.heightAt(foot)).toBeGreaterThan(0)
  expect(Ellipsoid.WGS84.heightAt(foot)).toBeLessThan(30)
  expect(tiles.text).toContain('no place on the Earth')
})

it("asks Google, Cesium's server or one with the key in its address", async () => {
  const { ask, requests } = stage({
    'https://tile.googleapis.com/': tileset(7e6),
    'https://api.cesium.com/': { type: '3DTILES', url: URL_OF_PARIS, accessToken: 'token' },
    [URL_OF_PARIS]: tileset(400, PARIS)
  })
  await ask('', 'google')
  await ask('ion:75343', 'cesium')
  await ask(`${URL_OF_PARIS}?key=mine`)
  const [google, ion, paris, own] = requests.map(({ url }) => new URL(url))
  expect(google.pathname).toBe('/v1/3dtiles/root.json')
  expect(google.searchParams.get('key')).toBe('google')
  expect(ion.pathname).toBe('/v1/assets/75343/endpoint')
  expect(ion.searchParams.get('access_token')).toBe('cesium')
  expect(paris.href).toContain(URL_OF_PARIS)
  expect(own.searchParams.get('key')).toBe('mine')
  expect(requests.at(-1)!.authorization).toBeNull()
})

it('shows the local tiles and says why: without a source, a network, or an answer', async () => {
  const { ask, flights, place, requests, tiles } = stage({ [LOCAL]: tileset(5000, PARIS) })
  await ask('')
  expect(tiles.text).toContain('put a URL or a key')
  await ask(URL_OF_PARIS, 'secret', false)
  expect(tiles.text).toBe('No network: these are local tiles.')
  expect(requests.map(({ url }) => url)).toEqual([LOCAL, LOCAL])
  await ask(URL_OF_PARIS)
  expect(tiles.text).toContain('could not be loaded, so these are local ones')
  expect(tiles.text).toContain('Failed to fetch')
  expect(requests.slice(2).map(({ url }) => url)).toEqual([URL_OF_PARIS, LOCAL])
  expect(flights).toHaveLength(0)
  expect(place().latitude).toBeCloseTo(36.49, 2)
})

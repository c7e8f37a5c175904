import { readdirSync } from 'node:fs'
import { fileURLToPath } from 'node:url'
import type { Atmosphere } from '@welkin/atmosphere'
import { Vector3 } from 'three'
import type { Camera } from 'three'
import { expect, it, vi } from 'vitest'
import type { Explorer } from '../src/moving/Explorer'
import type { SceneHandle } from '../src/scene'

/** Arguments that a story gives `mount`. */
interface Mounted {
  readonly create: (canvas: HTMLCanvasElement, args: object) => Promise<SceneHandle<object>>
  readonly restartsWith?: (args: object) => string
}

interface Control {
  readonly name?: string
  readonly description?: string
  readonly options?: readonly string[]
  readonly table?: { readonly disable?: boolean }
}

interface Stories {
  readonly default: {
    readonly render: Mounted
    readonly args: Record<string, unknown>
    readonly argTypes: Record<string, Control>
  }
}

vi.mock('../src/mount', () => ({
  mount: (create: Mounted['create'], _code: string, restartsWith?: Mounted['restartsWith']) =>
    Object.assign(() => undefined, { create, restartsWith })
}))

// Nothing is drawn.
vi.mock('../src/scene', async original => ({
  ...(await original<object>()),
  createRenderer: async () => ({ library: {}, dispose() {}, initRenderTarget() {} })
}))
vi.mock('@welkin/atmosphere', async original => {
  const library = await original<{ Atmosphere: typeof Atmosphere }>()
  library.Atmosphere.prototype.bake = async () => {}
  return library
})
vi.mock('../src/globe/earthPictures', () => ({ earthPictures: async () => ({}) }))
vi.mock('../src/overlay', () => ({ overlayOn: () => ({ remove() {} }) }))

const folder = fileURLToPath(new URL('../src/', import.meta.url))
const files = readdirSync(folder)
  .filter(file => file.endsWith('.stories.ts'))
  .map(file => file.slice(0, -3))

async function load(file: string): Promise<Stories['default']> {
  const { default: meta } = (await import(`../src/${file}.ts`)) as Stories
  return meta
}

/** Names under which stories let one choose a view. */
const VIEWS = new Set(['View', 'Place', 'Camera', 'Constellation'])

it.each(files)('%s makes no new scene for another view, or says so', async file => {
  const { args, argTypes, render } = await load(file)
  const { restartsWith = () => '' } = render ?? {}
  const controls = Object.entries(argTypes ?? {}).filter(
    ([, { name = '', table }]) => VIEWS.has(name) && !table?.disable
  )
  const silent = controls.filter(([key, { options = [], description = '' }]) => {
    const keys = new Set(options.map(option => restartsWith({ ...args, [key]: option })))
    return keys.size > 1 && !description.includes('new scene')
  })
  expect(silent.map(([key]) => key)).toEqual([])
})

function canvasOf(): HTMLCanvasElement {
  const page = new EventTarget()
  const ownerDocument = Object.assign(new EventTarget(), { defaultView: page })
  const canvas = Object.assign(new EventTarget(), { ownerDocument, style: {}, clientHeight: 500 })
  return canvas as unknown as HTMLCanvasElement
}

const poseOf = (camera: Camera): number[] => [
  ...camera.position.toArray(),
  ...camera.getWorldDirection(new Vector3()).toArray()
]

/** Change of the arguments of a story, from its own or from others. */
interface Change {
  readonly file: string
  readonly change: object
  readonly from?: object
}

/** Views that stories without a world of tiles go to. */
const changes: readonly Change[] = [
  { file: 'rain', change: { view: 'virga' } },
  { file: 'rain', change: { view: 'snow' } },
  { file: 'halos', change: { view: 'glory' } },
  { file: 'halos', change: { view: 'rainbow' } },
  { file: 'stormNight', change: { view: 'aeroplane' } },
  { file: 'orbit', change: { angle: 250 } },
  { file: 'orbit', change: { angle: 215 }, from: { angle: 35 } },
  { file: 'orbit', change: { altitude: 900 } },
  { file: 'planets', change: { height: 200_000 } },
  { file: 'planets', change: { pitch: 30 } },
  { file: 'night', change: { constellation: 'cassiopeia' } },
  { file: 'moon', change: { target: 'sun', fieldOfView: 40 } },
  { file: 'lightShafts', change: { view: 'opposite' }, from: { view: 'storm' } },
  { file: 'sandbox', change: { heading: 120, height: 300 } }
]

it.each(changes)('$file flies to $change', async ({ file, change, from }) => {
  const { args, render } = await load(`${file}.stories`)
  const start = (more: object) => render.create(canvasOf(), { ...args, ...from, ...more })
  const [scene, there] = [await start({}), await start(change)]
  await scene.ready
  await there.ready
  const explorer = scene.explorer as Explorer
  explorer.update(0.02)
  there.explorer!.update(0.02)
  const before = poseOf(scene.camera)
  scene.update({ ...args, ...from, ...change })
  await scene.ready
  expect(explorer.isFlying).toBe(true)
  expect(poseOf(scene.camera)).toEqual(before)
  const distance = new Vector3().fromArray(before).distanceTo(there.camera.position)
  let longest = 0
  for (let i = 0; explorer.isFlying && i < 600; i++) {
    const [x, y, z] = scene.camera.position
    explorer.update(0.02)
    longest = Math.max(longest, scene.camera.position.distanceTo(new Vector3(x, y, z)))
  }
  expect(explorer.isFlying).toBe(false)
  poseOf(scene.camera).forEach((value, i) => {
    expect(value).toBeCloseTo(poseOf(there.camera)[i], i < 3 && distance > 1e4 ? 0 : 4)
  })
  // 1.875 times the mean speed at most.
  if (distance > 0) expect(longest).toBeLessThan(0.1 * distance)
})

import { readdirSync, readFileSync } from 'node:fs'
import { fileURLToPath } from 'node:url'
import { expect, it } from 'vitest'

const folder = fileURLToPath(new URL('../src/', import.meta.url))
const read = (file: string): string => readFileSync(folder + file, 'utf8')

/** Scenes without a camera: pictures of tables. */
const FLAT = new Set(['tables.scene.ts'])

/** Scenes that stories show, by their files. */
const scenes = [
  ...new Set(
    readdirSync(folder)
      .filter(file => file.endsWith('.stories.ts'))
      .flatMap(file => [...read(file).matchAll(/from '\.\/(\w+\.scene)'/g)])
      .map(([, name]) => `${name}.ts`)
  )
].filter(file => !FLAT.has(file))

/** Makers of an explorer on a scene's canvas, or of a handle that has one, and the files of those that are not three's or ours. */
const MAKERS: Readonly<Record<string, string>> = {
  'createLand(': 'globe/land.ts',
  'new GroundCamera(': 'terrain/GroundCamera.ts'
}

/** Code of a scene, and of what it makes its explorer by. */
function sourcesOf(file: string): string {
  const source = read(file)
  const [, from] = /return create\w+\(|import \{ (create\w+) \} from/.exec('') ?? []
  const makers = Object.keys(MAKERS).filter(maker => source.includes(maker))
  return [source, ...makers.map(maker => read(MAKERS[maker])), from ?? ''].join('\n')
}

it('has scenes for its stories', () => {
  expect(scenes.length).toBeGreaterThan(20)
})

it.each(scenes)('moves the camera of %s by keys, mouse and touch', file => {
  const sources = sourcesOf(file)
  expect(sources).toMatch(/new Explorer\(camera, canvas/)
  // The handle has it: the page shows its keys and keeps the view in the address.
  expect(sources).toMatch(/^\s*(explorer,|explorer: |get explorer\(\))/m)
})

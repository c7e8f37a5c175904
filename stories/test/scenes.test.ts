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
      .flatMap(file => Array.from(read(file).matchAll(/from '\.\/(\w+\.scene)'/g)))
      .map(([, name]) => `${name}.ts`)
  )
].filter(file => !FLAT.has(file))

/** Files in which scenes' explorers and handles are made for them. */
const MAKERS = /from '\.\/(moon\.scene|globe\/land|terrain\/GroundCamera|terrain\/groundHandle)'/g

/** Code of a scene, and of what makes its explorer and its handle. */
function sourcesOf(file: string): string {
  const source = read(file)
  const makers = [...source.matchAll(MAKERS)].map(([, maker]) => read(`${maker}.ts`))
  return [source, ...makers].join('\n')
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

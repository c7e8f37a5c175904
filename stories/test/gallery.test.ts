import { readdirSync, readFileSync, statSync } from 'node:fs'
import { fileURLToPath } from 'node:url'
import { expect, it } from 'vitest'
import { listStories } from '../src/gallery/listStories'

const folder = fileURLToPath(new URL('../src/', import.meta.url))
const pictures = fileURLToPath(new URL('../pictures/', import.meta.url))
const baselines = fileURLToPath(new URL('../../e2e/visual/baselines/', import.meta.url))

const files = readdirSync(folder).filter(file => file.endsWith('.stories.ts'))
const storiesOf = (file: string) =>
  listStories(`../${file}`, readFileSync(folder + file, 'utf8')).stories
const baseline = readdirSync(baselines)
  .filter(file => !file.endsWith('.webgl.png'))
  .map(file => file.replace('.png', ''))
/** Pictures by `npm run gallery`. */
const drawn = readdirSync(pictures).map(file => file.replace('.jpg', ''))

it('has a story, with a name and a sentence, for each picture of the visual tests', () => {
  const stories = files.flatMap(storiesOf)
  const listed = new Set(stories.map(({ picture }) => picture))
  expect(baseline.filter(picture => !listed.has(picture))).toEqual([])
  expect(new Set(stories.map(({ id }) => id)).size).toBe(stories.length)
  for (const { id, name } of stories) {
    expect(id).toMatch(/^[a-z\d-]+--[a-z\d-]+$/)
    expect(name).not.toBe('')
  }
})

it.each(files)('has all stories of %s, each with a picture of its own', file => {
  const stories = storiesOf(file)
  // As many as there are in the code, however they are written.
  const exported = readFileSync(folder + file, 'utf8').match(/^export const \w+/gm) ?? []
  expect(stories).toHaveLength(exported.length)
  for (const { picture } of stories) {
    const isBaseline = baseline.includes(picture)
    expect([picture, isBaseline || drawn.includes(picture)]).toEqual([picture, true])
  }
})

it('has no drawn picture that is of no story, or that a baseline is of', () => {
  const listed = new Set(files.flatMap(storiesOf).map(({ picture }) => picture))
  expect(drawn.filter(picture => !listed.has(picture) || baseline.includes(picture))).toEqual([])
})

it('has small pictures', () => {
  for (const picture of drawn) {
    expect([picture, statSync(`${pictures}${picture}.jpg`).size < 12_000]).toEqual([picture, true])
  }
})

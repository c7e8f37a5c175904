import { readdirSync, readFileSync } from 'node:fs'
import { fileURLToPath } from 'node:url'
import { expect, it } from 'vitest'
import { listStories } from '../src/gallery/listStories'

const folder = fileURLToPath(new URL('../src/', import.meta.url))
const baselines = fileURLToPath(new URL('../../e2e/visual/baselines/', import.meta.url))

it('has a story, with a name and a sentence, for each picture of the visual tests', () => {
  const files = readdirSync(folder).filter(file => file.endsWith('.stories.ts'))
  const stories = files.flatMap(
    file => listStories(`../${file}`, readFileSync(folder + file, 'utf8')).stories
  )
  const pictures = readdirSync(baselines)
    .filter(file => !file.endsWith('.webgl.png'))
    .map(file => file.replace('.png', ''))
  const listed = new Set(stories.map(({ picture }) => picture))
  expect(pictures.filter(picture => !listed.has(picture))).toEqual([])
  expect(new Set(stories.map(({ id }) => id)).size).toBe(stories.length)
  for (const { id, name } of stories) {
    expect(id).toMatch(/^[a-z\d-]+--[a-z\d-]+$/)
    expect(name).not.toBe('')
  }
})

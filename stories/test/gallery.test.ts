import { readdirSync, readFileSync } from 'node:fs'
import { fileURLToPath } from 'node:url'
import { expect, it } from 'vitest'
import { listStories, withPictures } from '../src/gallery/listStories'

const folder = fileURLToPath(new URL('../src/', import.meta.url))
const baselines = fileURLToPath(new URL('../../e2e/visual/baselines/', import.meta.url))

const files = readdirSync(folder).filter(file => file.endsWith('.stories.ts'))
const storiesOf = (file: string) =>
  listStories(`../${file}`, readFileSync(folder + file, 'utf8')).stories
const pictures = readdirSync(baselines)
  .filter(file => !file.endsWith('.webgl.png'))
  .map(file => file.replace('.png', ''))

it('has a story, with a name and a sentence, for each picture of the visual tests', () => {
  const stories = files.flatMap(storiesOf)
  const listed = new Set(stories.map(({ picture }) => picture))
  expect(pictures.filter(picture => !listed.has(picture))).toEqual([])
  expect(new Set(stories.map(({ id }) => id)).size).toBe(stories.length)
  for (const { id, name } of stories) {
    expect(id).toMatch(/^[a-z\d-]+--[a-z\d-]+$/)
    expect(name).not.toBe('')
  }
})

it.each(files)('has all stories of %s, none without a picture', file => {
  const stories = storiesOf(file)
  // As many as there are in the code, however they are written.
  const exported = readFileSync(folder + file, 'utf8').match(/^export const \w+/gm) ?? []
  expect(stories).toHaveLength(exported.length)
  const entries = withPictures(stories, picture => pictures.includes(picture))
  expect(entries.map(({ id }) => id)).toEqual(stories.map(({ id }) => id))
  for (const [i, { picture, pictureOf }] of entries.entries()) {
    expect(pictures).toContain(picture)
    const isOwn = picture === stories[i].picture
    expect(pictureOf).toBe(
      isOwn ? undefined : stories.find(story => story.picture === picture)!.name
    )
    if (pictures.includes(stories[i].picture)) expect(isOwn).toBe(true)
  }
})

it('lends the picture of the story that has most in common, of equals the first', () => {
  const traits = [['day'], ['night'], ['dusk'], ['night', "planet: 'mars'"], ["planet: 'mars'"]]
  const stories = traits.map((each, i) => ({
    id: `globe--${i}`,
    name: `${i}`,
    about: '',
    picture: `globe-${i}`,
    traits: each
  }))
  const lent = (...own: number[]): (string | undefined)[] =>
    withPictures(stories, picture => own.some(i => picture === `globe-${i}`)).map(
      ({ pictureOf }) => pictureOf
    )
  expect(lent(0, 1, 4)).toEqual([undefined, undefined, '0', '1', undefined])
  expect(lent(0, 3)).toEqual([undefined, '3', '0', undefined, '3'])
  expect(lent()).toEqual([])
})

it("has a story's words and arguments for traits", () => {
  const source =
    "export const MarsNoon: Story = { name: 'A', args: { planet: 'mars', height: 2 } }\n"
  const [{ traits }] = listStories('../planets.stories.ts', source).stories
  expect(traits).toEqual(['mars', 'noon', "planet: 'mars'"])
})

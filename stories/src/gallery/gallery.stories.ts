import type { Meta, StoryObj } from '@storybook/html-vite'
import { listStories, type ListedStory } from './listStories'

/** Sources of the stories, pictures that tests compare them with, and those that `npm run gallery` draws of the others. */
const sources = import.meta.glob<string>('../*.stories.ts', {
  query: '?raw',
  import: 'default',
  eager: true
})
const pictures = import.meta.glob<string>(
  ['../../../e2e/visual/baselines/*.png', '../../pictures/*.jpg'],
  { query: '?url', import: 'default', eager: true }
)

const STYLE = `
  .gallery { min-height: 100vh; padding: 24px; background: #05070a; color: #e8edf2; font: 13px/1.4 system-ui, sans-serif }
  .gallery h2 { margin: 24px 0 8px; font-size: 17px; font-weight: 600 }
  .gallery section { display: grid; grid-template-columns: repeat(auto-fill, minmax(240px, 1fr)); gap: 12px }
  .gallery a { color: inherit; text-decoration: none }
  .gallery img { display: block; width: 100%; aspect-ratio: 16 / 9; object-fit: cover; border-radius: 6px }
  .gallery b { display: block; margin-top: 4px }
`

const urlOf = (picture: string): string | undefined =>
  pictures[`../../../e2e/visual/baselines/${picture}.png`] ??
  pictures[`../../pictures/${picture}.jpg`]

/** A story's picture, name and sentence, which lead to it. */
function tile({ id, name, about, picture }: ListedStory): HTMLElement {
  const link = document.createElement('a')
  link.href = `?path=/story/${id}`
  // The page around the story's own.
  link.target = '_top'
  const image = document.createElement('img')
  Object.assign(image, { src: urlOf(picture), alt: name, loading: 'lazy' })
  const title = document.createElement('b')
  title.textContent = name
  const text = document.createElement('span')
  text.textContent = about
  link.append(image, title, text)
  return link
}

/** All stories, by their titles. */
function gallery(): HTMLElement {
  const page = document.createElement('div')
  page.className = 'gallery'
  const style = document.createElement('style')
  style.textContent = STYLE
  page.append(style)
  for (const [file, source] of Object.entries(sources)) {
    const { title, stories } = listStories(file, source)
    const shown = stories.filter(({ picture }) => urlOf(picture) !== undefined).map(tile)
    if (shown.length === 0) continue
    const heading = document.createElement('h2')
    heading.textContent = title
    const section = document.createElement('section')
    section.append(...shown)
    page.append(heading, section)
  }
  return page
}

const meta: Meta = {
  title: 'Gallery',
  render: gallery,
  parameters: { controls: { disable: true } }
}

export default meta

/** A picture of each feature; a click opens its story, which has the code. */
export const Features: StoryObj = {}

import { readFileSync, readdirSync } from 'node:fs'
import { fileURLToPath } from 'node:url'
import { expect, it } from 'vitest'

const root = fileURLToPath(new URL('../..', import.meta.url))

/** TypeScript files of the repository by path, with their text. */
const sources = ['packages', 'stories', 'e2e', 'scripts'].flatMap(folder =>
  readdirSync(`${root}/${folder}`, { recursive: true, encoding: 'utf8' })
    .filter(file => file.endsWith('.ts') && !/(^|\/)(node_modules|dist|output)\//.test(file))
    .map(file => {
      const path = `${folder}/${file.replaceAll('\\', '/')}`
      return { path, text: readFileSync(`${root}/${path}`, 'utf8') }
    })
)
const published = sources.filter(({ path }) => /^packages\/[^/]+\/src\//.test(path))

/** Lines that a file may have: shader functions about 200, nodes about 350, anything 500. */
function mostLines(path: string): number {
  if (!path.includes('/src/')) return 500
  return path.includes('/tsl/') ? 210 : 350
}

it('no file is longer than a reader takes in', () => {
  const long = sources
    .map(({ path, text }) => ({ path, lines: text.split('\n').length - 1 }))
    .filter(({ path, lines }) => lines > mostLines(path))
    .map(({ path, lines }) => `${path}: ${lines} lines of ${mostLines(path)}`)
  expect(long).toEqual([])
})

it('docs name their thing first', () => {
  const opening = /\/\*\*[\s*]*(?:Of|By|What|Where|Whether|How|Which|So|The same|From)\b[^\n]*/g
  const hidden = sources.flatMap(({ path, text }) =>
    [...text.matchAll(opening)].map(([doc]) => `${path}: ${doc.replaceAll(/\s+/g, ' ')}`)
  )
  expect(hidden).toEqual([])
})

it('tests and twins stay out of what is published', () => {
  const crossing = published.flatMap(({ path, text }) =>
    [...text.matchAll(/from '(\.[^']*)'/g)]
      .filter(([, name]) => /(^|\/)(test|scripts|e2e|stories)\//.test(name))
      .map(([, name]) => `${path} imports ${name}`)
  )
  expect(crossing).toEqual([])
})

it('imports only public entry points of three', () => {
  const entries = /^three(\/webgpu|\/tsl|\/addons\/.*)?$/
  const inner = sources.flatMap(({ path, text }) =>
    [...text.matchAll(/from '(three[^']*)'/g)]
      .filter(([, name]) => !entries.test(name))
      .map(([, name]) => `${path} imports ${name}`)
  )
  expect(inner).toEqual([])
})

import { readFileSync } from 'node:fs'
import { expect, it } from 'vitest'
import { codeRegion } from '../src/codeRegion'

const read = (file: string): string =>
  readFileSync(new URL(`../../${file}`, import.meta.url), 'utf8')

/** The first TypeScript block below the heading of the quick start. */
function quickStartBlock(markdown: string): string {
  return markdown.match(/^## Quick start\n[^]*?```ts\n([^]*?)```/m)?.[1] ?? ''
}

const importedNames = (source: string): string[] =>
  (source.match(/import \{([^}]*)\} from '@welkin\/atmosphere'/)?.[1] ?? '')
    .split(',')
    .map(name => name.trim())

const source = read('stories/src/quickStart.ts')
const lines = codeRegion(source, 'quick start')

it('takes no more than ten lines', () => {
  const count = lines.split('\n').filter(line => line !== '').length
  expect(count).toBeGreaterThan(0)
  expect(count).toBeLessThanOrEqual(10)
})

/** Lines of code without comments and indentation. */
const bareLines = (code: string): string[] =>
  code
    .split('\n')
    .map(line => line.replace(/\/\/ .*$/, '').trim())
    .filter(line => line !== '')

it('puts a model from a file under that sky, its lamps lit at dusk, in ten lines more', () => {
  const story = read('stories/src/importedModel.scene.ts')
  const code = ['model', 'lamps'].flatMap(name => bareLines(codeRegion(story, name)))
  expect(code.length).toBeGreaterThan(0)
  expect(code.length).toBeLessThanOrEqual(10)
  const [, section] = read('README.md').split('## An imported model\n')
  const block = bareLines(section.match(/```ts\n([^]*?)```/)?.[1] ?? '')
  expect(block.filter(line => code.includes(line)).slice(0, code.length)).toEqual(code)
})

it.each(['README.md', 'packages/atmosphere/README.md'])('%s has the very lines', file => {
  const block = quickStartBlock(read(file))
  expect(block.split(`\n\n${lines}\n\n`)).toHaveLength(2)
  expect(importedNames(block)).toEqual(importedNames(source))
})

it('is one and the same block in both documents', () => {
  expect(quickStartBlock(read('packages/atmosphere/README.md'))).toBe(
    quickStartBlock(read('README.md'))
  )
})

it('finds a region, and says which one it lacks', () => {
  expect(codeRegion('a\n  // #region b\n  if (c)\n    d\n  // #endregion\ne', 'b')).toBe(
    'if (c)\n  d'
  )
  expect(() => codeRegion('// #region a', 'a')).toThrow("source must have a region 'a'")
})

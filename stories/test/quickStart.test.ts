import { readFileSync } from 'node:fs'
import { expect, it } from 'vitest'
import { codeRegion } from '../src/codeRegion'

const read = (file: string): string =>
  readFileSync(new URL(`../../${file}`, import.meta.url), 'utf8')

/** The first TypeScript block below a heading. */
function blockBelow(heading: string, markdown: string): string {
  return (
    markdown.match(new RegExp(`^## ${heading}\\n[^]*?\`\`\`ts\\n([^]*?)\`\`\``, 'm'))?.[1] ?? ''
  )
}

const quickStartBlock = (markdown: string): string => blockBelow('Quick start', markdown)

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

/** Lines as one text in which whole lines are found. */
const joined = (parts: readonly string[]): string => `\n${parts.join('\n')}\n`

it('puts a model from a file under that sky, its lamps lit at dusk, in ten lines more', () => {
  const story = read('stories/src/importedModel.scene.ts')
  const parts = ['model', 'lamps'].map(name => bareLines(codeRegion(story, name)))
  const count = parts.flat().length
  expect(count).toBeGreaterThan(0)
  expect(count).toBeLessThanOrEqual(10)
  const block = joined(bareLines(blockBelow('An imported model', read('README.md'))))
  for (const part of parts) expect(block).toContain(joined(part))
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

import { readdirSync, readFileSync } from 'node:fs'
import { fileURLToPath } from 'node:url'
import { describe, expect, it } from 'vitest'
import { codeRegion } from '../src/codeRegion'

const folder = fileURLToPath(new URL('../src/', import.meta.url))
const read = (file: string): string => readFileSync(folder + file, 'utf8')
const files = readdirSync(folder, { recursive: true, encoding: 'utf8' }).map(file =>
  file.replaceAll('\\', '/')
)

/** The regions that a story file shows, as `FILE: NAME`. */
function shownBy(file: string): string[] {
  const calls = read(file).matchAll(/storyCode\('([^']+)', (?:'([^']+)'|"([^"]+)")\)/g)
  return [...calls].map(([, source, name, quoted]) => `${source}: ${name ?? quoted}`)
}

const linesOf = (region: string): string[] => {
  const [source, name] = region.split(': ')
  return codeRegion(read(source), name)
    .split('\n')
    .filter(line => line.trim() !== '')
}

const storyFiles = files.filter(file => /^[^/]+\.stories\.ts$/.test(file))

describe.each(storyFiles)('%s', file => {
  const regions = shownBy(file)

  it('shows code', () => {
    expect(regions.flatMap(linesOf).length).toBeGreaterThan(0)
  })

  it.each(regions)('%s is short, and of no story', region => {
    const lines = linesOf(region)
    expect(lines.length).toBeGreaterThan(0)
    expect(lines.length).toBeLessThanOrEqual(16)
    expect(lines.join('\n')).not.toMatch(/\b(args|current|this)\b/)
    for (const line of lines) expect(line.length).toBeLessThanOrEqual(100)
  })
})

it('leaves no region unseen', () => {
  const marked = files
    .filter(file => file.endsWith('.ts'))
    .flatMap(file =>
      [...read(file).matchAll(/^\s*\/\/ #region (.+)$/gm)].map(([, name]) => `${file}: ${name}`)
    )
  expect(new Set(storyFiles.flatMap(shownBy))).toEqual(new Set(marked))
})

it.each(storyFiles)('%s has a picture on both backends', file => {
  const tags = [...read(file).matchAll(/tags: \[([^\]]*)\]/g)].map(([, list]) => list)
  const shots = tags.filter(list => list.includes("'screenshot'"))
  expect(shots.length).toBeGreaterThan(0)
  expect(shots.some(list => !list.includes("'webgpu-only'"))).toBe(true)
})

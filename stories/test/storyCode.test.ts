import { execFileSync } from 'node:child_process'
import { mkdirSync, mkdtempSync, readdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs'
import { join } from 'node:path'
import { fileURLToPath } from 'node:url'
import { describe, expect, it } from 'vitest'
import { codeOf, codeRegion, type Region } from '../src/codeRegion'

const folder = fileURLToPath(new URL('../src/', import.meta.url))
const read = (file: string): string => readFileSync(folder + file, 'utf8')
const files = readdirSync(folder, { recursive: true, encoding: 'utf8' }).map(file =>
  file.replaceAll('\\', '/')
)

/** The regions that a story file shows. */
function regionsOf(file: string): Region[] {
  const [, list = ''] = /storyCode\(([^)]*)\)/.exec(read(file)) ?? []
  const regions = list.matchAll(/\['([^']+)', (?:'([^']+)'|"([^"]+)")\]/g)
  return [...regions].map(([, source, name, quoted]) => [source, name ?? quoted])
}

/** The regions that a story file shows, as `FILE: NAME`. */
const shownBy = (file: string): string[] => regionsOf(file).map(region => region.join(': '))

const linesOf = (region: string): string[] => {
  const [source, name] = region.split(': ')
  return codeRegion(read(source), name)
    .split('\n')
    .filter(line => line.trim() !== '' && !line.startsWith('import '))
}

/** All that the code of a story may take from the reader's own scene. */
const given = `import type { Atmosphere, SkyLightProbe, SunDirectionalLight } from '@welkin/atmosphere'
import type { PerspectiveCamera, Scene } from 'three'
import type { WebGPURenderer } from 'three/webgpu'

declare global {
  const renderer: WebGPURenderer
  const scene: Scene
  const camera: PerspectiveCamera
  const atmosphere: Atmosphere
  const sun: SunDirectionalLight
  const sky: SkyLightProbe
  const deltaSeconds: number
}
`

/** Compiles some modules, by name, together with the given names; returns what the compiler says. */
function compile(modules: Record<string, string>): string {
  const cache = fileURLToPath(new URL('../.cache/', import.meta.url))
  mkdirSync(cache, { recursive: true })
  const place = mkdtempSync(join(cache, 'code-'))
  try {
    writeFileSync(join(place, 'given.d.ts'), given)
    for (const [name, code] of Object.entries(modules)) {
      writeFileSync(join(place, `${name}.ts`), `${code}\nexport {}\n`)
    }
    const compilerOptions = { noUnusedLocals: false }
    const config = { extends: '../../../tsconfig.base.json', compilerOptions, include: ['*.ts'] }
    writeFileSync(join(place, 'tsconfig.json'), JSON.stringify(config))
    const tsc = fileURLToPath(new URL('../../node_modules/typescript/bin/tsc', import.meta.url))
    // Each checker goes through the packages' sources again: one takes half of the processor time of four.
    const args = [tsc, '-p', '.', '--checkers', '1']
    execFileSync(process.execPath, args, { cwd: place, encoding: 'utf8' })
    return ''
  } catch (error) {
    return (error as { stdout?: string }).stdout ?? String(error)
  } finally {
    rmSync(place, { recursive: true })
  }
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

it('stands alone: what a story shows compiles with its imports and a scene', () => {
  const modules = storyFiles.map(file => [file.split('.')[0], codeOf(regionsOf(file), read)])
  const broken = 'export const a = notThere'
  const said = compile({ ...(Object.fromEntries(modules) as Record<string, string>), broken })
  expect(said.trim()).toBe("broken.ts(1,18): error TS2304: Cannot find name 'notThere'.")
})

it('shows lines for readers, hides those of the story, and gathers imports', () => {
  const source = `import { a, b, type C } from 'd'
import type { E } from 'd'
import { f } from './g'
// #region one
// #shown import { h } from 'i'
// #shown const x = h(b) // by a
const x: E = f(a) // #hidden
// #endregion
// #region two
const y: C = { a: x }
// #endregion`
  expect(
    codeOf(
      [
        ['s.ts', 'one'],
        ['s.ts', 'two']
      ],
      () => source
    )
  ).toBe(
    `import { b, type C } from 'd'
import { h } from 'i'

const x = h(b) // by a

const y: C = { a: x }`
  )
})

it('leaves no region unseen', () => {
  const marked = files
    .filter(file => file.endsWith('.ts'))
    .flatMap(file =>
      [...read(file).matchAll(/^\s*\/\/ #region (.+)$/gm)].map(([, name]) => `${file}: ${name}`)
    )
  expect(new Set(storyFiles.flatMap(shownBy))).toEqual(new Set(marked))
})

it.each(storyFiles)('%s has a picture', file => {
  const tags = [...read(file).matchAll(/tags: \[([^\]]*)\]/g)].map(([, list]) => list)
  expect(tags.some(list => list.includes("'screenshot'"))).toBe(true)
})

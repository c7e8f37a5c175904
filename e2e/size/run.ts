import { readFileSync } from 'node:fs'
import { basename } from 'node:path'
import { fileURLToPath } from 'node:url'
import { gzipSync } from 'node:zlib'
import { build } from 'vite'
import { Report } from '../harness/report'

interface Budget {
  name: string
  /** Names by module; `*` stands for all of its exports. */
  imports: Record<string, string[] | '*'>
  /** Imports that the app has anyway: only what comes on top of them counts. */
  onTopOf?: Record<string, string[] | '*'>
  /**
   * Most bytes, minified and gzipped, with three left out: 5 % over what clear code takes. Where there is a goal
   * or a limit below that, there is less room.
   */
  budget: number
  /** Bytes that it was to take at most. Where it takes more, that is said, and the budget keeps it from growing. */
  goal?: number
  /** Text of the root README before and after the number of kB, where it states the size. */
  stated?: [before: string, after: string]
}

/** Difference of a stated size that goes as rounding [kB]. */
const ROUNDING = 0.1

/** The size that a page states between two words [kB]; NaN where there is none. */
function statedSize(page: string, [before, after]: [string, string]): number {
  const start = page.indexOf(before) + before.length
  return Number(page.slice(start, page.indexOf(after, start)))
}

const kilobytes = (bytes: number): string => `${(bytes / 1000).toFixed(2)} kB`

const folder = fileURLToPath(new URL('.', import.meta.url))
const entry = 'virtual:app'

/** Dependency of the packages whose part of a size is told apart. */
const DEPENDENCY = 'astronomy-engine'

/** Size of what an app takes along [bytes], and whether code of the dependency is in it. */
interface Size {
  bytes: number
  hasDependency: boolean
}

const sizes = new Map<string, Promise<Size>>()

/** Size of an app that uses some names; each app is built once. */
function sizeOf(imports: Budget['imports'][], external: string[]): Promise<Size> {
  const key = JSON.stringify([imports, external])
  const size = sizes.get(key) ?? buildSize(imports, external)
  sizes.set(key, size)
  return size
}

/** Minifies what an app takes along that uses these names of the built packages, as the quick starts have it: by Vite. */
async function buildSize(imports: Budget['imports'][], external: string[]): Promise<Size> {
  const lines = imports
    .flatMap(Object.entries<string[] | '*'>)
    .map(([module, names]) =>
      names === '*'
        ? `export * from '${module}'`
        : `export { ${names.join(', ')} } from '${module}'`
    )
  const result = await build({
    root: folder,
    configFile: false,
    logLevel: 'error',
    publicDir: false,
    plugins: [
      {
        name: 'welkin:app',
        // As if it were a file here: packages are found from this folder.
        resolveId: id => (id === entry ? `${folder}${basename(entry)}.js` : undefined),
        load: id => (id.endsWith(`${basename(entry)}.js`) ? lines.join('\n') : undefined)
      }
    ],
    build: {
      write: false,
      target: 'es2022',
      minify: true,
      modulePreload: { polyfill: false },
      rolldownOptions: {
        input: entry,
        preserveEntrySignatures: 'strict',
        external: ['three', /^three\//, ...external]
      }
    }
  })
  const [{ output }] = [result].flat() as { output: { code?: string; moduleIds?: string[] }[] }[]
  const code = output.map(chunk => chunk.code ?? '').join('')
  const modules = output.flatMap(({ moduleIds = [] }) => moduleIds)
  return {
    bytes: gzipSync(code, { level: 9 }).length,
    hasDependency: modules.some(id => id.includes(`/${DEPENDENCY}/`))
  }
}

const file = new URL('budgets.json', import.meta.url)
const budgets = JSON.parse(readFileSync(file, 'utf8')) as Budget[]
const report = new Report()

const readme = readFileSync(new URL('../../README.md', import.meta.url), 'utf8')
for (const { name, imports, onTopOf = {}, budget, goal = budget, stated } of budgets) {
  try {
    const [whole, base] = [await sizeOf([onTopOf, imports], []), await sizeOf([onTopOf], [])]
    const total = whole.bytes - base.bytes
    const withoutDependency = async (size: Size, names: Budget['imports'][]): Promise<number> =>
      size.hasDependency ? (await sizeOf(names, [DEPENDENCY])).bytes : size.bytes
    const own =
      (await withoutDependency(whole, [onTopOf, imports])) -
      (await withoutDependency(base, [onTopOf]))
    const missed = total > goal ? `, ${kilobytes(total - goal)} over its goal` : ''
    report.check(
      total <= budget,
      name,
      `${kilobytes(total)} of ${kilobytes(budget)} gzipped, of which ${DEPENDENCY} ${kilobytes(total - own)}${missed}`
    )
    if (stated !== undefined) {
      const size = statedSize(readme, stated)
      report.check(
        Math.abs(size - total / 1000) <= ROUNDING,
        `README states the size of: ${name}`,
        `${size} kB stated, ${kilobytes(total)} found`
      )
    }
  } catch (error) {
    report.fail(name, error instanceof Error ? error.message : String(error))
  }
}
report.finish()

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

/** Minifies what an app takes along that uses these names of the built packages, as the quick starts have it: by Vite. */
async function gzippedSize(imports: Budget['imports'][], external: string[]): Promise<number> {
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
  const [{ output }] = [result].flat() as { output: { code?: string }[] }[]
  const code = output.map(chunk => chunk.code ?? '').join('')
  return gzipSync(code, { level: 9 }).length
}

const file = new URL('budgets.json', import.meta.url)
const budgets = JSON.parse(readFileSync(file, 'utf8')) as Budget[]
const report = new Report()

const readme = readFileSync(new URL('../../README.md', import.meta.url), 'utf8')
for (const { name, imports, onTopOf = {}, budget, goal = budget, stated } of budgets) {
  try {
    const added = async (external: string[]): Promise<number> =>
      (await gzippedSize([onTopOf, imports], external)) - (await gzippedSize([onTopOf], external))
    const total = await added([])
    const own = await added(['astronomy-engine'])
    const missed = total > goal ? `, ${kilobytes(total - goal)} over its goal` : ''
    report.check(
      total <= budget,
      name,
      `${kilobytes(total)} of ${kilobytes(budget)} gzipped, of which astronomy-engine ${kilobytes(total - own)}${missed}`
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

import { readFileSync } from 'node:fs'
import { fileURLToPath } from 'node:url'
import { gzipSync } from 'node:zlib'
import { build } from 'esbuild'
import { Report } from '../harness/report'

interface Budget {
  name: string
  /** Names by module; `*` stands for all of its exports. */
  imports: Record<string, string[] | '*'>
  /** What the app has anyway: only what comes on top of it counts. */
  onTopOf?: Record<string, string[] | '*'>
  /** Most bytes, minified and gzipped, with three left out. */
  budget: number
}

const kilobytes = (bytes: number): string => `${(bytes / 1000).toFixed(2)} kB`

/** Minifies what an app takes along that uses these names of the built packages. */
async function gzippedSize(imports: Budget['imports'][], external: string[]): Promise<number> {
  const lines = imports
    .flatMap(Object.entries<string[] | '*'>)
    .map(([module, names]) =>
      names === '*'
        ? `export * from '${module}'`
        : `export { ${names.join(', ')} } from '${module}'`
    )
  const { outputFiles } = await build({
    stdin: { contents: lines.join('\n'), resolveDir: fileURLToPath(new URL('.', import.meta.url)) },
    bundle: true,
    minify: true,
    write: false,
    format: 'esm',
    target: 'es2022',
    legalComments: 'none',
    logLevel: 'silent',
    external: ['three', 'three/*', ...external],
    // The built files, as a user gets them, not the sources that tsconfig's paths lead to.
    tsconfigRaw: {}
  })
  return gzipSync(outputFiles[0].contents, { level: 9 }).length
}

const file = new URL('budgets.json', import.meta.url)
const budgets = JSON.parse(readFileSync(file, 'utf8')) as Budget[]
const report = new Report()

for (const { name, imports, onTopOf = {}, budget } of budgets) {
  try {
    const added = async (external: string[]): Promise<number> =>
      (await gzippedSize([onTopOf, imports], external)) - (await gzippedSize([onTopOf], external))
    const total = await added([])
    const own = await added(['astronomy-engine'])
    report.check(
      total <= budget,
      name,
      `${kilobytes(total)} of ${kilobytes(budget)} gzipped, of which astronomy-engine ${kilobytes(total - own)}`
    )
  } catch (error) {
    report.fail(name, error instanceof Error ? error.message : String(error))
  }
}
report.finish()

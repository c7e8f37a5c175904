import { build } from 'esbuild'
import { resolve } from 'node:path'
import { sourceAliases } from '../../scripts/aliases'

/** CommonJS packages in the bundle ask for Node's modules by `require`. */
const banner = `import { createRequire } from 'node:module'
const require = createRequire(import.meta.url)`

const [entry, outfile] = process.argv.slice(2)
if (entry === undefined || outfile === undefined) {
  throw new Error('headless: bundle.ts takes a program and the file to write')
}
/** Bundles a program into one ES module that needs nothing but Node and the package `webgpu`. */
await build({
  entryPoints: [entry],
  outfile: resolve(outfile),
  bundle: true,
  platform: 'node',
  format: 'esm',
  target: 'node20',
  external: ['webgpu'],
  alias: sourceAliases,
  banner: { js: banner },
  logLevel: 'warning'
})
// Standard output is for the program's figures.
console.error(resolve(outfile))

import { build } from 'esbuild'
import { resolve } from 'node:path'
import { sourceAliases } from '../../scripts/aliases'

/** Bundles the benchmark into one ES module that needs nothing but the package `webgpu`. */
const outfile = resolve(process.argv[2] ?? 'e2e/output/bench.mjs')
await build({
  entryPoints: ['e2e/bench/main.ts'],
  outfile,
  bundle: true,
  platform: 'node',
  format: 'esm',
  target: 'node20',
  external: ['webgpu'],
  alias: sourceAliases,
  logLevel: 'warning'
})
// Standard output is for the figures.
console.error(outfile)

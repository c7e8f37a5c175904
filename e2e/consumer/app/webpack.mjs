// Bundles the quick start as a second tool does, into the folder that Vite built.
import { writeFileSync } from 'node:fs'
import { fileURLToPath } from 'node:url'
import webpack from 'webpack'

const folder = fileURLToPath(new URL('dist', import.meta.url))
const options = {
  mode: 'production',
  entry: './webpack-entry.js',
  output: { path: folder, filename: 'webpack.js' },
  performance: { hints: false }
}
webpack(options, (error, stats) => {
  if (error || stats.hasErrors() || stats.hasWarnings()) {
    console.error(error ?? stats.toString({ all: false, errors: true, warnings: true }))
    process.exitCode = 1
  }
})
const page =
  '<!doctype html><meta charset="utf-8" /><title>webpack</title><body><script src="webpack.js"></script>'
writeFileSync('dist/webpack.html', page)

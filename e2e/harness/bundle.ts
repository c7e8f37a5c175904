import { rmSync } from 'node:fs'
import { basename, dirname, join } from 'node:path'
import { build, type Plugin } from 'vite'
import { sourceAliases } from '../../scripts/aliases'
import { outputFolder } from './report'

/** The page's `virtual:modules`: its test files by name, each loaded when asked for. */
function modulesPlugin(files: Record<string, string>): Plugin {
  const lines = Object.entries(files).map(
    ([name, file]) => `${JSON.stringify(name)}: () => import(${JSON.stringify(file)})`
  )
  return {
    name: 'welkin:modules',
    resolveId: id => (id === 'virtual:modules' ? '\0virtual:modules' : undefined),
    load: id =>
      id === '\0virtual:modules' ? `export const modules = {${lines.join(',')}}` : undefined
  }
}

/**
 * Bundles one page of tests with the packages' sources; answers with the folder to serve.
 * A build rather than a dev server: nothing reloads while a test runs, and `sideEffects: false`
 * acts as it will in a user's bundle.
 *
 * @param root - Folder of the page's `index.html`.
 * @param files - Test modules by name; one that does not compile fails only runs that select it.
 */
export async function bundlePage(
  root: string,
  files: Record<string, string>,
  plugins: Plugin[] = []
): Promise<string> {
  // Of this process alone: two runs at once must not empty each other's folder.
  const outDir = join(outputFolder, 'pages', `${basename(dirname(root))}-${process.pid}`)
  process.once('exit', () => rmSync(outDir, { recursive: true, force: true }))
  await build({
    root,
    configFile: false,
    logLevel: 'warn',
    base: './',
    publicDir: false,
    plugins: [modulesPlugin(files), ...plugins],
    resolve: { alias: sourceAliases, dedupe: ['three'] },
    build: {
      outDir,
      emptyOutDir: true,
      target: 'es2022',
      minify: false,
      assetsInlineLimit: 0,
      chunkSizeWarningLimit: 100_000,
      rolldownOptions: { checks: { pluginTimings: false } }
    }
  })
  return outDir
}

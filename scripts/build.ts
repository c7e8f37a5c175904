import { spawnSync } from 'node:child_process'
import { existsSync, readdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs'
import { createRequire } from 'node:module'
import { dirname, isAbsolute, join } from 'node:path'
import { fileURLToPath } from 'node:url'
import { build } from 'vite'

const packagesFolder = fileURLToPath(new URL('../packages', import.meta.url))

// A package's declarations are checked against the declarations of those before it.
const order = ['geo', 'atmosphere', 'clouds', 'terrain']

/** One output module per source module, so that a bundler drops those that nobody imports. */
async function buildModules(folder: string): Promise<void> {
  await build({
    root: folder,
    configFile: false,
    logLevel: 'warn',
    publicDir: false,
    build: {
      target: 'es2022',
      outDir: 'dist',
      emptyOutDir: true,
      minify: false,
      sourcemap: true,
      lib: { entry: 'src/index.ts', formats: ['es'] },
      rolldownOptions: {
        external: id => /^[@a-z]/i.test(id) && !isAbsolute(id),
        output: {
          preserveModules: true,
          preserveModulesRoot: join(folder, 'src'),
          entryFileNames: '[name].js'
        }
      }
    }
  })
}

/** Sources import `./Name`; Node's resolution wants `./Name.js` in the declarations too. */
function addExtensions(file: string): void {
  const source = readFileSync(file, 'utf8')
  const resolved = source.replace(
    /(\bfrom |\bimport\(|\bimport )(['"])(\.{1,2}\/[^'"]*|\.{1,2})\2/g,
    (_, keyword: string, quote: string, specifier: string) => {
      const path = specifier.replace(/\.(ts|js)$/, '')
      const isFolder = !existsSync(join(dirname(file), `${path}.d.ts`))
      return `${keyword}${quote}${path}${isFolder ? '/index' : ''}.js${quote}`
    }
  )
  writeFileSync(file, resolved)
}

function buildDeclarations(folder: string): void {
  const tsc = createRequire(import.meta.url).resolve('typescript/package.json')
  const { status } = spawnSync(
    process.execPath,
    [join(dirname(tsc), 'bin', 'tsc'), '-p', join(folder, 'tsconfig.build.json')],
    { stdio: 'inherit' }
  )
  if (status !== 0) throw new Error(`no declarations for ${folder}`)
  const dist = join(folder, 'dist')
  for (const file of readdirSync(dist, { recursive: true, encoding: 'utf8' })) {
    if (file.endsWith('.d.ts')) addExtensions(join(dist, file))
  }
}

for (const name of order) {
  const folder = join(packagesFolder, name)
  rmSync(join(folder, 'dist'), { recursive: true, force: true })
}
for (const name of order) {
  const folder = join(packagesFolder, name)
  if (!existsSync(join(folder, 'src', 'index.ts'))) {
    throw new Error(`packages/${name} has no src/index.ts`)
  }
  await buildModules(folder)
  buildDeclarations(folder)
  console.log(`built packages/${name}/dist`)
}

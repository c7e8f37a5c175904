import { spawnSync } from 'node:child_process'
import {
  copyFileSync,
  existsSync,
  mkdirSync,
  mkdtempSync,
  readFileSync,
  rmSync,
  writeFileSync
} from 'node:fs'
import { tmpdir } from 'node:os'
import { dirname, join } from 'node:path'
import { fileURLToPath } from 'node:url'

const root = fileURLToPath(new URL('..', import.meta.url))
const [version, only = 'types,unit,gpu'] = process.argv.slice(2)
if (version === undefined) {
  console.error('npm run test:three -- VERSION [STEPS]     e.g. 0.188.0, or latest')
  process.exit(1)
}

interface Manifest {
  devDependencies: Record<string, string>
  peerDependencies: Record<string, string>
  overrides: Record<string, string>
}

function execute(command: string, args: string[], cwd: string): { ok: boolean; output: string } {
  const { status, stdout } = spawnSync(command, args, {
    cwd,
    encoding: 'utf8',
    stdio: ['ignore', 'pipe', 'inherit'],
    shell: process.platform === 'win32'
  })
  return { ok: status === 0, output: stdout }
}

function editManifest(file: string, edit: (manifest: Manifest) => void): void {
  const manifest = JSON.parse(readFileSync(file, 'utf8')) as Manifest
  edit(manifest)
  writeFileSync(file, JSON.stringify(manifest, null, 2))
}

/** The released version that a range or tag stands for; of several, the newest. */
function resolveVersion(specifier: string): string | undefined {
  const { ok, output } = execute('npm', ['view', specifier, 'version', '--json'], root)
  if (!ok || output.trim() === '') return undefined
  const found = JSON.parse(output) as string | string[]
  return typeof found === 'string' ? found : found.at(-1)
}

const three = resolveVersion(`three@${version}`)
if (three === undefined) throw new Error(`three has no version ${version}`)
const minor = three.split('.').slice(0, 2).join('.')
const types = resolveVersion(`@types/three@~${minor}.0`)
console.log(`three ${three}, @types/three ${types ?? 'of the workspace: none is out for this one'}`)

const copy = mkdtempSync(join(tmpdir(), 'welkin-three-'))
try {
  const { output } = execute('git', ['ls-files', '-co', '--exclude-standard', '-z'], root)
  for (const file of output.split('\0').filter(name => name !== '')) {
    // Git still lists a file that was deleted but not committed.
    if (!existsSync(join(root, file))) continue
    const target = join(copy, file)
    mkdirSync(dirname(target), { recursive: true })
    copyFileSync(join(root, file), target)
  }
  editManifest(join(copy, 'package.json'), manifest => {
    manifest.devDependencies.three = three
    if (types !== undefined) manifest.devDependencies['@types/three'] = types
    // Packages of others that ask for a three of their own get this one.
    manifest.overrides = { three }
  })
  for (const name of ['geo', 'atmosphere', 'clouds', 'terrain']) {
    editManifest(join(copy, 'packages', name, 'package.json'), manifest => {
      manifest.peerDependencies.three = three
    })
  }
  const install = ['install', '--no-audit', '--no-fund', '--loglevel=error']
  if (!execute('npm', install, copy).ok) throw new Error('npm install failed')
  const { status } = spawnSync(process.execPath, ['scripts/test.mjs', '--only', only], {
    cwd: copy,
    stdio: 'inherit'
  })
  process.exitCode = status ?? 1
} finally {
  rmSync(copy, { recursive: true, force: true })
}

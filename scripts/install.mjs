// Runs before anything is installed: Node's own modules only.
import { spawnSync } from 'node:child_process'
import { readFileSync } from 'node:fs'
import { fileURLToPath } from 'node:url'

export const rootFolder = fileURLToPath(new URL('..', import.meta.url))

function readPackages(file) {
  try {
    return JSON.parse(readFileSync(new URL(`../${file}`, import.meta.url), 'utf8')).packages
  } catch {
    return undefined
  }
}

/** True if node_modules holds the versions that the lock file names. */
function isInstalled() {
  const wanted = readPackages('package-lock.json')
  const present = readPackages('node_modules/.package-lock.json')
  if (wanted === undefined || present === undefined) return false
  return Object.entries(wanted).every(
    ([path, entry]) =>
      !path.includes('node_modules/') ||
      entry.optional === true ||
      present[path]?.version === entry.version
  )
}

/** Path and leading arguments of the npm that started this script, or else of the PATH's. */
export function npmCommand() {
  const script = process.env.npm_execpath
  if (script !== undefined && script.endsWith('.js')) {
    return { command: process.execPath, prefix: [script], shell: false }
  }
  return { command: 'npm', prefix: [], shell: process.platform === 'win32' }
}

function requireNode() {
  const [major, minor] = process.versions.node.split('.').map(Number)
  if (major > 20 || (major === 20 && minor >= 19)) return
  console.error(`Node 20.19 or newer is needed; this is ${process.versions.node}.`)
  process.exit(1)
}

/** Installs the dependencies when they are missing or not those of the lock file. */
export function ensureInstalled() {
  requireNode()
  if (isInstalled()) return
  console.log('Installing dependencies (npm ci)…')
  const { command, prefix, shell } = npmCommand()
  const { status } = spawnSync(command, [...prefix, 'ci', '--no-audit', '--no-fund'], {
    cwd: rootFolder,
    stdio: 'inherit',
    shell
  })
  if (status !== 0) {
    console.error('npm ci failed.')
    process.exit(status ?? 1)
  }
}

import { execFileSync, spawnSync } from 'node:child_process'
import { existsSync } from 'node:fs'
import { createRequire } from 'node:module'
import { chromium, type Browser } from 'playwright-core'

/** Software WebGPU and WebGL2, the same pixels on every machine. */
export const chromiumFlags = [
  '--enable-unsafe-webgpu',
  '--use-webgpu-adapter=swiftshader',
  '--enable-features=Vulkan',
  '--use-vulkan=swiftshader',
  '--use-angle=swiftshader',
  '--disable-vulkan-surface'
]

const commands = ['chromium', 'chromium-browser', 'google-chrome', 'google-chrome-stable', 'chrome']

const applications = [
  '/Applications/Chromium.app/Contents/MacOS/Chromium',
  '/Applications/Google Chrome.app/Contents/MacOS/Google Chrome',
  ...[process.env.PROGRAMFILES, process.env['PROGRAMFILES(X86)'], process.env.LOCALAPPDATA]
    .filter(folder => folder !== undefined)
    .map(folder => `${folder}\\Google\\Chrome\\Application\\chrome.exe`)
]

function findCommand(name: string): string | undefined {
  const finder = process.platform === 'win32' ? 'where' : 'which'
  const { status, stdout } = spawnSync(finder, [name], { encoding: 'utf8' })
  return status === 0 ? stdout.split(/\r?\n/)[0] : undefined
}

function findSystemChromium(): string | undefined {
  for (const command of commands) {
    const path = findCommand(command)
    if (path !== undefined) return path
  }
  return applications.find(path => existsSync(path))
}

function findPlaywrightChromium(): string | undefined {
  const path = chromium.executablePath()
  return path !== '' && existsSync(path) ? path : undefined
}

function downloadWithPlaywright(): void {
  const cli = createRequire(import.meta.url)
    .resolve('playwright-core/package.json')
    .replace('package.json', 'cli.js')
  spawnSync(process.execPath, [cli, 'install', '--no-shell', 'chromium'], {
    stdio: ['ignore', 'inherit', 'ignore'],
    timeout: 300_000,
    env: { ...process.env, PLAYWRIGHT_DOWNLOAD_CONNECTION_TIMEOUT: '5000' }
  })
}

function installWithApt(): void {
  if (process.platform !== 'linux' || process.getuid?.() !== 0) return
  if (findCommand('apt-get') === undefined) return
  const env = { ...process.env, DEBIAN_FRONTEND: 'noninteractive' }
  const options = { stdio: 'inherit', timeout: 600_000, env } as const
  spawnSync('apt-get', ['update', '-q'], options)
  spawnSync('apt-get', ['install', '-y', '-q', '--no-install-recommends', 'chromium'], options)
}

/**
 * Path of a Chromium: `CHROMIUM_PATH`, the system's, Playwright's; where there is none, it
 * tries Playwright's download and then, as root on Debian, the distribution's package.
 */
export function resolveChromium(): string {
  const explicit = process.env.CHROMIUM_PATH
  if (explicit !== undefined && explicit !== '') {
    if (existsSync(explicit)) return explicit
    throw new Error(`CHROMIUM_PATH names no file: ${explicit}`)
  }
  const found = findSystemChromium() ?? findPlaywrightChromium()
  if (found !== undefined) return found

  console.log('No Chromium found: trying to install one.')
  downloadWithPlaywright()
  const downloaded = findPlaywrightChromium()
  if (downloaded !== undefined) return downloaded
  installWithApt()
  const installed = findSystemChromium()
  if (installed !== undefined) return installed
  throw new Error(
    'No Chromium: install Chromium or Google Chrome, or set CHROMIUM_PATH to its executable.'
  )
}

/** A headless Chromium on software WebGPU and WebGL2. The caller closes it. */
export async function launchChromium(extraFlags: string[] = []): Promise<Browser> {
  return chromium.launch({
    executablePath: resolveChromium(),
    headless: true,
    chromiumSandbox: process.platform === 'linux' && process.getuid?.() !== 0,
    args: [...chromiumFlags, ...extraFlags]
  })
}

/** Version line of the Chromium that the tests run in. */
export function describeChromium(): string {
  const path = resolveChromium()
  if (process.platform === 'win32') return path
  return execFileSync(path, ['--version'], {
    encoding: 'utf8',
    stdio: ['ignore', 'pipe', 'ignore']
  }).trim()
}

import { execFileSync } from 'node:child_process'
import { cpSync, mkdtempSync, readFileSync, rmSync } from 'node:fs'
import { tmpdir } from 'node:os'
import { join } from 'node:path'
import { fileURLToPath } from 'node:url'
import type { Browser } from 'playwright-core'
import { PNG } from 'pngjs'
import type { Backend } from '../gpu/harness/gpu-test'
import { launchChromium } from '../harness/browser'
import { withLimit } from '../harness/limit'
import { Report } from '../harness/report'
import { serveStatic } from '../harness/serve'
import { expectations } from './expectations'

const root = fileURLToPath(new URL('../..', import.meta.url))
const template = fileURLToPath(new URL('app', import.meta.url))
const report = new Report()

/** Runs npm, or a command of the app's, and answers with its standard output. */
function execute(command: string, args: string[], cwd: string): string {
  return execFileSync(command, args, {
    cwd,
    encoding: 'utf8',
    stdio: ['ignore', 'pipe', 'pipe'],
    shell: process.platform === 'win32',
    timeout: 300_000
  })
}

function attempt(name: string, work: () => string): boolean {
  try {
    report.pass(name, work())
    return true
  } catch (error) {
    const { stdout = '', stderr = '' } = error as { stdout?: string; stderr?: string }
    report.fail(name, `${String(error)}\n${stdout}${stderr}`.trim())
    return false
  }
}

const workspace = (
  JSON.parse(readFileSync(join(root, 'package.json'), 'utf8')) as {
    devDependencies: Record<string, string>
  }
).devDependencies

/** Installs the packed packages as a user would: from files, with the versions of the workspace. */
function install(app: string): string {
  const packed = ['geo', 'atmosphere', 'clouds'].map(name => {
    const output = execute(
      'npm',
      ['pack', '--json', '--pack-destination', app, join(root, 'packages', name)],
      app
    )
    const [{ filename }] = JSON.parse(output) as [{ filename: string }]
    return `./${filename}`
  })
  const tools = ['three', '@types/three', 'typescript', 'vite'].map(
    name => `${name}@${workspace[name]}`
  )
  execute('npm', ['install', '--no-audit', '--no-fund', ...packed, ...tools], app)
  return packed.map(file => file.replace('./', '')).join(', ')
}

async function look(browser: Browser, origin: string, scene: string, backend: Backend) {
  const label = `the app's ${scene} scene draws what it should [${backend}]`
  const page = await browser.newPage()
  const errors: string[] = []
  page.on('pageerror', error => errors.push(String(error)))
  page.on('console', message => {
    // Three warns when it falls back from WebGPU.
    const text = message.text()
    if (message.type() === 'error' || text.startsWith('THREE')) errors.push(text)
  })
  try {
    const query = backend === 'webgl' ? '&webgl' : ''
    await page.goto(`${origin}/index.html?scene=${scene}${query}`)
    await page.waitForFunction(() => 'draw' in window, undefined, { timeout: 60_000 })
    const url = await withLimit(
      page.evaluate(() => (window as unknown as { draw: () => string }).draw()),
      120
    )
    const png = PNG.sync.read(Buffer.from(url.split(',')[1], 'base64'))
    errors.push(...expectations[scene](png))
  } catch (error) {
    errors.push(String(error))
  }
  await page.close()
  if (errors.length === 0) report.pass(label)
  else report.fail(label, errors.join('\n'))
}

async function lookAtAll(folder: string): Promise<void> {
  const server = await serveStatic([{ path: '/', folder }])
  const browser = await launchChromium()
  try {
    for (const scene of Object.keys(expectations)) {
      for (const backend of ['webgpu', 'webgl'] as const) {
        await look(browser, server.origin, scene, backend)
      }
    }
  } finally {
    await browser.close()
    await server.close()
  }
}

const app = mkdtempSync(join(tmpdir(), 'welkin-consumer-'))
try {
  cpSync(template, app, { recursive: true })
  const steps: [string, () => string][] = [
    ['npm install of the packed packages', () => install(app)],
    ['strict types, skipLibCheck off', () => execute('npx', ['--no-install', 'tsc'], app)],
    ['vite build', () => execute('npx', ['--no-install', 'vite', 'build', '--logLevel=warn'], app)]
  ]
  if (steps.every(([name, work]) => attempt(name, work))) await lookAtAll(join(app, 'dist'))
} finally {
  rmSync(app, { recursive: true, force: true })
}
report.finish()

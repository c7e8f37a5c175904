import { execFileSync } from 'node:child_process'
import { cpSync, mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs'
import { tmpdir } from 'node:os'
import { join } from 'node:path'
import { fileURLToPath } from 'node:url'
import type { Browser, Page } from 'playwright-core'
import { PNG } from 'pngjs'
import type { Backend } from '../harness/backend'
import { launchChromium } from '../harness/browser'
import { withLimit } from '../harness/limit'
import { outputFolder, Report } from '../harness/report'
import { serveStatic } from '../harness/serve'
import { isBlank } from '../visual/compare'
import { expectations } from './expectations'
import { writeReadmeModules } from './readme'

const root = fileURLToPath(new URL('../..', import.meta.url))
const template = fileURLToPath(new URL('app', import.meta.url))
const report = new Report()
/** Longest that a page may take: at half the speed, beside another step, clouds under React take more than 120 s [s]. */
const limitSeconds = 600

/** Small: it is drawn in software. */
const viewport = { width: 160, height: 90 }

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

const devDependencies = (folder: string): Record<string, string> =>
  (
    JSON.parse(readFileSync(join(root, folder, 'package.json'), 'utf8')) as {
      devDependencies: Record<string, string>
    }
  ).devDependencies

const workspace = { ...devDependencies('.'), ...devDependencies('stories') }

/** Packages that only users have: React Three Fiber, and another bundler. */
const foreign = {
  '@react-three/fiber': '9.8.2',
  '@types/react': '19.3.0',
  '@types/react-dom': '19.3.0',
  react: '19.3.0',
  'react-dom': '19.3.0',
  webpack: '5.112.2'
}

/** Installs the packed packages as a user would: from files, with the versions of the workspace. */
function install(app: string): string {
  const packed = ['geo', 'atmosphere', 'clouds', 'terrain'].map(name => {
    const output = execute(
      'npm',
      ['pack', '--json', '--pack-destination', app, join(root, 'packages', name)],
      app
    )
    const [{ filename }] = JSON.parse(output) as [{ filename: string }]
    return `./${filename}`
  })
  const tools = ['three', '@types/three', 'typescript', 'vite', '3d-tiles-renderer', 'geotiff'].map(
    name => `${name}@${workspace[name]}`
  )
  const others = Object.entries(foreign).map(([name, version]) => `${name}@${version}`)
  execute('npm', ['install', '--no-audit', '--no-fund', ...packed, ...tools, ...others], app)
  return packed.map(file => file.replace('./', '')).join(', ')
}

/** Three's word about its fallback from WebGPU, which the app without it is meant to take. */
const fallback = /WebGPU is not available, running under WebGL2 backend/

/** A frame of the page, and when it was drawn. */
interface Frame {
  /** PNG as a data URL. */
  url: string
  /** Since the navigation [ms]. */
  time: number
  /** Since the renderer's constructor made the canvas [ms]; absent where React made it. */
  age?: number
}

/**
 * Runs in the page before its scripts: notes when a canvas is made. It names no function of its own, for
 * the bundler's helper that keeps names is not there.
 */
function noteCanvas(): void {
  const create = document.createElementNS.bind(document) as (a: string, b: string) => Element
  document.createElementNS = ((namespace: string, name: string): Element => {
    if (name === 'canvas') document.documentElement.dataset.canvasTime ??= `${performance.now()}`
    return create(namespace, name)
  }) as typeof document.createElementNS
}

/** Runs in the page: the next frame, taken in the task that draws it. */
function takeFrame(): Promise<Frame> {
  return new Promise(resolve => {
    // The renderer's own request came first, and so it draws first.
    requestAnimationFrame(() => {
      const url = document.querySelector('canvas')!.toDataURL('image/png')
      const time = performance.now()
      const { canvasTime } = document.documentElement.dataset
      const age = canvasTime === undefined ? {} : { age: time - Number(canvasTime) }
      resolve({ url, time, ...age })
    })
  })
}

/** Frames after the first that is not blank in which what takes several to draw must have come. */
const patience = 60

/**
 * The app's first frame that is as it should be, or the last of those that it is given time for; and when
 * the first came that was not blank.
 */
async function firstFrame(
  page: Page,
  wrongWith: (png: PNG) => string[]
): Promise<{ png: PNG; first: Frame }> {
  let first: Frame | undefined
  for (let seen = 0; ;) {
    const frame = await page.evaluate(takeFrame)
    const png = PNG.sync.read(Buffer.from(frame.url.split(',')[1], 'base64'))
    if (isBlank(png)) continue
    first ??= frame
    seen++
    if (seen > patience || wrongWith(png).length === 0) return { png, first }
  }
}

const seconds = (ms: number): string => `${(ms / 1000).toFixed(1)} s`

async function look(browser: Browser, origin: string, name: string, backend: Backend) {
  const { wrongWith, allows } = expectations[name]
  const label = `the app's ${name} page draws what it should [${backend}]`
  const page = await browser.newPage({ viewport })
  const errors: string[] = []
  let note = ''
  page.on('pageerror', error => errors.push(String(error)))
  page.on('console', message => {
    const text = message.text()
    if (backend === 'webgl' && fallback.test(text)) return
    if (allows?.test(text) === true) return
    if (message.type() === 'error' || text.startsWith('THREE')) errors.push(text)
  })
  try {
    if (backend === 'webgl') {
      await page.addInitScript(() => Object.defineProperty(navigator, 'gpu', { value: undefined }))
    }
    await page.addInitScript(noteCanvas)
    await page.goto(`${origin}/${name}.html`)
    await page.waitForSelector('canvas', { state: 'attached', timeout: 120_000 })
    const { png, first } = await withLimit(firstFrame(page, wrongWith), limitSeconds)
    note = `first frame ${seconds(first.time)} from navigation`
    if (first.age !== undefined) note += `, ${seconds(first.age)} from the renderer's creation`
    const wrong = wrongWith(png)
    if (wrong.length > 0) {
      const file = join(outputFolder, `consumer-${name}.${backend}.png`)
      writeFileSync(file, PNG.sync.write(png))
      errors.push(...wrong, `see e2e/output/consumer-${name}.${backend}.png`)
    }
  } catch (error) {
    errors.push(String(error))
  }
  await page.close()
  if (errors.length === 0) report.pass(label, note)
  else report.fail(label, errors.join('\n'))
}

/** Answers of the packages to a CommonJS module, checked. */
function requireAll(app: string): string {
  const output = execute('node', ['require.cjs'], app)
  const { sunHeight, sunDeclination, layers, ground } = JSON.parse(output) as Record<string, number>
  // At noon of the solstice, on the tropic: the sun is overhead.
  const isRight = sunHeight > 0.999 && Math.abs(sunDeclination - 0.409) < 1e-3 && layers === 3
  if (!isRight || !(ground > 0 && ground < 9000)) throw new Error(`the packages answer ${output}`)
  return 'four packages'
}

async function lookAtAll(folder: string): Promise<void> {
  const server = await serveStatic([{ path: '/', folder }])
  const browser = await launchChromium()
  try {
    for (const [name, { backends }] of Object.entries(expectations)) {
      for (const backend of backends) {
        await look(browser, server.origin, name, backend)
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
  mkdirSync(outputFolder, { recursive: true })
  const steps: [string, () => string][] = [
    ['npm install of the packed packages', () => install(app)],
    ['the code of the READMEs', () => `${writeReadmeModules(root, app)} blocks`],
    [
      'strict types, skipLibCheck off',
      () => execute('npx', ['--no-install', 'tsc', '--checkers', '1'], app)
    ],
    ['vite build', () => execute('npx', ['--no-install', 'vite', 'build', '--logLevel=warn'], app)],
    ['webpack build', () => execute('node', ['webpack.mjs'], app)],
    ['require() in CommonJS', () => requireAll(app)]
  ]
  if (steps.every(([name, work]) => attempt(name, work))) await lookAtAll(join(app, 'dist'))
} finally {
  rmSync(app, { recursive: true, force: true })
}
report.finish()

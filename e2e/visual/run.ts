import { existsSync, mkdirSync, readdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs'
import { availableParallelism } from 'node:os'
import { basename, join } from 'node:path'
import { fileURLToPath } from 'node:url'
import { parseArgs } from 'node:util'
import type { BrowserContext, Page } from 'playwright-core'
import { PNG } from 'pngjs'
import { worldData } from '../../stories/vite/worldData.ts'
import { filterSamplesPlugin } from '../gpu/filterSamples'
import type { Backend } from '../harness/backend'
import { launchChromium } from '../harness/browser'
import { bundlePage } from '../harness/bundle'
import { rankOf } from '../harness/longest'
import { withLimit } from '../harness/limit'
import { outputFolder, Report } from '../harness/report'
import { replaceModules } from '../harness/replaceModules'
import { serveStatic, texelMount } from '../harness/serve'
import { shadowSizePlugin } from '../harness/shadow-size'
import { compare, isBlank } from './compare'
import { wrongIn } from './subjects'

const viewport = { width: 320, height: 180 }
/** Longest that a picture may take: some 20 s alone, and several times that beside others on a busy machine. */
const limitSeconds = 600
const largestBaseline = 100_000
/** Pictures that take the longest, which come first. */
const longest = [
  'valley-',
  'stormnight-',
  'rain-bow',
  'halos-',
  'realornot-',
  'mountainshadows-',
  'realheights-',
  'clouds-',
  'lightshafts-',
  'flatworld-',
  'photogrammetry-',
  'sandbox-',
  'environment-'
]

const { values, positionals } = parseArgs({
  allowPositionals: true,
  options: {
    backend: { type: 'string' },
    update: { type: 'boolean' },
    /** Leaves the pictures of what passes in e2e/output/visual, too. */
    keep: { type: 'boolean' }
  }
})
const backends = (values.backend?.split(',') ?? ['webgpu', 'webgl']) as Backend[]
if (values.update && backends[0] !== 'webgpu') {
  throw new Error('--update needs webgpu first: its pictures are what webgl is held to')
}

const storiesFolder = fileURLToPath(new URL('../../stories/src', import.meta.url))
const baselineFolder = fileURLToPath(new URL('baselines', import.meta.url))
const failuresFolder = join(outputFolder, 'visual')
mkdirSync(baselineFolder, { recursive: true })
mkdirSync(failuresFolder, { recursive: true })

const report = new Report()

function writePng(file: string, png: PNG): number {
  const bytes = PNG.sync.write(png, { colorType: 2, deflateLevel: 9 })
  writeFileSync(file, bytes)
  return bytes.length
}

const readPng = (file: string): PNG => PNG.sync.read(readFileSync(file))

/**
 * Baselines are WebGPU's. Where WebGL's picture comes near to the tolerance it has one of its own:
 * what is smaller than a pixel depends on where in it the backends take their samples. An update
 * still holds WebGL to WebGPU.
 */
function judge(name: string, backend: Backend, actual: PNG, detail: string): void {
  const label = `${name} [${backend}]`
  const shared = join(baselineFolder, `${name}.png`)
  const own = join(baselineFolder, `${name}.${backend}.png`)
  if (isBlank(actual)) {
    report.fail(label, 'the canvas is blank')
    return
  }
  const wrong = wrongIn(name, actual)
  if (wrong !== undefined) {
    writePng(join(failuresFolder, `${name}.${backend}.actual.png`), actual)
    report.fail(label, wrong)
    return
  }
  if (values.update && backend === 'webgpu') {
    const bytes = writePng(shared, actual)
    report.check(bytes < largestBaseline, label, `written, ${(bytes / 1000).toFixed(0)} kB`)
    return
  }
  if (values.update) rmSync(own, { force: true })
  const file = existsSync(own) ? own : shared
  if (!existsSync(file)) {
    writePng(join(failuresFolder, `${name}.${backend}.actual.png`), actual)
    report.fail(label, 'no baseline: run npm run test:visual -- --update')
    return
  }
  const comparison = compare(actual, readPng(file))
  if (values.keep || !comparison.same) {
    const picture = join(failuresFolder, `${name}.${backend}`)
    writePng(`${picture}.actual.png`, actual)
    writePng(`${picture}.diff.png`, comparison.diff)
  }
  if (!comparison.same) {
    report.fail(label, `${comparison.detail}\nsee e2e/output/visual/${name}.${backend}.*.png`)
    return
  }
  const getsOwn = values.update && comparison.isNearLimit
  if (getsOwn) writePng(own, actual)
  report.pass(label, `${detail}, ${comparison.detail}${getsOwn ? ', own baseline written' : ''}`)
}

/** Takes a picture. @returns False if its page may draw no more. */
async function shoot(page: Page, file: string, story: string, backend: Backend): Promise<boolean> {
  const name = `${file}-${story}`.toLowerCase()
  try {
    const shot = await withLimit(
      page.evaluate(([f, s, b]) => window.welkinVisual.shoot(f, s, b), [
        file,
        story,
        backend
      ] as const),
      limitSeconds
    )
    if (shot.messages.length > 0) {
      report.fail(`${name} [${backend}]`, shot.messages.join('\n'))
      return true
    }
    const png = PNG.sync.read(Buffer.from(shot.url.split(',')[1], 'base64'))
    judge(name, backend, png, `${(shot.milliseconds / 1000).toFixed(1)} s`)
    return true
  } catch (error) {
    report.fail(`${name} [${backend}]`, String(error))
    return false
  }
}

const files = Object.fromEntries(
  readdirSync(storiesFolder, { recursive: true, encoding: 'utf8' })
    .filter(file => /\.(scene|stories)\.ts$/.test(file))
    .map(file => [basename(file, '.ts'), join(storiesFolder, file)])
)
const root = fileURLToPath(new URL('page', import.meta.url))
const server = await serveStatic([
  texelMount(),
  {
    path: '/',
    folder: await bundlePage(root, files, [
      replaceModules(),
      filterSamplesPlugin(),
      shadowSizePlugin(),
      worldData()
    ])
  }
])

interface Shooting {
  file: string
  story: string
  backend: Backend
}

async function openPage(context: BrowserContext): Promise<Page> {
  const page = await context.newPage()
  page.on('pageerror', error => console.log(`      page error: ${error.stack ?? error.message}`))
  await page.goto(`${server.origin}/index.html`)
  await page.waitForFunction(() => 'welkinVisual' in window)
  return page
}

/** Runs in a browser of its own. */
async function withContext<T>(use: (context: BrowserContext) => Promise<T>): Promise<T> {
  const browser = await launchChromium()
  try {
    return await use(await browser.newContext({ viewport, deviceScaleFactor: 1 }))
  } finally {
    await browser.close()
  }
}

/** Pictures to take, by backend. */
async function listPictures(page: Page): Promise<Shooting[][]> {
  const cases = await page.evaluate(() => window.welkinVisual.list())
  const chosen = cases.filter(({ file, story }) => {
    const name = `${file}-${story}`.toLowerCase()
    return positionals.length === 0 || positionals.some(word => name.includes(word))
  })
  const rank = ({ file, story }: { file: string; story: string }): number =>
    rankOf(longest, `${file}-${story}`.toLowerCase())
  return backends.map(backend =>
    chosen
      .toSorted((a, b) => rank(a) - rank(b))
      .filter(({ isWebGPUOnly }) => backend === 'webgpu' || !isWebGPUOnly)
      .map(({ file, story }) => ({ file, story, backend }))
  )
}

/**
 * Takes pictures of a backend, and then the last ones of the other, as GPU tests do.
 *
 * @param start - First page to draw in.
 */
async function work(context: BrowserContext, start: Page, queues: Shooting[][], own: number) {
  const next = () => queues[own].shift() ?? queues.find(queue => queue.length > 0)?.pop()
  let page = start
  for (let job = next(); job !== undefined; job = next()) {
    if (await shoot(page, job.file, job.story, job.backend)) continue
    await page.close()
    page = await openPage(context)
  }
}

try {
  await withContext(async first => {
    const page = await openPage(first)
    const queues = await listPictures(page)
    // An update needs the pictures of WebGPU first.
    const workers = values.update ? 1 : Math.min(availableParallelism(), queues.length)
    const others = Array.from({ length: workers - 1 }, (_, i) =>
      withContext(async context => work(context, await openPage(context), queues, i + 1))
    )
    await Promise.all([work(first, page, queues, 0), ...others])
  })
} finally {
  await server.close()
}
report.finish()

import { readdirSync } from 'node:fs'
import { availableParallelism } from 'node:os'
import { join } from 'node:path'
import { fileURLToPath } from 'node:url'
import { parseArgs } from 'node:util'
import type { BrowserContext, Page } from 'playwright-core'
import { launchChromium } from '../harness/browser'
import { bundlePage } from '../harness/bundle'
import { rankOf } from '../harness/longest'
import { withLimit } from '../harness/limit'
import { Report } from '../harness/report'
import { serveStatic, texelMount } from '../harness/serve'
import type { Backend } from '../harness/backend'
import { replaceModules } from '../harness/replaceModules'
import { shadowSizePlugin } from '../harness/shadow-size'
import { filterSamplesPlugin } from './filterSamples'
import { recipesPlugin } from './recipes'
import type { TestListing, TestOutcome } from './page/main'

const { values, positionals } = parseArgs({
  allowPositionals: true,
  options: { backend: { type: 'string' }, test: { type: 'string' } }
})
const backends = (values.backend?.split(',') ?? ['webgpu', 'webgl']) as Backend[]

const folder = fileURLToPath(new URL('.', import.meta.url))
/** Suites that bake what all others take, and those that take the longest, which come first. */
const longest = [
  'atmosphere/functions',
  'clouds/density',
  'everything',
  'combinations',
  'atmosphere/planets',
  'clouds/traa',
  'clouds/temporal',
  'atmosphere/lifecycle',
  'atmosphere/shafts',
  'clouds/lightning',
  'atmosphere/exposure',
  'clouds/rain-shade',
  'clouds/fog-light',
  'clouds/lifecycle',
  'clouds/shafts',
  'atmosphere/environment',
  'terrain/mountain-shadows',
  'terrain/terrain',
  'clouds/world',
  'clouds/coverage',
  'clouds/random-views',
  'atmosphere/cameras',
  'terrain/air'
]
/** The suite whose pictures are the first of their page, as a user's are. */
const firstFrames = 'smoke'
/** Files by their path without ending, such as `clouds/density`. */
const suites = readdirSync(folder, { recursive: true, encoding: 'utf8' })
  .filter(file => file.endsWith('.gpu.ts'))
  .map(file => file.replace('.gpu.ts', '').replaceAll('\\', '/'))
  .filter(suite => positionals.length === 0 || positionals.some(word => suite.includes(word)))
  .toSorted()
  .toSorted((a, b) => rankOf(longest, a) - rankOf(longest, b))

const report = new Report()

async function openPage(context: BrowserContext): Promise<Page> {
  const page = await context.newPage()
  page.on('pageerror', error => console.log(`      page error: ${error.stack ?? error.message}`))
  await page.goto(`${server.origin}/index.html`)
  await page.waitForFunction(() => 'welkinTests' in window)
  return page
}

/** Runs a suite's tests in a page. @returns That page, or a fresh one if it had to be closed. */
async function runSuite(
  context: BrowserContext,
  startPage: Page,
  suite: string,
  backend: Backend
): Promise<Page> {
  let page = startPage
  const list = (): Promise<TestListing[]> =>
    page.evaluate(([s, b]) => window.welkinTests.list(s, b), [suite, backend] as const)
  let tests: TestListing[]
  try {
    tests = await withLimit(list(), 60)
  } catch (error) {
    report.fail(`${suite} [${backend}] loads`, String(error))
    await page.close()
    return openPage(context)
  }
  for (const { name, timeoutSeconds } of tests) {
    if (values.test !== undefined && !name.includes(values.test)) continue
    const label = `${suite} [${backend}] ${name}`
    try {
      const run: Promise<TestOutcome> = page.evaluate(
        ([s, n, b]) => window.welkinTests.run(s, n, b),
        [suite, name, backend] as const
      )
      const { error, milliseconds, notes } = await withLimit(run, timeoutSeconds)
      const detail = [`${(milliseconds / 1000).toFixed(1)} s`, ...notes].join(', ')
      if (error === undefined) report.pass(label, detail)
      else report.fail(label, [error, ...notes].join('\n'))
    } catch (error) {
      report.fail(label, String(error))
      // The page hangs or has crashed: the rest of the suite gets a fresh one.
      await page.close()
      page = await openPage(context)
      await withLimit(list(), 60)
    }
  }
  return page
}

const files = Object.fromEntries(suites.map(suite => [suite, join(folder, `${suite}.gpu.ts`)]))
const bundle = await bundlePage(join(folder, 'page'), files, [
  replaceModules(),
  shadowSizePlugin(),
  filterSamplesPlugin(),
  recipesPlugin()
])
const server = await serveStatic([texelMount(), { path: '/', folder: bundle }])
const seconds: [suite: string, seconds: number][] = []
/** Suites to come, by backend. */
const queues = backends.map(backend => suites.map(suite => ({ suite, backend })))

/**
 * Runs the suites of a backend in a page, and then the last ones of the other backend: they share tables
 * that they bake and shaders that they compile, which are of one backend. A software renderer draws pictures as small as the
 * tests' on one core, so that two browsers take little longer than one.
 */
async function work(own: number): Promise<void> {
  const browser = await launchChromium()
  const context = await browser.newContext()
  let page = await openPage(context)
  const next = () => queues[own].shift() ?? queues.find(queue => queue.length > 0)?.pop()
  try {
    for (let job = next(); job !== undefined; job = next()) {
      const { suite, backend } = job
      const start = performance.now()
      if (suite === firstFrames) {
        await page.close()
        page = await openPage(context)
      }
      page = await runSuite(context, page, suite, backend)
      seconds.push([`${suite} [${backend}]`, (performance.now() - start) / 1000])
    }
  } finally {
    await browser.close()
  }
}

const start = performance.now()
try {
  const workers = Math.min(availableParallelism(), backends.length)
  await Promise.all(Array.from({ length: workers }, (_, own) => work(own)))
} finally {
  await server.close()
}
const total = (performance.now() - start) / 1000
console.log(`\n${total.toFixed(0)} s; the slowest suites took [s]:`)
for (const [suite, time] of seconds.toSorted((a, b) => b[1] - a[1]).slice(0, 20)) {
  console.log(`${time.toFixed(1).padStart(7)} ${suite}`)
}
report.finish()

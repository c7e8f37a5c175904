import { readdirSync } from 'node:fs'
import { join } from 'node:path'
import { fileURLToPath } from 'node:url'
import { parseArgs } from 'node:util'
import type { BrowserContext, Page } from 'playwright-core'
import { launchChromium } from '../harness/browser'
import { bundlePage } from '../harness/bundle'
import { withLimit } from '../harness/limit'
import { Report } from '../harness/report'
import { serveStatic } from '../harness/serve'
import type { Backend } from '../harness/backend'
import type { TestListing, TestOutcome } from './page/main'

const { values, positionals } = parseArgs({
  allowPositionals: true,
  options: { backend: { type: 'string' }, test: { type: 'string' } }
})
const backends = (values.backend?.split(',') ?? ['webgpu', 'webgl']) as Backend[]

const folder = fileURLToPath(new URL('.', import.meta.url))
/** Files by their path without ending, such as `clouds/density`. */
const suites = readdirSync(folder, { recursive: true, encoding: 'utf8' })
  .filter(file => file.endsWith('.gpu.ts'))
  .map(file => file.replace('.gpu.ts', '').replaceAll('\\', '/'))
  .filter(suite => positionals.length === 0 || positionals.some(word => suite.includes(word)))
  .toSorted()

const report = new Report()

async function openPage(context: BrowserContext, origin: string): Promise<Page> {
  const page = await context.newPage()
  page.on('pageerror', error => console.log(`      page error: ${error.stack ?? error.message}`))
  await page.goto(`${origin}/index.html`)
  await page.waitForFunction(() => 'welkinTests' in window)
  return page
}

async function runSuite(
  context: BrowserContext,
  origin: string,
  suite: string,
  backend: Backend
): Promise<void> {
  let page = await openPage(context, origin)
  const list = (): Promise<TestListing[]> =>
    page.evaluate(([s, b]) => window.welkinTests.list(s, b), [suite, backend] as const)
  let tests: TestListing[]
  try {
    tests = await withLimit(list(), 60)
  } catch (error) {
    report.fail(`${suite} [${backend}] loads`, String(error))
    await page.close()
    return
  }
  for (const { name, timeoutSeconds } of tests) {
    if (values.test !== undefined && !name.includes(values.test)) continue
    const label = `${suite} [${backend}] ${name}`
    try {
      const run: Promise<TestOutcome> = page.evaluate(([n, b]) => window.welkinTests.run(n, b), [
        name,
        backend
      ] as const)
      const { error, milliseconds, notes } = await withLimit(run, timeoutSeconds)
      const detail = [`${(milliseconds / 1000).toFixed(1)} s`, ...notes].join(', ')
      if (error === undefined) report.pass(label, detail)
      else report.fail(label, [error, ...notes].join('\n'))
    } catch (error) {
      report.fail(label, String(error))
      // The page hangs or has crashed: the rest of the suite gets a fresh one.
      await page.close()
      page = await openPage(context, origin)
      await withLimit(list(), 60)
    }
  }
  await page.close()
}

const files = Object.fromEntries(suites.map(suite => [suite, join(folder, `${suite}.gpu.ts`)]))
const bundle = await bundlePage(join(folder, 'page'), files)
const server = await serveStatic([{ path: '/', folder: bundle }])
const browser = await launchChromium()
// Pages of one context share what they store: baked tables.
const context = await browser.newContext()
try {
  for (const suite of suites) {
    for (const backend of backends) await runSuite(context, server.origin, suite, backend)
  }
} finally {
  await browser.close()
  await server.close()
}
report.finish()

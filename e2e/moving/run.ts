import { fileURLToPath } from 'node:url'
import type { Browser, Page } from 'playwright-core'
import { worldData } from '../../stories/vite/worldData.ts'
import { launchChromium } from '../harness/browser'
import { bundlePage } from '../harness/bundle'
import { withLimit } from '../harness/limit'
import { Report } from '../harness/report'
import { serveStatic } from '../harness/serve'
import type { ExplorerState } from '../../stories/src/moving/Explorer'
import { startStorybook, testLink } from './link'

const viewport = { width: 160, height: 90 }
const limitSeconds = 60
/** Storybook's pages are compiled as they are asked for, and the valley is drawn in software. */
const linkLimitSeconds = 500
const stories = fileURLToPath(new URL('../../stories/src/plain.stories.ts', import.meta.url))

const report = new Report()
const look = async (page: Page): Promise<ExplorerState> =>
  page.evaluate(() => window.welkinMoving.look())

/** Waits until a view is as it should be; fails with the last one. */
async function until(
  page: Page,
  isRight: (view: ExplorerState) => boolean
): Promise<ExplorerState> {
  const end = performance.now() + 10_000
  for (;;) {
    const view = await look(page)
    if (isRight(view)) return view
    if (performance.now() > end) throw new Error(`the view stays ${JSON.stringify(view)}`)
    await page.waitForTimeout(30)
  }
}

/** Waits until the view has stood still for a while. */
async function atRest(page: Page): Promise<ExplorerState> {
  for (let last = await look(page); ;) {
    await page.waitForTimeout(500)
    const view = await look(page)
    if (JSON.stringify(view) === JSON.stringify(last)) return view
    last = view
  }
}

/** Waits until the address has another view than before. */
async function addressAfter(page: Page, before: string): Promise<string> {
  await page.waitForFunction(url => location.href !== url, before, { timeout: 10_000 })
  // What moved has come to rest, and the address with it.
  await page.waitForTimeout(1200)
  return page.url()
}

/** *Plain scene* at an address. */
async function open(browser: Browser, url: string): Promise<Page> {
  const page = await browser.newPage({ viewport })
  page.on('pageerror', error => report.fail('page error', error.stack ?? error.message))
  await page.goto(url)
  await page.waitForFunction(() => 'welkinMoving' in window)
  await page.evaluate(() => window.welkinMoving.show('plain', 'Afternoon'))
  return page
}

/** One finger draws the picture along, two move. All below what the page shows over the canvas. */
async function touch(page: Page): Promise<void> {
  const devtools = await page.context().newCDPSession(page)
  type Finger = readonly [x: number, y: number]
  const put = (
    type: 'touchStart' | 'touchMove' | 'touchEnd',
    ...fingers: Finger[]
  ): Promise<unknown> =>
    devtools.send('Input.dispatchTouchEvent', {
      type,
      touchPoints: fingers.map(([x, y], id) => ({ x, y, id }))
    })
  const before = await look(page)
  await put('touchStart', [80, 75])
  for (const x of [76, 70, 60]) await put('touchMove', [x, 75])
  await put('touchEnd')
  const turned = await until(page, ({ heading }) => Math.abs(heading - before.heading) > 5)
  report.pass('a finger looks around', `${(turned.heading - before.heading).toFixed(1)}°`)

  await put('touchStart', [60, 80])
  await put('touchStart', [60, 80], [100, 80])
  await put('touchMove', [60, 30], [100, 30])
  const far = ({ x, z }: ExplorerState): number => Math.hypot(x - turned.x, z - turned.z)
  const moved = await until(page, view => far(view) > 0.2)
  await put('touchEnd')
  report.pass('two fingers move', `${far(moved).toFixed(2)} m`)
}

async function move(browser: Browser, origin: string): Promise<void> {
  const page = await open(browser, `${origin}/index.html`)
  const start = page.url()
  const first = await look(page)
  const help = (await page.textContent('.welkin-help')) ?? ''
  report.check(help.includes('WASD'), 'the page says how one moves', help)
  await page.waitForTimeout(700)
  report.check(page.url() === start, 'the address is clean until one moves', page.url())

  await page.keyboard.down('w')
  const flown = await until(page, ({ z }) => z < first.z - 0.2)
  await page.keyboard.up('w')
  report.pass('W flies ahead', `${(first.z - flown.z).toFixed(2)} m`)

  await page.mouse.move(40, 45)
  await page.mouse.down()
  await page.mouse.move(80, 30, { steps: 4 })
  await page.mouse.up()
  const turned = await until(
    page,
    ({ heading, pitch }) => pitch > flown.pitch + 5 && Math.abs(heading - flown.heading) > 10
  )
  report.pass('a drag looks around', `${turned.heading.toFixed(1)}°, ${turned.pitch.toFixed(1)}°`)

  await page.keyboard.press('f')
  const walking = await until(page, ({ y, walking }) => walking === 1 && Math.abs(y - 1.7) < 1e-6)
  report.pass('F comes down to the ground', `eyes at ${walking.y.toFixed(2)} m`)
  await page.keyboard.down('Space')
  await until(page, ({ y }) => y > 1.8)
  await page.keyboard.up('Space')
  const last = await until(page, ({ y }) => Math.abs(y - 1.7) < 1e-6)
  report.pass('Space jumps', `and lands at ${last.y.toFixed(2)} m`)

  await touch(page)
  const rest = await atRest(page)
  const link = await addressAfter(page, start)
  report.check(link.includes('#view='), 'the address has the view', link)
  await page.close()

  const again = await open(browser, link)
  const back = await look(again)
  const keys = ['x', 'y', 'z', 'heading', 'pitch', 'walking'] as const
  const worst = Math.max(...keys.map(key => Math.abs(back[key] - rest[key])))
  report.check(worst < 0.011, 'the link brings the view back', `within ${worst.toFixed(3)}`)
  await again.close()
}

const root = fileURLToPath(new URL('page', import.meta.url))
const storybook = startStorybook()
const server = await serveStatic([
  { path: '/', folder: await bundlePage(root, { 'plain.stories': stories }, [worldData()]) }
])
const browser = await launchChromium()
const start = performance.now()
try {
  await withLimit(move(browser, server.origin), limitSeconds)
  await withLimit(testLink(browser, (await storybook).origin, report), linkLimitSeconds)
} catch (error) {
  report.fail('moving', String(error))
} finally {
  await browser.close()
  await server.close()
  await storybook.then(
    ({ stop }) => stop(),
    () => undefined
  )
}
console.log(`${((performance.now() - start) / 1000).toFixed(1)} s`)
report.finish()

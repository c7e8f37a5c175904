import { fileURLToPath } from 'node:url'
import type { BrowserContext, Page } from 'playwright-core'
import { worldData } from '../../stories/vite/worldData.ts'
import { launchChromium } from '../harness/browser'
import { bundlePage } from '../harness/bundle'
import { withLimit } from '../harness/limit'
import { replaceModules } from '../harness/replaceModules'
import { Report } from '../harness/report'
import { serveStatic, texelMount } from '../harness/serve'
import type { ExplorerState } from '../../stories/src/moving/Explorer'
import { startStorybook, testLink } from './link'

const viewport = { width: 160, height: 90 }
/** Room for the buttons beside the fingers. */
const touchViewport = { width: 240, height: 220 }
const limitSeconds = 1200
/** Longest that the page may take for what it is told, beside other steps on a slow machine [ms]. */
const waitMilliseconds = 240_000
/** Storybook's pages are compiled as they are asked for, and the valley is drawn in software. */
const linkLimitSeconds = 1200
const stories = fileURLToPath(new URL('../../stories/src/plain.stories.ts', import.meta.url))

const report = new Report()
const look = async (page: Page): Promise<ExplorerState> =>
  page.evaluate(() => window.welkinMoving.look())

/** Waits until a view is as it should be; fails with the last one. */
async function until(
  page: Page,
  isRight: (view: ExplorerState) => boolean
): Promise<ExplorerState> {
  const end = performance.now() + waitMilliseconds
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
  await page.waitForFunction(url => location.href !== url, before, { timeout: waitMilliseconds })
  // What moved has come to rest, and the address with it.
  await page.waitForTimeout(1200)
  return page.url()
}

/** *Plain scene* at an address. */
async function open(context: BrowserContext, url: string): Promise<Page> {
  const page = await context.newPage()
  page.on('pageerror', error => report.fail('page error', error.stack ?? error.message))
  await page.goto(url)
  await page.waitForFunction(() => 'welkinMoving' in window, null, { timeout: waitMilliseconds })
  await page.evaluate(() => window.welkinMoving.show('plain', 'Afternoon'))
  return page
}

/** Keys that fly while the camera looks north, and where they bring it. */
const keys: readonly [key: string, way: string, of: (view: ExplorerState) => number][] = [
  ['w', 'ahead', ({ z }) => -z],
  ['s', 'back', ({ z }) => z],
  ['a', 'to the left', ({ x }) => -x],
  ['d', 'to the right', ({ x }) => x],
  ['e', 'up', ({ y }) => y],
  ['q', 'down', ({ y }) => -y]
]

async function fly(page: Page): Promise<void> {
  for (const [key, way, along] of keys) {
    const before = along(await look(page))
    await page.keyboard.down(key)
    const flown = await until(page, view => along(view) > before + 0.2)
    await page.keyboard.up(key)
    const meters = (along(flown) - before).toFixed(2)
    report.pass(`${key.toUpperCase()} flies ${way}`, `${meters} m`)
  }
}

/** The wheel sets the speed, whatever the height. */
async function roll(page: Page): Promise<void> {
  const speed = async (): Promise<number> => page.evaluate(() => window.welkinMoving.speed())
  await page.keyboard.down('d')
  await page.waitForTimeout(500)
  const before = await speed()
  await page.mouse.move(80, 60)
  await page.mouse.wheel(0, -600)
  await page.waitForTimeout(500)
  const after = await speed()
  await page.keyboard.up('d')
  await page.mouse.wheel(0, 600)
  const detail = `${before.toFixed(1)}, ${after.toFixed(1)} m/s`
  report.check(after > 2.5 * before, 'the wheel makes it faster', detail)
}

/** A flight to another place is smooth: it starts and ends slowly, and no frame jumps. */
async function travel(page: Page): Promise<void> {
  const way = 60
  const { x, y, z } = await look(page)
  const views = await page.evaluate(([to, seconds]) => window.welkinMoving.flyTo(to, seconds), [
    [x, y + 10, z - way],
    3
  ] as const)
  const last = views.at(-1)!
  const off = Math.hypot(last.x - x, last.y - y - 10, last.z - z + way)
  report.check(off < 0.01, 'a flight arrives', `${off.toFixed(3)} m off`)
  report.check(Math.abs(last.heading - 90) < 0.1, 'and looks there', `${last.heading.toFixed(1)}°`)
  const steps = views.slice(1).map((view, i) => views[i].z - view.z)
  const most = Math.max(...steps) / way
  const back = Math.min(...steps)
  report.check(
    views.length > 10 && most < 0.2 && back > -1e-3,
    'and is smooth on its way',
    `${views.length} frames, the longest ${(100 * most).toFixed(1)} % of it`
  )
}

/** Buttons for fingers: up, down, walk and jump. */
async function touchButtons(
  page: Page,
  put: (type: 'touchStart' | 'touchEnd', ...fingers: Finger[]) => Promise<unknown>
): Promise<void> {
  const hold = async (label: string): Promise<void> => {
    const box = await page.locator('.welkin-touch button', { hasText: label }).boundingBox()
    if (box === null) throw new Error(`no button '${label}' is shown`)
    await put('touchStart', [box.x + box.width / 2, box.y + box.height / 2])
  }
  const letGo = async (): Promise<unknown> => put('touchEnd')
  const { y } = await look(page)
  await hold('Up')
  const risen = await until(page, view => view.y > y + 0.5)
  await letGo()
  report.pass('the button Up rises', `${(risen.y - y).toFixed(2)} m`)
  const above = await look(page)
  await hold('Down')
  const sunk = await until(page, view => view.y < above.y - 0.3)
  await letGo()
  report.pass('the button Down sinks', `${(above.y - sunk.y).toFixed(2)} m`)
  await hold('Walk')
  await letGo()
  await until(page, view => view.walking === 1 && Math.abs(view.y - 1.7) < 1e-6)
  report.pass('the button Walk comes down to the ground')
  await hold('Jump')
  await until(page, view => view.y > 1.8)
  await letGo()
  await until(page, view => Math.abs(view.y - 1.7) < 1e-6)
  report.pass('the button Jump jumps')
}

type Finger = readonly [x: number, y: number]

/** One finger draws the picture along, two move, buttons do the rest. All below what the page shows over the canvas. */
async function touch(page: Page): Promise<void> {
  await page.setViewportSize(touchViewport)
  const devtools = await page.context().newCDPSession(page)
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
  await touchButtons(page, put)
}

/** The line that says how one moves goes after a while, and comes back by key and by button. */
async function helpAgain(page: Page): Promise<void> {
  const button = page.locator('.welkin-help')
  const says = async (text: string): Promise<void> =>
    button.filter({ hasText: text }).waitFor({ timeout: waitMilliseconds })
  await says('?')
  report.pass('the line is hidden after a while')
  await page.keyboard.press('h')
  await says('WASD')
  await page.keyboard.press('h')
  await says('?')
  await button.click()
  await says('WASD')
  await page.keyboard.press('h')
  await says('?')
  report.pass('H and a button bring it back')
}

async function move(context: BrowserContext, origin: string): Promise<void> {
  const page = await open(context, `${origin}/index.html`)
  const start = page.url()
  const help = (await page.textContent('.welkin-help')) ?? ''
  report.check(help.includes('WASD'), 'the page says how one moves', help)
  await helpAgain(page)
  await page.waitForTimeout(700)
  report.check(page.url() === start, 'the address is clean until one moves', page.url())

  await fly(page)
  await roll(page)
  const flown = await look(page)

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

  await page.keyboard.press('f')
  await until(page, view => view.walking === 0)
  await touch(page)
  await page.setViewportSize(viewport)
  const rest = await atRest(page)
  const link = await addressAfter(page, start)
  report.check(link.includes('#view='), 'the address has the view', link)
  await page.evaluate(() => window.welkinMoving.keepTables())
  await page.close()

  const again = await open(context, link)
  const back = await look(again)
  const numbers = ['x', 'y', 'z', 'heading', 'pitch', 'walking'] as const
  const worst = Math.max(...numbers.map(key => Math.abs(back[key] - rest[key])))
  report.check(worst < 0.011, 'the link brings the view back', `within ${worst.toFixed(3)}`)
  await again.keyboard.press('f')
  await until(again, view => view.walking === 0)
  await travel(again)
  await again.close()
}

const root = fileURLToPath(new URL('page', import.meta.url))
const storybook = startStorybook()
const server = await serveStatic([
  texelMount(),
  {
    path: '/',
    folder: await bundlePage(root, { 'plain.stories': stories }, [replaceModules(), worldData()])
  }
])
const browser = await launchChromium()
const start = performance.now()
try {
  await withLimit(move(await browser.newContext({ viewport }), server.origin), limitSeconds)
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

import { spawn } from 'node:child_process'
import { once } from 'node:events'
import { createServer } from 'node:net'
import { fileURLToPath } from 'node:url'
import type { Browser, Frame, Page } from 'playwright-core'
import type { ExplorerState } from '../../stories/src/moving/Explorer'
import { parseState } from '../../stories/src/moving/ExplorerState'
import { weathers, type Weather, type WeatherName } from '../../stories/src/valley/weather'
import type { Report } from '../harness/report'

/** Wide enough for Storybook's list and controls; what is left is small, for it is drawn in software. */
const viewport = { width: 720, height: 300 }
const STORY = 'valley-all-day--day'
/** Switches that are off: what is drawn matters to none of the checks, and slow frames to all. */
const OFF = [
  'clouds',
  'mist',
  'precipitation',
  'shafts',
  'shadows',
  'trees',
  'village',
  'water',
  'moon',
  'stars',
  'airglow',
  'flare',
  'autoExposure',
  'occlusion',
  'bloom',
  'localExposure'
].map(name => `${name}:!false`)
/** As hazy as mist is: for other haze tables of light are made anew, which takes half a minute each in software. */
const OTHER_WEATHER: WeatherName = 'snow'
const START_SECONDS = 240
/** Longest that Storybook's controls may take while the valley is drawn in software, in the same thread [s]. */
const SLOW_SECONDS = 240
/** Length of a day: a frame in software, of which a tenth of a second counts, is as long as a minute of it [s]. */
const DAY_SECONDS = 120

/** Storybook, as `npm start` runs it. */
export async function startStorybook(): Promise<{ origin: string; stop: () => Promise<void> }> {
  const server = createServer().listen(0)
  await once(server, 'listening')
  const { port } = server.address() as { port: number }
  server.close()
  await once(server, 'close')
  const script = fileURLToPath(new URL('../../scripts/start.mjs', import.meta.url))
  const options = [script, '-p', String(port), '--ci']
  const child = spawn(process.execPath, options, { stdio: ['ignore', 'ignore', 'inherit'] })
  const ended = once(child, 'exit')
  const stop = async (): Promise<void> => {
    child.kill('SIGTERM')
    await ended
  }
  const origin = `http://localhost:${port}`
  const end = performance.now() + 1000 * START_SECONDS
  for (;;) {
    const answer = await fetch(`${origin}/index.json`).catch(() => null)
    if (answer?.ok === true) return { origin, stop }
    if (child.exitCode !== null || performance.now() > end) {
      await stop()
      throw new Error('Storybook does not start')
    }
    await new Promise(resolve => setTimeout(resolve, 200))
  }
}

/** View, hour and weather that a story shows. */
interface Shown {
  view: ExplorerState
  hour: number
  weather: Weather
}

const look = (story: Frame): Promise<Shown> =>
  story.evaluate(() => {
    const { explorer, conditions } = window.welkinScene!
    return { view: explorer!.state, ...conditions! }
  })

/** The story at an address, once it runs. */
async function open(browser: Browser, url: string, report: Report): Promise<[Page, Frame]> {
  const page = await browser.newPage({ viewport })
  page.setDefaultTimeout(1000 * SLOW_SECONDS)
  page.on('pageerror', error => {
    // Storybook's own page complains of slow machines.
    const isStorybook = error.stack?.includes('/sb-manager/') === true
    if (!isStorybook) report.fail('page error', error.stack ?? error.message)
  })
  await page.goto(url)
  const element = await page.waitForSelector('#storybook-preview-iframe')
  const story = (await element.contentFrame())!
  await story.waitForFunction(() => document.body.dataset.ready === 'true')
  // Drawn in software, in the thread of the controls: no frame comes but those that are asked for.
  await story.evaluate(() => window.welkinScene!.renderer.setAnimationLoop(null))
  return [page, story]
}

const KEYS = ['x', 'y', 'z', 'heading', 'pitch', 'walking'] as const

/** Compares what a link brought back. */
function check(report: Report, shown: Shown, wanted: Shown): void {
  const worst = Math.max(...KEYS.map(key => Math.abs(shown.view[key] - wanted.view[key])))
  report.check(worst < 0.011, 'a link brings the view back', `within ${worst.toFixed(3)}`)
  const late = Math.abs(shown.hour - wanted.hour)
  report.check(late < 0.051, 'a link brings the hour back', `${shown.hour.toFixed(2)} h`)
  report.check(
    JSON.stringify(shown.weather) === JSON.stringify(wanted.weather),
    'a link brings the weather back',
    JSON.stringify(shown.weather)
  )
}

/** *Valley, all day* in Storybook: a link brings view, hour and weather back, and what is changed comes into the address. */
export async function testLink(browser: Browser, origin: string, report: Report): Promise<void> {
  const place = '150,90,-300,200,4,0'
  const args = (hour: number, weather: WeatherName): string => `hour:${hour};weather:${weather}`
  const first = `${origin}/?path=/story/${STORY}&args=${args(18.5, 'mist')};paused:!true;quality:low;${OFF.join(';')}#view=${place}`
  const [page, story] = await open(browser, first, report)
  const wanted = { view: parseState(place)!, hour: 18.5, weather: weathers.mist }
  check(report, await look(story), wanted)

  // The controls come after the story.
  await page.waitForSelector('#control-quality')
  const missing = await page.$eval('#control-quality', control => {
    const table = control.closest('table')!.getBoundingClientRect()
    return Math.max(table.right - document.documentElement.clientWidth, 0)
  })
  report.check(missing === 0, 'the panel shows the whole of the controls', `${missing} px cut off`)
  // By the controls, and by the scene, whose clock runs.
  await page.selectOption('#control-weather', OTHER_WEATHER)
  await page.fill('#control-hour', '6.5')
  await checkKeys(story, report)
  const link = await addressWith(page, args(6.5, OTHER_WEATHER))
  report.check(
    new URL(link).hash === `#view=${place}`,
    'the address has weather, hour and view',
    link
  )
  await page.fill('#control-dayLength', String(DAY_SECONDS))
  // The box itself is out of a pointer's reach.
  await page.$eval('#control-paused', control => (control as HTMLInputElement).click())
  await addressAfter(page, story, 6.5)
  const { hour } = await look(story)
  const late = await addressAfter(page, story, hour)
  const { hour: now } = await look(story)
  report.check(
    hoursSince(late, now) >= 0,
    'the address follows the clock',
    `${late} h after ${hour.toFixed(2)} h, and the clock ${now.toFixed(2)} h`
  )
  await page.close()
}

/** A key goes to the story once the pointer is over it, whatever control was used before; the line about keys is not covered. */
async function checkKeys(story: Frame, report: Report): Promise<void> {
  const hasKeys = (): Promise<boolean> => story.evaluate(() => document.hasFocus())
  const before = await hasKeys()
  await story.hover('canvas', { position: { x: 9, y: 90 } })
  report.check(await hasKeys(), 'keys go to the story under the pointer', `before: ${before}`)
  const covered = await story.evaluate(() => {
    const [help, arc] = ['.welkin-help', '.welkin-hour'].map(each =>
      document.querySelector(each)!.getBoundingClientRect()
    )
    const isBeside = help.right <= arc.left || help.left >= arc.right
    return isBeside ? 0 : Math.max(help.bottom - arc.top, 0)
  })
  report.check(covered === 0, 'the arc of the day covers no line about keys', `${covered} px`)
}

/** Hour of the story in the address; NaN if it has none. */
const hourIn = (page: Page): number => {
  const kept = new URL(page.url()).searchParams.get('args') ?? ''
  return Number(/(?:^|;)hour:([\d.]+)/.exec(kept)?.[1] ?? NaN)
}

/** Hours from one hour of the day to another, in [−12, 12): after midnight is later than before. */
const hoursSince = (from: number, to: number): number => ((to - from + 36) % 24) - 12

/** Hour in the address once it is later than one, drawing frames until then; fails with the last address. */
async function addressAfter(page: Page, story: Frame, hour: number): Promise<number> {
  const end = performance.now() + 1000 * SLOW_SECONDS
  while (!(hoursSince(hour, hourIn(page)) > 0)) {
    if (performance.now() > end) throw new Error(`the address stays ${page.url()}`)
    await story.evaluate(() => window.welkinScene!.render())
    await page.waitForTimeout(500)
  }
  return hourIn(page)
}

/** Waits until the address has some arguments of the story, once and before its view; fails with the last one. */
async function addressWith(page: Page, args: string): Promise<string> {
  const end = performance.now() + 1000 * SLOW_SECONDS
  const isThere = (): boolean => {
    const { searchParams, hash } = new URL(page.url())
    const [kept, ...others] = searchParams.getAll('args')
    const isWhole = others.length === 0 && !hash.includes('args=')
    return isWhole && args.split(';').every(part => kept?.split(';').includes(part))
  }
  while (!isThere()) {
    if (performance.now() > end) throw new Error(`the address stays ${page.url()}`)
    await page.waitForTimeout(200)
  }
  return page.url()
}

import { existsSync, mkdirSync, readdirSync, writeFileSync } from 'node:fs'
import { basename, join } from 'node:path'
import { fileURLToPath } from 'node:url'
import { parseArgs } from 'node:util'
import { worldData } from '../../stories/vite/worldData.ts'
import { filterSamplesPlugin } from '../gpu/filterSamples'
import { launchChromium } from '../harness/browser'
import { bundlePage } from '../harness/bundle'
import { withLimit } from '../harness/limit'
import { replaceModules } from '../harness/replaceModules'
import { serveStatic, texelMount } from '../harness/serve'
import { shadowSizePlugin } from '../harness/shadow-size'

/** Size of a picture in the gallery, and of its file at most [bytes]. */
const viewport = { width: 320, height: 180 }
const LARGEST = 12_000
/** Longest that a picture may take [s]. */
const limitSeconds = 300

const storiesFolder = fileURLToPath(new URL('../../stories/src', import.meta.url))
const pictures = fileURLToPath(new URL('../../stories/pictures', import.meta.url))
const baselines = fileURLToPath(new URL('baselines', import.meta.url))

/**
 * Draws pictures for the stories' gallery.
 *
 * @param words - Words of which names have one; left out, all are drawn.
 * @param isAgain - True to draw those that there are, here or among those of visual tests, as well.
 */
async function drawAll(words: readonly string[], isAgain: boolean): Promise<void> {
  mkdirSync(pictures, { recursive: true })
  const files = Object.fromEntries(
    readdirSync(storiesFolder, { recursive: true, encoding: 'utf8' })
      .filter(file => /\.(scene|stories)\.ts$/.test(file))
      .map(file => [basename(file, '.ts'), join(storiesFolder, file)])
  )
  const root = fileURLToPath(new URL('page', import.meta.url))
  const plugins = [replaceModules(), filterSamplesPlugin(), shadowSizePlugin(), worldData()]
  const folder = await bundlePage(root, files, plugins)
  const server = await serveStatic([texelMount(), { path: '/', folder }])
  const browser = await launchChromium()
  const context = await browser.newContext({ viewport, deviceScaleFactor: 1 })
  const open = async () => {
    const page = await context.newPage()
    await page.goto(`${server.origin}/index.html`)
    await page.waitForFunction(() => 'welkinVisual' in window)
    return page
  }
  try {
    let page = await open()
    for (const { file, story } of await page.evaluate(() => window.welkinVisual.listAll())) {
      const name = `${file}-${story}`.toLowerCase()
      const own = join(pictures, `${name}.jpg`)
      const isMissing = !existsSync(own) && !existsSync(join(baselines, `${name}.png`))
      if (!isMissing && !isAgain) continue
      if (words.length > 0 && !words.some(word => name.includes(word))) continue
      try {
        const shooting = page.evaluate(
          ([f, s]) => window.welkinVisual.shoot(f, s, 'webgpu', 'image/jpeg'),
          [file, story] as const
        )
        const { url, milliseconds, messages } = await withLimit(shooting, limitSeconds)
        const bytes = Buffer.from(url.split(',')[1], 'base64')
        if (bytes.length > LARGEST) throw new Error(`${bytes.length} bytes`)
        if (messages.length > 0) throw new Error(messages.join('\n'))
        writeFileSync(own, bytes)
        const seconds = (milliseconds / 1000).toFixed(1)
        console.log(`${name.padEnd(40)} ${seconds} s, ${(bytes.length / 1000).toFixed(1)} kB`)
      } catch (error) {
        process.exitCode = 1
        console.error(`${name.padEnd(40)} failed: ${String(error)}`)
        await page.close()
        page = await open()
      }
    }
  } finally {
    await browser.close()
    await server.close()
  }
}

const { values, positionals } = parseArgs({
  allowPositionals: true,
  options: { again: { type: 'boolean', default: false } }
})
await drawAll(positionals, values.again)

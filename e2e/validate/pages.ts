import type { Page } from 'playwright-core'
import { fileURLToPath } from 'node:url'
import { launchChromium } from '../harness/browser'
import { bundlePage } from '../harness/bundle'
import { serveStatic } from '../harness/serve'

/**
 * Serves the validation's page to one Chromium for as long as it is used.
 *
 * @param ready - Function of its window that is waited for.
 * @param use - Takes what opens a fresh page.
 */
export async function withPages<T>(
  ready: keyof Window,
  use: (open: () => Promise<Page>) => Promise<T>
): Promise<T> {
  const folder = await bundlePage(fileURLToPath(new URL('page', import.meta.url)), {})
  const server = await serveStatic([{ path: '/', folder }])
  const browser = await launchChromium()
  try {
    return await use(async () => {
      const page = await browser.newPage()
      await page.goto(`${server.origin}/index.html`)
      await page.waitForFunction(name => name in window, ready)
      return page
    })
  } finally {
    await browser.close()
    await server.close()
  }
}

import type { Page } from 'playwright-core'
import { fileURLToPath } from 'node:url'
import { launchChromium } from '../harness/browser'
import { bundlePage } from '../harness/bundle'
import { replaceModules } from '../harness/replaceModules'
import { serveStatic, texelMount } from '../harness/serve'

/**
 * Serves the validation's page to one Chromium for as long as it is used. Its pages share tables of diffuse light: of the same air
 * on the same backend the first that bakes one keeps it for the others.
 *
 * @param ready - Function of its window that is waited for.
 * @param use - Takes what opens a fresh page.
 */
export async function withPages<T>(
  ready: keyof Window,
  use: (open: () => Promise<Page>) => Promise<T>
): Promise<T> {
  const folder = await bundlePage(fileURLToPath(new URL('page', import.meta.url)), {}, [
    replaceModules()
  ])
  const server = await serveStatic([texelMount(), { path: '/', folder }])
  const browser = await launchChromium()
  try {
    const context = await browser.newContext()
    return await use(async () => {
      const page = await context.newPage()
      await page.goto(`${server.origin}/index.html`)
      await page.waitForFunction(name => name in window, ready)
      return page
    })
  } finally {
    await browser.close()
    await server.close()
  }
}

import { fileURLToPath } from 'node:url'
import { launchChromium } from '../harness/browser'
import { bundlePage } from '../harness/bundle'
import { serveStatic } from '../harness/serve'
import type { EvaluationRequest, EvaluationResult } from './request'

/** Runs requests through the GPU in one Chromium, a fresh page each. */
export async function evaluateInBrowser(
  requests: EvaluationRequest[]
): Promise<EvaluationResult[]> {
  const folder = await bundlePage(fileURLToPath(new URL('page', import.meta.url)), {})
  const server = await serveStatic([{ path: '/', folder }])
  const browser = await launchChromium()
  try {
    const results: EvaluationResult[] = []
    for (const request of requests) {
      const page = await browser.newPage()
      await page.goto(`${server.origin}/index.html`)
      await page.waitForFunction(() => 'welkinEvaluate' in window)
      results.push(await page.evaluate(asked => window.welkinEvaluate(asked), request))
      await page.close()
    }
    return results
  } finally {
    await browser.close()
    await server.close()
  }
}

import { withPages } from './pages'
import type { EvaluationRequest, EvaluationResult } from './request'

/** Runs requests through the GPU in one Chromium, a fresh page each. */
export async function evaluateInBrowser(
  requests: EvaluationRequest[]
): Promise<EvaluationResult[]> {
  return await withPages('welkinEvaluate', async open => {
    const results: EvaluationResult[] = []
    for (const request of requests) {
      const page = await open()
      results.push(await page.evaluate(asked => window.welkinEvaluate(asked), request))
      await page.close()
    }
    return results
  })
}

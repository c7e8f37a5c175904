import type { Backend } from '../../harness/backend'
import type { GpuContext } from './context'

export interface GpuTest {
  name: string
  body: (context: GpuContext) => Promise<void> | void
  backends: readonly Backend[]
  timeoutSeconds: number
  /**
   * Backends on which tables and noise are baked and environments filtered as users have it: all or
   * these. On others a test takes tables of earlier ones, and three's filter has few samples.
   */
  bakes: boolean | readonly Backend[]
}

/** Tests of the one suite that this page has loaded. */
export const registeredTests: GpuTest[] = []

let areShadowsFine = false

/** True if the page's tests measure the clouds' shadows. */
export const measuresShadows = (): boolean => areShadowsFine

/** Has all tests of a file draw shadow maps of clouds as users have them, not a quarter as fine. */
export function takeFineShadows(): void {
  areShadowsFine = true
}

/**
 * Adds a test that runs in Chromium once per backend, in a page of its suite's own.
 * It fails on a thrown error and on any error or warning of three's in the console.
 *
 * @param name - Sentence that holds; unique in its file.
 */
export function gpuTest(
  name: string,
  body: GpuTest['body'],
  options: Partial<Pick<GpuTest, 'backends' | 'timeoutSeconds' | 'bakes'>> = {}
): void {
  if (registeredTests.some(test => test.name === name)) {
    throw new Error(`gpuTest: two tests are named '${name}'`)
  }
  registeredTests.push({
    backends: ['webgpu', 'webgl'],
    timeoutSeconds: 180,
    bakes: false,
    ...options,
    name,
    body
  })
}

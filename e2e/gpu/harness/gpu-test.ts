import type { Backend } from '../../harness/backend'
import type { GpuContext } from './context'
import type { ShadowSize } from './shadow-size'

export interface GpuTest {
  name: string
  body: (context: GpuContext) => Promise<void> | void
  /** Backends that it runs on; which they should be: see CONTRIBUTING.md, Tests. */
  backends: readonly Backend[]
  timeoutSeconds: number
  /**
   * True if tables and noise are baked and environments filtered as users have it. Else a test takes tables of earlier ones, and
   * three's filter has few samples.
   */
  bakes: boolean
}

/** Tests of a file. */
export interface GpuSuite {
  tests: GpuTest[]
  /** Coarse, unless they measure the clouds' shadows. */
  shadowSize: ShadowSize
}

const _suites = new Map<string, GpuSuite>()
let current: GpuSuite = { tests: [], shadowSize: 'coarse' }

/** Tests that a file registers when it is loaded, which it is once in a page. */
export async function loadSuite(name: string, load: () => Promise<unknown>): Promise<GpuSuite> {
  const loaded = _suites.get(name)
  if (loaded) return loaded
  const suite: GpuSuite = { tests: [], shadowSize: 'coarse' }
  current = suite
  await load()
  _suites.set(name, suite)
  return suite
}

/**
 * Has all tests of a file draw shadow maps of clouds as users have them, not a quarter as fine.
 *
 * @param size - Half as fine, where such maps pass for those.
 */
export function takeFineShadows(size: 'fine' | 'half' = 'fine'): void {
  current.shadowSize = size
}

/**
 * Adds a test that runs in Chromium once per backend, in a page where others have run.
 * It fails on a thrown error and on any error or warning of three's in the console.
 *
 * @param name - Sentence that holds; unique in its file.
 */
export function gpuTest(
  name: string,
  body: GpuTest['body'],
  options: Partial<Pick<GpuTest, 'backends' | 'timeoutSeconds' | 'bakes'>> = {}
): void {
  if (current.tests.some(test => test.name === name)) {
    throw new Error(`gpuTest: two tests are named '${name}'`)
  }
  current.tests.push({
    backends: ['webgpu', 'webgl'],
    timeoutSeconds: 600,
    bakes: false,
    ...options,
    name,
    body
  })
}

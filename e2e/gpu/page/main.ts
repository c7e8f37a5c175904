import { modules } from 'virtual:modules'
import { createContext } from '../harness/context'
import { loadSuite, type GpuSuite } from '../harness/gpu-test'
import type { Backend } from '../../harness/backend'
import { loadTexels } from '../harness/kept-texels'
import { filterCoarsely } from '../harness/filter-samples'
import { keepTables, reuseTables } from '../harness/reuse-tables'
import { requestOffscreenFrames } from '../../harness/offscreenFrames'
import { freeResources, shareDevice } from '../../harness/shareDevice'
import { setShadowSize } from '../harness/shadow-size'

export interface TestListing {
  name: string
  timeoutSeconds: number
}

export interface TestOutcome {
  /** Stack or message of the failure; absent when the test passed. */
  error?: string
  milliseconds: number
  notes: string[]
}

export interface TestPage {
  list: (suite: string, backend: Backend) => Promise<TestListing[]>
  run: (suite: string, name: string, backend: Backend) => Promise<TestOutcome>
}

declare global {
  interface Window {
    welkinTests: TestPage
  }
}

requestOffscreenFrames()
shareDevice()

async function load(suite: string): Promise<GpuSuite> {
  const module = modules[suite]
  if (module === undefined) throw new Error(`no suite named ${suite}`)
  return loadSuite(suite, module)
}

window.welkinTests = {
  async list(suite, backend) {
    const { tests } = await load(suite)
    await loadTexels()
    return tests
      .filter(test => test.backends.includes(backend))
      .map(({ name, timeoutSeconds }) => ({ name, timeoutSeconds }))
  },

  async run(suite, name, backend) {
    const { tests, shadowSize } = await load(suite)
    const test = tests.find(candidate => candidate.name === name)
    if (test === undefined) throw new Error(`no test named ${name}`)
    reuseTables(!test.bakes)
    filterCoarsely(!test.bakes)
    setShadowSize(shadowSize)
    const { context, finish } = createContext(backend)
    const start = performance.now()
    const problems: string[] = []
    try {
      await test.body(context)
    } catch (error) {
      problems.push(error instanceof Error ? (error.stack ?? error.message) : String(error))
    }
    await keepTables()
    const { messages, notes } = await finish()
    await freeResources()
    problems.push(...messages)
    const milliseconds = performance.now() - start
    return problems.length === 0
      ? { milliseconds, notes }
      : { error: problems.join('\n'), milliseconds, notes }
  }
}

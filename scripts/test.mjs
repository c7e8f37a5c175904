// Everything that CI runs. Node's own modules only: it starts on a fresh clone.
import { spawn } from 'node:child_process'
import { mkdtempSync, readFileSync, rmSync } from 'node:fs'
import { tmpdir } from 'node:os'
import { join } from 'node:path'
import { parseArgs } from 'node:util'
import { ensureInstalled, npmCommand, rootFolder } from './install.mjs'
import { watchProcessorTime } from './processorTime.mjs'

/** Unit tests that take a quarter of the time of all: they solve the light of the air, or trace shaders of all features. */
const slowUnitTests = [
  'e2e/test/textures.test.ts',
  'packages/atmosphere/test/parameters/planets.test.ts',
  'packages/atmosphere/test/queries/illuminance.test.ts',
  'packages/clouds/test/noise/noise.test.ts'
]

/**
 * Steps in their order. Those with a `lane` come first: lanes run side by side, the steps of one in turn, and the output of a
 * step comes when it ends. Most keep one core busy; that of movements mostly waits. Steps without one have browsers for all
 * cores, and run alone.
 */
const steps = [
  { id: 'types', title: 'Types', lane: 'packages' },
  { id: 'lint', title: 'Lint and format', lane: 'numbers' },
  { id: 'build', title: 'Library builds', lane: 'packages' },
  { id: 'packages', title: 'Published packages', script: 'test:packages', lane: 'packages' },
  { id: 'size', title: 'Bundle size', lane: 'packages' },
  // Installs what the builds have made.
  { id: 'consumer', title: 'Consumer install', script: 'test:consumer', lane: 'packages' },
  { id: 'unit', title: 'Unit tests', script: 'test:unit', reporter: 'vitest', lane: 'numbers' },
  {
    id: 'quick',
    title: 'Quick unit tests',
    script: 'test:unit',
    args: slowUnitTests.flatMap(file => ['--exclude', file]),
    reporter: 'vitest',
    lane: 'numbers',
    onDemand: true
  },
  {
    id: 'validate',
    title: 'Reference data',
    // In one: both take the same tables. 66 colours of 800 have a mean and a 95th percentile as well.
    args: ['--check', '--path', 'volume,march', '--every', '12'],
    lane: 'numbers'
  },
  {
    id: 'shafts',
    title: 'Reference shafts',
    script: 'validate',
    // Every fourth camera: all scenes are among them. On WebGL GPU tests march the same shader.
    args: [
      '--check',
      '--shafts',
      '--all',
      '--backend',
      'webgpu',
      '--quality',
      'medium,high',
      '--every',
      '4'
    ],
    lane: 'numbers'
  },
  { id: 'moving', title: 'Moving in stories', script: 'test:moving', lane: 'moving' },
  { id: 'gpu', title: 'GPU tests', script: 'test:gpu' },
  { id: 'smoke', title: 'GPU smoke test', script: 'test:gpu', args: ['smoke'], onDemand: true },
  { id: 'visual', title: 'Visual regression', script: 'test:visual' }
]
/** Longest that a step may take: GPU tests take a third of it on two cores, and most of it on slow ones. */
const stepMinutes = 60

const { values } = parseArgs({ options: { only: { type: 'string' } } })
const chosen = values.only?.split(',')
for (const id of chosen ?? []) {
  if (!steps.some(step => step.id === id)) throw new Error(`there is no step '${id}'`)
}

ensureInstalled()

const countsFolder = mkdtempSync(join(tmpdir(), 'welkin-test-'))
const running = new Set()

function stop(child) {
  // The whole group: a step's browser and servers are its grandchildren.
  if (process.platform === 'win32') child.kill()
  else process.kill(-child.pid, 'SIGKILL')
}

for (const signal of ['SIGINT', 'SIGTERM']) {
  process.on(signal, () => {
    for (const child of running) stop(child)
    process.exit(130)
  })
}

/** Runs a step. @returns What came of it, and its output if that was not shown. */
function runStep({ id, script = id, args = [], reporter }, isShown) {
  const countsFile = join(countsFolder, `${id}.json`)
  const { command, prefix, shell } = npmCommand()
  const reporting =
    reporter === 'vitest'
      ? ['--reporter=default', '--reporter=json', `--outputFile.json=${countsFile}`]
      : []
  return new Promise(resolve => {
    const child = spawn(
      command,
      [...prefix, 'run', '--silent', script, '--', ...args, ...reporting],
      {
        cwd: rootFolder,
        stdio: ['ignore', isShown ? 'inherit' : 'pipe', isShown ? 'inherit' : 'pipe'],
        shell,
        detached: process.platform !== 'win32',
        env: { ...process.env, WELKIN_COUNTS: countsFile }
      }
    )
    running.add(child)
    const processorTime = watchProcessorTime(child.pid)
    let output = ''
    for (const stream of [child.stdout, child.stderr]) {
      stream?.setEncoding('utf8').on('data', text => (output += text))
    }
    const timer = setTimeout(() => {
      console.error(`${id} ran longer than ${stepMinutes} minutes`)
      stop(child)
    }, stepMinutes * 60_000)
    child.on('close', code => {
      clearTimeout(timer)
      running.delete(child)
      const counts = readCounts(countsFile, code === 0)
      resolve({ ok: code === 0, output, processorSeconds: processorTime(), ...counts })
    })
  })
}

/** Counts that the step wrote; a step without any is one test. A failed step has a failure. */
function readCounts(file, ok) {
  let passed = ok ? 1 : 0
  let failed = 0
  let failures = []
  try {
    const counts = JSON.parse(readFileSync(file, 'utf8'))
    passed = counts.passed ?? counts.numPassedTests
    failed = counts.failed ?? counts.numFailedTests
    failures = counts.failures ?? vitestFailures(counts)
  } catch {
    // The step counts nothing, or ended before it could.
  }
  return { passed, failed: ok ? failed : Math.max(failed, 1), failures }
}

/** Names of the failed tests in vitest's JSON report, each with the first line of its message. */
function vitestFailures({ testResults }) {
  return testResults
    .flatMap(({ assertionResults }) => assertionResults)
    .filter(({ status }) => status === 'failed')
    .map(({ fullName, failureMessages }) => `${fullName}\n${failureMessages[0]?.split('\n')[0]}`)
}

const seconds = since => `${((performance.now() - since) / 1000).toFixed(1)} s`
const begin = performance.now()
const summary = []
const totals = { passed: 0, failed: 0 }
/** What failed, again at the end: a long log is often read from there. */
const allFailures = []

/** Runs steps one after the other. */
async function runSteps(own, isShown) {
  for (const step of own) {
    const title = `\n━━ ${step.title} ━━`
    if (isShown) console.log(title)
    const start = performance.now()
    const { ok, passed, failed, failures, output, processorSeconds } = await runStep(step, isShown)
    if (!isShown) console.log(`${title}\n${output.trimEnd()}`)
    totals.passed += passed
    totals.failed += failed
    allFailures.push(...failures.map(failure => `${step.title}: ${failure}`))
    const mark = ok && failed === 0 ? '✓' : '✗'
    // What keeps cores busy counts on a machine that has other work, too.
    const busy =
      processorSeconds === undefined ? '' : `, ${processorSeconds.toFixed(0)} s of processor`
    const times = `${seconds(start)}${busy}`
    summary.push(`${mark} ${step.title.padEnd(20)} ${passed} ok, ${failed} not, ${times}`)
  }
}

const wanted = steps.filter(({ id, onDemand }) => chosen?.includes(id) ?? !onDemand)
const lanes = new Set(wanted.flatMap(({ lane }) => lane ?? []))
await Promise.all(
  Array.from(lanes, name =>
    runSteps(
      wanted.filter(({ lane }) => lane === name),
      lanes.size === 1
    )
  )
)
await runSteps(
  wanted.filter(({ lane }) => lane === undefined),
  true
)

rmSync(countsFolder, { recursive: true, force: true })
console.log(`\n━━ Summary ━━\n${summary.join('\n')}\ntotal ${seconds(begin)}\n`)
for (const failure of allFailures) console.log(`✗ ${failure.replace(/\n/g, '\n    ')}\n`)
console.log(`${totals.passed} passed, ${totals.failed} failed`)
process.exitCode = totals.failed === 0 ? 0 : 1

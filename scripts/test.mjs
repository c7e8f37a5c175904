// Everything that CI runs. Node's own modules only: it starts on a fresh clone.
import { spawn } from 'node:child_process'
import { mkdtempSync, readFileSync, rmSync } from 'node:fs'
import { tmpdir } from 'node:os'
import { join } from 'node:path'
import { parseArgs } from 'node:util'
import { ensureInstalled, npmCommand, rootFolder } from './install.mjs'

const steps = [
  { id: 'types', title: 'Types' },
  { id: 'lint', title: 'Lint and format' },
  { id: 'unit', title: 'Unit tests', script: 'test:unit', reporter: 'vitest' },
  { id: 'build', title: 'Library builds' },
  { id: 'packages', title: 'Published packages', script: 'test:packages' },
  { id: 'size', title: 'Bundle size' },
  { id: 'gpu', title: 'GPU tests', script: 'test:gpu' },
  { id: 'smoke', title: 'GPU smoke test', script: 'test:gpu', args: ['smoke'], onDemand: true },
  { id: 'validate', title: 'Reference data', args: ['--check'] },
  {
    id: 'march',
    title: 'Reference march',
    script: 'validate',
    args: ['--check', '--path', 'march']
  },
  {
    id: 'shafts',
    title: 'Reference shafts',
    script: 'validate',
    args: ['--check', '--shafts', '--all', '--every', '4']
  },
  { id: 'visual', title: 'Visual regression', script: 'test:visual' },
  { id: 'moving', title: 'Moving in stories', script: 'test:moving' },
  { id: 'consumer', title: 'Consumer install', script: 'test:consumer' }
]
const stepMinutes = 40

const { values } = parseArgs({ options: { only: { type: 'string' } } })
const chosen = values.only?.split(',')
for (const id of chosen ?? []) {
  if (!steps.some(step => step.id === id)) throw new Error(`there is no step '${id}'`)
}

ensureInstalled()

const countsFolder = mkdtempSync(join(tmpdir(), 'welkin-test-'))
let running

function stop(child) {
  // The whole group: a step's browser and servers are its grandchildren.
  if (process.platform === 'win32') child.kill()
  else process.kill(-child.pid, 'SIGKILL')
}

for (const signal of ['SIGINT', 'SIGTERM']) {
  process.on(signal, () => {
    if (running !== undefined) stop(running)
    process.exit(130)
  })
}

function runStep({ id, script = id, args = [], reporter }) {
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
        stdio: ['ignore', 'inherit', 'inherit'],
        shell,
        detached: process.platform !== 'win32',
        env: { ...process.env, WELKIN_COUNTS: countsFile }
      }
    )
    running = child
    const timer = setTimeout(() => {
      console.error(`${id} ran longer than ${stepMinutes} minutes`)
      stop(child)
    }, stepMinutes * 60_000)
    child.on('exit', code => {
      clearTimeout(timer)
      running = undefined
      resolve({ ok: code === 0, ...readCounts(countsFile, code === 0) })
    })
  })
}

/** Counts that the step wrote; a step without any is one test. A failed step has a failure. */
function readCounts(file, ok) {
  let passed = ok ? 1 : 0
  let failed = 0
  try {
    const counts = JSON.parse(readFileSync(file, 'utf8'))
    passed = counts.passed ?? counts.numPassedTests
    failed = counts.failed ?? counts.numFailedTests
  } catch {
    // The step counts nothing, or ended before it could.
  }
  return { passed, failed: ok ? failed : Math.max(failed, 1) }
}

const seconds = since => `${((performance.now() - since) / 1000).toFixed(1)} s`
const begin = performance.now()
const summary = []
const totals = { passed: 0, failed: 0 }

for (const step of steps) {
  if (chosen === undefined ? step.onDemand : !chosen.includes(step.id)) continue
  console.log(`\n━━ ${step.title} ━━`)
  const start = performance.now()
  const { ok, passed, failed } = await runStep(step)
  totals.passed += passed
  totals.failed += failed
  const mark = ok && failed === 0 ? '✓' : '✗'
  summary.push(`${mark} ${step.title.padEnd(20)} ${passed} ok, ${failed} not, ${seconds(start)}`)
}

rmSync(countsFolder, { recursive: true, force: true })
console.log(`\n━━ Summary ━━\n${summary.join('\n')}\ntotal ${seconds(begin)}\n`)
console.log(`${totals.passed} passed, ${totals.failed} failed`)
process.exitCode = totals.failed === 0 ? 0 : 1

import { spawnSync } from 'node:child_process'
import { fileURLToPath } from 'node:url'
import { Report } from './harness/report'

const root = fileURLToPath(new URL('..', import.meta.url))
const report = new Report()

function check(name: string, binary: string, args: string[]): void {
  const { status, stdout, stderr } = spawnSync('npx', ['--no-install', binary, ...args], {
    cwd: root,
    encoding: 'utf8',
    shell: process.platform === 'win32'
  })
  if (status === 0) report.pass(name)
  else report.fail(name, `${stdout}${stderr}`.trim())
}

for (const name of ['geo', 'atmosphere', 'clouds', 'terrain']) {
  const folder = `packages/${name}`
  check(`${name}: publint`, 'publint', ['--strict', folder])
  check(`${name}: types resolve for ESM`, 'attw', ['--profile', 'esm-only', '--pack', folder])
}
report.finish()

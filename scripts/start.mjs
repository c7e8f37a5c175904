import { spawn } from 'node:child_process'
import { ensureInstalled, npmCommand, rootFolder } from './install.mjs'

ensureInstalled()

const { command, prefix, shell } = npmCommand()
const interactive = process.stdout.isTTY && !process.env.CI
// --ci: no questions, and no browser to open where nobody sits in front of one.
const options = [...(interactive ? [] : ['--ci']), ...process.argv.slice(2)]
const child = spawn(command, [...prefix, 'run', 'storybook', '-w', 'stories', '--', ...options], {
  cwd: rootFolder,
  stdio: 'inherit',
  shell,
  detached: process.platform !== 'win32',
  env: { ...process.env, STORYBOOK_DISABLE_TELEMETRY: '1' }
})
for (const signal of ['SIGINT', 'SIGTERM', 'SIGHUP']) {
  process.on(signal, () => {
    // The whole group: the server is a grandchild.
    if (process.platform === 'win32') child.kill(signal)
    else if (child.pid !== undefined) process.kill(-child.pid, signal)
  })
}
child.on('exit', code => {
  process.exitCode = code ?? 0
})

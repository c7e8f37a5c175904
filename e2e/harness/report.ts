import { mkdirSync, writeFileSync } from 'node:fs'
import { fileURLToPath } from 'node:url'

/** Everything that test runs write: failed pictures, bundles, counts. Ignored by git. */
export const outputFolder = fileURLToPath(new URL('../output', import.meta.url))
mkdirSync(outputFolder, { recursive: true })

const colored = process.stdout.isTTY
const paint = (code: number, text: string): string =>
  colored ? `\u001b[${code}m${text}\u001b[0m` : text

/** Prints one line per check, and hands the totals to `npm test`. */
export class Report {
  passed = 0
  /** Failures and their reasons, for the summary of `npm test`. */
  private readonly failures: string[] = []

  pass(name: string, detail = ''): void {
    this.passed++
    console.log(`  ${paint(32, '✓')} ${name}${detail === '' ? '' : paint(90, `  ${detail}`)}`)
  }

  fail(name: string, reason: string): void {
    this.failures.push(`${name}\n${reason}`)
    console.log(`  ${paint(31, '✗')} ${name}`)
    console.log(reason.replace(/^/gm, '      '))
  }

  check(condition: boolean, name: string, detail: string): void {
    if (condition) this.pass(name, detail)
    else this.fail(name, detail)
  }

  /** Sets the process's exit code; nothing checked counts as a failure. */
  finish(): void {
    if (this.passed + this.failures.length === 0)
      this.fail('found a test to run', 'no test matched')
    const { passed, failures } = this
    const counts = { passed, failed: failures.length, failures }
    const file = process.env.WELKIN_COUNTS
    if (file !== undefined) writeFileSync(file, JSON.stringify(counts))
    if (failures.length > 0) process.exitCode = 1
  }
}

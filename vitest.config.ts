import { readdirSync, readFileSync } from 'node:fs'
import { defineConfig } from 'vitest/config'
import { sourceAliases } from './scripts/aliases'

/** Tests of the stories and of the tests' own code. */
const others = ['stories/test', 'e2e/test'].flatMap(folder =>
  readdirSync(folder, { recursive: true, encoding: 'utf8' })
    .map(file => `${folder}/${file.replaceAll('\\', '/')}`)
    .filter(file => file.endsWith('.test.ts'))
)
/** True for code that replaces modules, or globals for good, or sets up what a browser has: others must not see it. */
const changesOthers = (code: string): boolean =>
  /vi\.mock\(|sampledTextures/.test(code) ||
  (code.includes('vi.stubGlobal(') && !code.includes('vi.unstubAllGlobals'))
const alone = others.filter(file => changesOthers(readFileSync(file, 'utf8')))

export default defineConfig({
  resolve: { alias: sourceAliases },
  test: {
    environment: 'node',
    testTimeout: 300_000,
    // Two workers: more only compete on the two cores that CI has.
    maxWorkers: 2,
    projects: [
      {
        extends: true,
        test: {
          name: 'together',
          include: [
            'packages/*/{src,test}/**/*.test.ts',
            ...others.filter(file => !alone.includes(file))
          ],
          // A worker imports three and the packages once for all of its files: they change nothing of other modules for good.
          isolate: false
        }
      },
      { extends: true, test: { name: 'alone', include: alone } }
    ]
  }
})

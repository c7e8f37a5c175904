import { readdirSync, readFileSync } from 'node:fs'
import { defineConfig } from 'vitest/config'
import { sourceAliases } from './scripts/aliases'

/** Tests of the stories and of the tests' own code. */
const others = ['stories/test', 'e2e/test'].flatMap(folder =>
  readdirSync(folder, { recursive: true, encoding: 'utf8' })
    .map(file => `${folder}/${file.replaceAll('\\', '/')}`)
    .filter(file => file.endsWith('.test.ts'))
)
/** Those that replace modules or globals, or set up what a browser has: others must not see it. */
const alone = others.filter(file =>
  /vi\.(mock|stubGlobal)\(|sampledTextures/.test(readFileSync(file, 'utf8'))
)

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
          name: 'packages',
          include: ['packages/*/{src,test}/**/*.test.ts'],
          // A worker imports three once for all of its files: they change nothing of other modules for good.
          isolate: false
        }
      },
      {
        extends: true,
        test: {
          name: 'stories',
          include: others.filter(file => !alone.includes(file)),
          isolate: false
        }
      },
      { extends: true, test: { name: 'alone', include: alone } }
    ]
  }
})

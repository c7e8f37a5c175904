import { defineConfig } from 'vitest/config'
import { sourceAliases } from './scripts/aliases'

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
        // These set up what a browser has, and replace modules.
        test: { name: 'stories', include: ['{stories,e2e}/{src,test}/**/*.test.ts'] }
      }
    ]
  }
})

import { defineConfig } from 'vitest/config'
import { sourceAliases } from './scripts/aliases'

export default defineConfig({
  resolve: { alias: sourceAliases },
  test: {
    environment: 'node',
    include: ['{packages/*,stories,e2e}/{src,test}/**/*.test.ts'],
    testTimeout: 300_000,
    // Two workers: more only compete on the two cores that CI has.
    maxWorkers: 2
  }
})

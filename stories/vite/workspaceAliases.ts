import { fileURLToPath } from 'node:url'

/** The packages by name, from their sources: no build is needed while developing. */
export const workspaceAliases = ['geo', 'atmosphere', 'clouds'].map(name => ({
  find: `@welkin/${name}`,
  replacement: fileURLToPath(new URL(`../../packages/${name}/src/index.ts`, import.meta.url))
}))

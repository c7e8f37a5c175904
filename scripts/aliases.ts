import { fileURLToPath } from 'node:url'

const source = (name: string): string =>
  fileURLToPath(new URL(`../packages/${name}/src/index.ts`, import.meta.url))

/** Packages resolve to their sources in development, to `dist` once published. */
export const sourceAliases: Record<string, string> = {
  '@welkin/geo': source('geo'),
  '@welkin/atmosphere': source('atmosphere'),
  '@welkin/clouds': source('clouds'),
  '@welkin/terrain': source('terrain')
}

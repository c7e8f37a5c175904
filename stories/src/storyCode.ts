import { codeRegion } from './codeRegion'

const sources = import.meta.glob<string>(
  [
    './quickStart.ts',
    './air.ts',
    './*.scene.ts',
    './street/Street.ts',
    './valleyAir.ts',
    './valleyFactors.ts'
  ],
  { query: '?raw', import: 'default', eager: true }
)

/** The code of a story, as `mount` shows it: the region NAME of a file beside this one. */
export function storyCode(file: string, name: string): string {
  return codeRegion(sources[`./${file}`] ?? '', name)
}

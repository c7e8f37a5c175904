import { codeOf, type Region } from './codeRegion'

const sources = import.meta.glob<string>(
  [
    './quickStart.ts',
    './air.ts',
    './*.scene.ts',
    './street/Street.ts',
    './terrain/NightSky.ts',
    './valleyAir.ts',
    './valleyFactors.ts',
    './valley/flashes.ts'
  ],
  { query: '?raw', import: 'default', eager: true }
)

/** The code of a story, as `mount` shows it: regions of files beside this one, with their imports. */
export function storyCode(...regions: Region[]): string {
  return codeOf(regions, file => sources[`./${file}`] ?? '')
}

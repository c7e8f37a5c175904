import type { PassTime } from './PassTimes'

/** Features that passes draw, by how the passes' names begin; the first that fits counts. */
const FEATURES: readonly (readonly [prefix: string, feature: string])[] = [
  ['Shadow Map', 'shadow maps'],
  ['Welkin.CloudEnvironment', 'mirrored sky'],
  ['SkyEnvironment', 'mirrored sky'],
  ['PMREM', 'mirrored sky'],
  ['LakeMirror', 'mirrored sky'],
  ['Welkin.CloudShadows', "clouds' shadows"],
  ['Welkin.Cloud', 'clouds'],
  ['Welkin.LightShafts', 'light shafts'],
  ['Welkin.Exposure', 'exposure'],
  ['Welkin.', "air's tables"],
  ['Bloom', 'bloom'],
  // A pass of three's, of what stands in the scene.
  ['output', 'land, trees, village and lake, lit'],
  // The picture, which exposure meters.
  ['Picture', 'sky and haze']
]

const featureOf = (pass: string): string =>
  FEATURES.find(([prefix]) => pass.startsWith(prefix))?.[1] ?? 'tone mapping'

/** GPU time of each feature, the longest first [ms]. */
export function sharesOf(passes: readonly PassTime[]): PassTime[] {
  const sums = new Map<string, number>()
  for (const [name, milliseconds] of passes) {
    const feature = featureOf(name)
    sums.set(feature, (sums.get(feature) ?? 0) + milliseconds)
  }
  return [...sums].sort(([, a], [, b]) => b - a)
}

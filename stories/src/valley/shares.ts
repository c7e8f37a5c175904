import type { FeatureShare } from './FeatureMeter'
import type { PostEffects } from './finish'
import type { PassTime } from './PassTimes'

/** Passes that draw to the canvas. */
const LAST: ReadonlySet<string> = new Set(['canvas', 'Render Pipeline'])

/** Features that passes draw, by how the passes' names begin; the first that fits counts. */
const FEATURES: readonly (readonly [prefix: string, feature: string])[] = [
  ['Shadow Map', 'shadow maps'],
  ['Welkin.CloudEnvironment', 'mirrored sky'],
  ['SkyEnvironment', 'mirrored sky'],
  ['PMREM', 'mirrored sky'],
  ['LakeMirror', 'mirrored sky'],
  ['SkyLightMap', 'light of the sky on the land'],
  ['Welkin.CloudShadows', "clouds' shadows"],
  ['Welkin.FogLight', 'light of the mist'],
  ['Welkin.CloudFogLight', 'light of the mist'],
  ['Welkin.CloudsFall', 'rain and snow under clouds'],
  // Banks of mist are clouds.
  ['Welkin.Cloud', 'clouds and mist'],
  ['Welkin.LightShafts', 'light shafts'],
  ['Welkin.Exposure', 'exposure'],
  ['Welkin.PrecipitationSkylight', 'light of rain and snow'],
  ['Welkin.PrecipitationSunlight', 'light of rain and snow'],
  ['Welkin.Precipitation', 'rain and snow around the camera'],
  ['Welkin.Lightning', 'lightning'],
  ['Welkin.', "air's tables"],
  ['Bloom', 'bloom'],
  ['Occlusion', 'ambient occlusion'],
  ['AO', 'ambient occlusion'],
  ['TRAA', 'TRAA'],
  ['TAAU', 'TAAU'],
  ['DoF', 'depth of field'],
  ['DepthOfField', 'depth of field'],
  ['MotionBlur', 'motion blur'],
  ['Motion', 'velocity of sky and clouds'],
  ['SMAA', 'SMAA'],
  ['LocalExposure', 'local exposure'],
  ['Shown', 'tone mapping'],
  // A pass of three's, of what stands in the scene.
  ['output', 'land, trees, village and lake, lit'],
  // The picture, which exposure meters: all that is drawn over the scene, pixel by pixel, and put together.
  ['Picture', 'sky, stars and haze, put together']
]

/** Post effects that the last pass draws. */
export type LastPass = Pick<PostEffects, 'antialiasing' | 'bloom' | 'motionBlur'>

/** Name of what the last pass draws, to the canvas. */
export function lastFeature({ antialiasing, bloom, motionBlur }: LastPass): string {
  if (antialiasing === 'edges') return 'smooth edges'
  if (antialiasing === 'fxaa') return 'FXAA'
  if (antialiasing === 'smaa') return 'SMAA'
  return motionBlur && !bloom ? 'motion blur and tone mapping' : 'tone mapping'
}

/**
 * GPU time of each feature, the longest first [ms]. What one pass draws has one share, named for all of it.
 *
 * @param last - Post effects that the last pass draws.
 */
export function sharesOf(passes: readonly PassTime[], last: LastPass): PassTime[] {
  const sums = new Map<string, number>()
  for (const [name, milliseconds] of passes) {
    const known = FEATURES.find(([prefix]) => name.startsWith(prefix))?.[1]
    const feature = known ?? (LAST.has(name) ? lastFeature(last) : name)
    sums.set(feature, (sums.get(feature) ?? 0) + milliseconds)
  }
  return [...sums].sort(([, a], [, b]) => b - a)
}

/** Readings without times after which there will be none. */
const TRIED = 4

/**
 * Line about the GPU's time in a frame, and below it the share of each feature; nothing while none is known.
 *
 * @param passes - Times of the passes of some frames.
 * @param frames - Number of those frames.
 * @param readings - Readings until now.
 */
export function gpuText(
  passes: readonly PassTime[],
  frames: number,
  readings: number,
  last: LastPass
): string {
  if (frames === 0) return readings < TRIED ? '' : ' · no GPU times in this browser'
  const total = passes.reduce((sum, [, milliseconds]) => sum + milliseconds, 0) / frames
  const shares = sharesOf(passes, last)
    .map(([name, milliseconds]) => `${name} ${(milliseconds / frames).toFixed(2)}`)
    .join('\n')
  return ` · GPU ${total.toFixed(1)} ms\n${shares}`
}

/** Lines about what each feature takes, as measured without it, the longest first; nothing while none is measured. */
export function featureText(shares: readonly FeatureShare[]): string {
  if (shares.length === 0) return ''
  const lines = [...shares]
    .sort((a, b) => b.milliseconds - a.milliseconds)
    .map(({ name, milliseconds }) => `${name} ${milliseconds.toFixed(2)}`)
  return `\n\nless without:\n${lines.join('\n')}`
}

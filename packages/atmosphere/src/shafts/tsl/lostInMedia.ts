import { If, float, int, mix, vec4 } from 'three/tsl'
import { loop, type Float, type Vec4 } from '../../tsl-types'
import type { ShadowedMedium, SkyLayer } from '../../view/SkyLayer'
import type { ShadowedAir, Shadows } from './shadowsAlong'

/**
 * Media of layers as shadows see them.
 *
 * @param isSun - True if the light is the atmosphere's sun.
 */
export const mediaIn = (
  layers: () => readonly SkyLayer[],
  isSun: () => boolean
): Pick<ShadowedAir, 'mediaOn' | 'denser'> => ({
  mediaOn: ray => layers().flatMap(layer => layer.shadowed?.(ray, isSun()) ?? []),
  denser() {
    const factors = layers().flatMap(({ airDensity }) => airDensity ?? [])
    return factors.length > 0 ? factors.reduce((product, factor) => product.mul(factor)) : null
  }
})

/** True if shadows in the air follow a layer's uniforms. */
export const isShadowed = (layer: SkyLayer): boolean =>
  'shadowed' in layer || layer.airDensity !== undefined

/**
 * Light of the air from an even stretch of a ray, as media such as fog leave it: what is in front of them stays.
 *
 * @param placeOf - Place on the ray of a distance [m], in the measure that the stretch is given in.
 */
export function dimmedBy(
  media: readonly ShadowedMedium[],
  placeOf: (distance: Float) => Float
): (light: Vec4, from: Float, length: Float) => Vec4 {
  const fronts = media.map(({ front }) => placeOf(front).toConst() as Float)
  return (light, from, length) =>
    media.reduce<Vec4>((left, { transmittance }, i) => {
      const before = fronts[i].sub(from).div(length).clamp()
      return left.mul(mix(transmittance, 1, before))
    }, light)
}

/**
 * Way from the start of a dark stretch to the middle of its samples [steps]. The stretch is that of the steps, not of the places in them.
 *
 * @param dark - Dark samples, side by side.
 * @param jitter - Place of samples in their steps, in (0, 1).
 */
export const middleOfDark = (dark: Float, jitter: Float): Float => dark.sub(1).mul(0.5).add(jitter)

/**
 * Light that media in the air lose, such as fog, for unit irradiance of the source [1/sr]: of light scattered once the dark
 * part of samples that each stand for as much of it, and what is missing of the diffuse light in the middle.
 *
 * @param media - Media on a view ray, of which each dims those before.
 * @param places - Number of samples, and their place in their steps, in (0, 1).
 */
export function lostInMedia(
  media: readonly ShadowedMedium[],
  { darkAt, missingAt }: { darkAt: (distance: Float) => Float } & Pick<Shadows, 'missingAt'>,
  { count, jitter }: { count: Float; jitter: Float }
): Vec4 {
  const lost = vec4(0).toVar()
  for (const medium of media) {
    const { transmittance, singleScattered: once, multiplyScattered: often } = medium
    if (once === null) {
      lost.mulAssign(transmittance)
      continue
    }
    If(transmittance.lessThan(1), () => {
      const dark = float(0).toVar()
      loop('medium', int(count), index => {
        dark.addAssign(darkAt(medium.distanceAt(float(index).add(jitter).div(count))))
      })
      lost.assign(lost.mul(transmittance).add(once.mul(dark.div(count))))
      if (missingAt) lost.addAssign(often.mul(missingAt(medium.distanceAt(float(0.5)))))
    })
  }
  return lost
}

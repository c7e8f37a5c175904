import { If, float } from 'three/tsl'
import type { TextureNode } from 'three/webgpu'
import type { Bool, Float, Vec3, Vec4 } from '../../tsl-types'
import type { ShadowedMedium } from '../../view/SkyLayer'
import type { ViewUniforms } from '../../view/ViewUniforms'
import type { AirPoint, AirShadow, AirViewRay } from '../AirOccluder'
import { darkPart, softDark, polarRay, type PolarFrame, type PolarRay } from './polarMap'

/** A view ray through media. */
export type MediaRay = Omit<ShaftRay, 'seenFrom'> & { readonly view: ViewUniforms }

/** Shadows in the air, as shaders read them: the sun-polar shadow map, and what reaches beyond it. */
export interface ShadowedAir {
  readonly map: TextureNode
  readonly frame: PolarFrame
  /** Greatest ρ at which the map may have shadows [m]. */
  readonly maximumRho: Float
  /** Part of the light that shadows in the map take [–]. */
  readonly intensity: Float
  /** Shadows of clouds and the like. */
  readonly shadows: readonly Pick<AirShadow, 'transmittance' | 'diffuse'>[]
  /** Media that a ray passes, besides the air, from far layers to near ones. */
  readonly mediaOn: (ray: MediaRay) => readonly ShadowedMedium[]
  /** Factor on the density of the air before things, not before the sky; null is 1. */
  readonly denser: () => Float | null
  /** World position of a displacement from the camera in the mapped space [m]. */
  readonly toWorld: (offset: Vec3) => Vec3
}

/** A view ray, and as far as it is marched. */
export interface ShaftRay {
  /** Unit length, in the mapped space. */
  readonly direction: Vec3
  readonly cosView: Float
  /** ν, against the source of light. */
  readonly cosViewLight: Float
  /** Distance to what is seen; beyond the air for the sky [m]. */
  readonly distance: Float
  /** Part of the light from a distance [m] that reaches the picture; left out, all. */
  readonly seenFrom?: (distance: Float) => Float
  /** See `AirViewRay`. */
  readonly receiver?: object
  /** Start of an orthographic camera's line of sight, as a displacement from the camera [m]. Its light is that of the ray from the camera; shadows are where it passes. */
  readonly start?: Vec3
}

/** Shadows on a view ray, by the distance from the camera. */
export interface Shadows {
  /** Part of the light scattered once that the picture loses. */
  darkAt: (distance: Float, isMapped: Bool | boolean) => Float
  /** Part of the light scattered more than once; null if none is missing. */
  missingAt: ((distance: Float) => Vec4) | null
}

/**
 * Shadows on a view ray.
 *
 * @param polar - The ray in the sun-polar map, asked for where that is read.
 */
export function shadowsAlong(
  view: ViewUniforms,
  { map, frame, intensity, shadows, toWorld }: ShadowedAir,
  { direction, seenFrom, receiver }: Pick<ShaftRay, 'direction' | 'seenFrom' | 'receiver'>,
  polar: () => PolarRay,
  jitter: Float,
  readMap = darkPart
): Shadows {
  const placeAt = (distance: Float): AirPoint => {
    const offset = direction.mul(distance).toConst() as Vec3
    return { view, offset, distance, jitter, positionWorld: () => toWorld(offset) }
  }
  const passing = shadows.map(shadow => shadow.transmittance({ view, direction, jitter, receiver }))
  const dimming = shadows.filter(shadow => shadow.diffuse !== undefined)
  const missingAt = (distance: Float): Vec4 => {
    const parts = dimming.map(shadow => shadow.diffuse!(placeAt(distance)))
    const missing = parts.reduce((product, part) => product.mul(part)).oneMinus()
    return seenFrom === undefined ? missing : missing.mul(seenFrom(distance))
  }
  return {
    darkAt(distance, isMapped) {
      const dark = float(0).toVar() as Float
      const addMap = (): void => {
        dark.assign(readMap(map, frame, polar(), distance).mul(intensity))
      }
      if (isMapped === true) addMap()
      else if (isMapped !== false) If(isMapped, addMap)
      if (passing.length > 0) {
        If(dark.lessThan(1), () => {
          const place = placeAt(distance)
          const parts = passing.map(transmittance => transmittance(place))
          const lit = parts.reduce((product, part) => product.mul(part), dark.oneMinus())
          dark.assign(lit.oneMinus())
        })
      }
      return seenFrom?.(distance).mul(dark) ?? dark
    },
    missingAt: dimming.length > 0 ? missingAt : null
  }
}

/** Shadows on a line of sight that starts beside the camera, by the distance on the ray from the camera to what it meets. */
export function shadowsBeside(
  view: ViewUniforms,
  shadowedAir: ShadowedAir,
  { direction, distance, start }: ShaftRay,
  jitter: Float
): Shadows {
  const at = (from: Float): ReturnType<typeof shadowAt> => {
    const beside = start!.mul(from.div(distance).oneMinus())
    const offset = direction.mul(from).add(beside).toConst() as Vec3
    const far = offset.length().max(1e-3).toConst() as Float
    return shadowAt(view, shadowedAir, { direction: offset.div(far).toConst(), jitter }, far)
  }
  const isDimmed = shadowedAir.shadows.some(({ diffuse }) => diffuse !== undefined)
  return { darkAt: from => at(from).dark, missingAt: isDimmed ? from => at(from).missing! : null }
}

/** Part of the light scattered once, and of that scattered more often, that is missing at a place on a ray from the camera. */
export function shadowAt(
  view: ViewUniforms,
  shadowedAir: ShadowedAir,
  ray: Omit<AirViewRay, 'view'>,
  distance: Float,
  readMap = darkPart
): { dark: Float; missing: Vec4 | null } {
  const { frame, maximumRho } = shadowedAir
  const { direction, jitter } = ray
  const cosViewLight = direction.dot(view.lightDirection).toConst() as Float
  const sinViewLight = cosViewLight.mul(cosViewLight).oneMinus().max(0).sqrt()
  const isMapped = distance.mul(sinViewLight).lessThan(maximumRho) as Bool
  // Many places are beyond the map.
  const polar = (): PolarRay => polarRay(frame, direction, cosViewLight)
  const { darkAt, missingAt } = shadowsAlong(view, shadowedAir, ray, polar, jitter, readMap)
  return { dark: darkAt(distance, isMapped), missing: missingAt && missingAt(distance) }
}

/** Part of the light that arrives at a place on a ray: see `ShadowedShafts.litAt`. */
export function litAt(
  view: ViewUniforms,
  shadowedAir: ShadowedAir,
  ray: Omit<AirViewRay, 'view'>,
  distance: Float,
  strength: Float
): Float {
  const lit = float(1).toVar() as Float
  If(strength.greaterThan(0), () => {
    const { dark } = shadowAt(view, shadowedAir, ray, distance, softDark)
    lit.subAssign(dark.mul(strength.min(1)))
  })
  return lit
}

import type { CloudField } from '../../density/CloudField'
import type { ShadingContext } from '../../light/tsl/shadingContext'
import type { Float, Vec2, Vec3, Vec4 } from '../../tsl-types'

/** Precipitation on a ray, without the clouds on it. */
export interface FallOnRay {
  /** Spectral radiance for unit irradiance of the bare sun [1/sr]. */
  readonly radiance: Vec4
  /** Part of the picture's light that it takes, evenly over a stretch: its middle, and half of its length [m]. */
  readonly opacity: Float
  readonly distance: Float
  readonly half: Float
  /** End of the ray, if that is before what falls ends; `FAR_AWAY` else [m]. */
  readonly end: Float
}

/** Precipitation as casters of shadows see it: see `PrecipitationShafts.placesOn`. */
export interface FallPlaces {
  placesOn(field: CloudField, direction: Vec3, marched: Vec4, distances: Vec4): Vec4
}

/** Precipitation as its pass sees it: see `PrecipitationShafts.among`. */
export interface FallOnRays {
  among(
    context: ShadingContext,
    ray: { direction: Vec3; jitter: Float; marched: Vec4; litFall?: Vec4 },
    distances: Vec4
  ): FallOnRay
}

/** Marched rays with the light that casters leave: see `CastLight`. */
export interface LitRays {
  pointsAt(here: Vec2): { readonly shares: Vec4 }
  rayAt(here: Vec2): { readonly ray: Vec4; readonly litFall?: Vec4 }
}

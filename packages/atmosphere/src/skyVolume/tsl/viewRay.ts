import { sine } from '../../math/tsl/trigonometry'
import type { Bool, Float } from '../../tsl-types'
import type { Viewpoint } from '../../view/tsl/viewpoint'
import { elevationPosition } from './volumeMapping'

/** View ray as the sky volumes of its viewpoint have it, whatever lights them. */
export interface ViewRay {
  /** μ, against the zenith of the viewpoint. */
  cosView: Float
  /** √(1 − μ²). */
  sinView: Float
  /** True if the ray meets the ground. */
  hitsGround: Bool
  /** Position of the elevation in its half, below or above the horizon, in [0, 1] from the horizon. */
  elevation: Float
}

/** Part of a view ray that tables without azimuths depend on. */
export type Elevation = Pick<ViewRay, 'hitsGround' | 'elevation'>

/** @param cosView - μ, direction against the zenith of the viewpoint. */
export function viewRay(
  viewpoint: Viewpoint,
  cosView: Float,
  hitsGround: Bool,
  sinView: Float = sine(cosView).toConst()
): ViewRay {
  const elevation = elevationPosition(viewpoint, cosView, hitsGround, sinView).toConst() as Float
  return { cosView, sinView, hitsGround, elevation }
}

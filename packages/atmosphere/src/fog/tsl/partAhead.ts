import { skyTransmittance } from '../../skyVolume/tsl/meanExtinction'
import type { VolumeSegment } from '../../skyVolume/tsl/skyVolume'
import type { Vec4 } from '../../tsl-types'
import type { LayerRay } from '../../view/SkyLayer'

/** Opacity of air below which float32 does not know its parts. */
const LEAST_OPACITY = 1e-5

/**
 * Part of the air's light on a ray that comes from before a point, as if its source function were the same all along:
 * (1 − e^{−τ'})/(1 − e^{−τ}), τ' the optical depth up to the point and τ that of the ray.
 *
 * @param ahead - The ray up to the point.
 * @param depth - Optical depth of the whole ray, for rays to a point without a segment of a sky volume.
 */
export function partAhead(
  { view, distance, segment }: LayerRay,
  ahead: VolumeSegment,
  depth: Vec4
): Vec4 {
  const { volume, viewpoint } = view
  const through = distance
    ? (segment?.depth ?? depth).negate().exp()
    : skyTransmittance(volume, viewpoint, ahead)
  const opacity = through.oneMinus().max(LEAST_OPACITY)
  return ahead.depth.negate().exp().oneMinus().div(opacity).clamp(0, 1)
}

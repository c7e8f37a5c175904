import { float, vec2 } from 'three/tsl'
import type { Texels } from '../../tables/TableAtlas'
import { DEPTH_SIZE } from '../../tables/tableSizes'
import type { Float, Vec4 } from '../../tsl-types'
import type { Viewpoint } from '../../view/tsl/viewpoint'
import { elevationTexel } from './volumeMapping'
import type { Elevation } from './viewRay'

const [DEPTH_ELEVATIONS, DEPTH_DISTANCES] = DEPTH_SIZE

/** Extinction is stored per this many metres, to stay clear of subnormal half floats. */
export const EXTINCTION_SCALE = 1e5

/** Reads the viewpoint's table of {@link DEPTH_SIZE} at a row, in texels. */
function readDepth(
  atlas: Texels,
  viewpoint: Viewpoint,
  { elevation, hitsGround }: Elevation,
  row: Float
): Vec4 {
  const column = elevationTexel(elevation, hitsGround, DEPTH_ELEVATIONS)
  return atlas.at(vec2(column, row).add(viewpoint.depthOrigin))
}

/**
 * Mean extinction from where a ray enters the air to a position among the distances
 * [1/{@link EXTINCTION_SCALE} m].
 *
 * Depth over distance varies little between elevations, even just below the horizon, where the distance
 * to the ground varies most.
 */
export function meanExtinction(
  atlas: Texels,
  viewpoint: Viewpoint,
  elevation: Elevation,
  position: Float
): Vec4 {
  return readDepth(atlas, viewpoint, elevation, position.mul(DEPTH_DISTANCES).max(1).sub(0.5))
}

/** Transmittance of all the air in a direction; 1 where there is none. */
export function skyTransmittance(atlas: Texels, viewpoint: Viewpoint, elevation: Elevation): Vec4 {
  return readDepth(atlas, viewpoint, elevation, float(DEPTH_DISTANCES + 0.5)).toConst()
}

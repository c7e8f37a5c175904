import { Fn, float, step, vec3, vec4 } from 'three/tsl'
import { noisePeriods } from '../../layers/layerUniforms'
import { cellOf, digitsOf, hashCell, wrapped } from '../../noise/tsl/cellHash'
import { layout, loop, type Float, type Variable, type Vec2, type Vec3 } from '../../tsl-types'
import { stormPlaces } from '../stormForm'
import { inLattice, type LayerNodes } from './layer'

// The search for the nearest storm, which is long: samples near each other share one.

/** Square of the distance from a storm's axis, of which a point is `gap` away [cells²]. */
export const squareFrom = (gap: Vec3, up: Vec3): Float => {
  const height = gap.dot(up).toConst() as Float
  const square = height.mul(height).toConst() as Float
  const aside = square.mul(square).mul(square).mul(stormPlaces.away)
  return gap.dot(gap).sub(square).add(aside).max(0)
}

/**
 * Displacement to the nearest storm. Twin of its length: `stormDistance` in test/twins/storm.ts
 *
 * @param p - Place in the lattice, in its periods.
 * @param up - Zenith in the lattice, unit length.
 * @returns To a point of its axis, in the lattice [cells]
 */
export const stormGap = /*#__PURE__*/ Fn(
  ([p, up]: [Vec3, Vec3]) => {
    const { cells, seed, jitter } = stormPlaces
    const count = vec3(cells)
    const { base, part, origin, index } = cellOf(p, count, float(seed))
    // The eight nearest cells: towards the nearer neighbour along each axis.
    const side = step(vec3(0.5), part).mul(2).sub(1).toConst()
    const stride = wrapped(base.add(side), count).sub(origin).toConst()
    const nearest = vec4(0, 0, 0, 99).toVar()
    loop('stormCell', 8, corner => {
      const digits = digitsOf(corner, 2).toConst()
      const place = hashCell(index.add(stride.mul(digits)))
        .mul(jitter)
        .add((1 - jitter) / 2)
      const gap = side.mul(vec3(digits)).add(place).sub(part).toConst()
      const square = squareFrom(gap, up).toConst()
      nearest.assign(square.lessThan(nearest.w).select(vec4(gap, square), nearest))
    })
    return nearest.xyz
  },
  layout('welkinStormGap', 'vec3', { p: 'vec3', up: 'vec3' })
) as unknown as (p: Vec3, up: Vec3) => Vec3

/** Place in the lattice of storms, in its periods, of a displaced look-up. */
export const placeOf = (layer: LayerNodes, subpoint: Vec3, bent: Vec2): Vec3 =>
  layer
    .fieldLattice(subpoint)
    .add(inLattice(bent).mul(layer.perWeatherPeriod.div(noisePeriods.fields)))
    .toConst()

/** The storm nearest to a place, kept for places nearby. */
export interface StormNearby {
  /** The place in the lattice, in its periods. */
  readonly place: Vec3
  /** Displacement from there to a point of the storm's axis, in the lattice [cells]. */
  readonly gap: Vec3
}

/** Variables that hold it. */
export type KeptStorm = { readonly [Key in keyof StormNearby]: Variable<Vec3> }

/**
 * The storm nearest to a place, without turbulence.
 *
 * @param subpoint - As of `cloudWeather`.
 * @param up - Zenith there, in the mapped space.
 * @param shift - `shift` of `WeatherBackground` [m].
 */
export function stormNearby(layer: LayerNodes, subpoint: Vec3, up: Vec3, shift: Vec2): StormNearby {
  const place = placeOf(layer, subpoint, shift)
  const gap = stormGap(place, layer.directionInFields(up).toConst()).toConst() as Vec3
  return { place, gap }
}

import { float, int, vec2, vec4 } from 'three/tsl'
import { layerAt } from '../../../packages/clouds/src/density/tsl/layer'
import * as pairs from '../../../packages/clouds/src/density/tsl/samplePair'
import * as sampler from '../../../packages/clouds/src/density/tsl/sampler'
import type { CloudField } from '../../../packages/clouds/src/density/CloudField'
import type { Float, Vec3 } from '../../../packages/clouds/src/tsl-types'

// The clouds' sampler as pages of tests have it instead of the library's (`replaceModules.ts` puts it there):
// the library's own, but for fields whose extinction a test gives in place of all weather and noise.

export * from '../../../packages/clouds/src/density/tsl/samplePair'
export * from '../../../packages/clouds/src/density/tsl/sampler'

/** Extinction at a displacement from the camera, in the mapped space [1/m]. */
export type GivenExtinction = (offset: Vec3) => Float

/**
 * Likely distance to cloud in the clear air of a given field [m], of which nothing more is known: steps are
 * `CAUTION` of it, about a cell of simulated ones.
 */
const CLEAR_OF_GIVEN = 100

const _given = new WeakMap<CloudField, GivenExtinction>()

/** Puts an extinction in the place of a field's weather and noise, for shaders that are built from now on. */
export function giveExtinction(field: CloudField, extinction: GivenExtinction): void {
  _given.set(field, extinction)
}

export const weatherCacheAt: typeof sampler.weatherCacheAt = (field, ...rest) =>
  _given.has(field)
    ? { background: vec4(0), layer: int(0) }
    : sampler.weatherCacheAt(field, ...rest)

export const extinctionNearby: typeof sampler.extinctionNearby = (field, cache, sample) =>
  _given.get(field)?.(sample.offset) ?? sampler.extinctionNearby(field, cache, sample)

export const sampleLayerPair: typeof sampler.sampleLayerPair = (field, layer, middle, samples) => {
  const given = _given.get(field)
  if (given === undefined) return sampler.sampleLayerPair(field, layer, middle, samples)
  const [first, second] = samples.map(({ offset }) => given(offset))
  return vec2(first, second).toConst()
}

export const samplePair: typeof pairs.samplePair = (field, ...rest) => {
  const given = _given.get(field)
  if (given === undefined) return pairs.samplePair(field, ...rest)
  const [, , middle, length, direction] = rest
  const [first, second] = [-0.5, 0.5].map(at =>
    given(middle.offset.add(direction.mul(length.mul(at))).toConst() as Vec3)
  )
  return {
    extinction: vec2(first, second).toConst(),
    likelyDistance: first.max(second).greaterThan(0).select(float(0), CLEAR_OF_GIVEN),
    greatest: layerAt(field, int(0)).density
  }
}

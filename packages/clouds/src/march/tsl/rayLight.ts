import { If, float, vec2, vec3, vec4 } from 'three/tsl'
import type { CloudField } from '../../density/CloudField'
import type { CloudSample } from '../../density/tsl/sample'
import type { Float, Vec2, Vec3, Vec4 } from '../../tsl-types'
import { LEAST_TRANSMITTANCE, shade } from '../../light/tsl/lighting'

// The light of a ray, summed from the camera outwards.

/**
 * Part of a ray's light over which the light at one sample may stand for its successors. Greater: bands
 * along the edges of shadows on clouds (*Storm*); smaller: more light marches, which take most of the time.
 */
const SHARED_LIGHT = 0.05

/** What a ray has met so far. */
export type RayLight = ReturnType<typeof rayLight>

/** A ray that has met nothing yet. */
export const rayLight = () => ({
  /** Spectral radiance for unit irradiance of the bare sun [1/sr]. */
  radiance: vec4(0).toVar(),
  transmittance: float(1).toVar(),
  /** Part of the ray's light since the source was last computed; at first, it never was. */
  sinceLit: float(1).toVar(),
  /** Source of light at the latest lit sample: `CloudShares`. */
  source: vec3(0).toVar(),
  /** Light from the layers between two boundaries, not yet shaded: shares, and distance by opacity. */
  passing: vec4(0).toVar(),
  /** Opacity of the same. */
  passingSeen: float(0).toVar(),
  /** Distance by opacity, of what is shaded [m]. */
  weightedDistance: float(0).toVar()
})

/**
 * Shades what the ray has met since the last layer boundary. Layers apart may be lit apart: a high one is
 * in the sun when a low one is not.
 *
 * @param sampleAt - The ray's sample at a distance.
 */
export function shadePassing(
  field: CloudField,
  { radiance, passing, passingSeen, weightedDistance }: RayLight,
  sampleAt: (distance: Float) => CloudSample
): void {
  If(passingSeen.greaterThan(0), () => {
    const sample = sampleAt(passing.w.div(passingSeen))
    radiance.addAssign(shade(field, sample, passing.xyz))
    weightedDistance.addAssign(passing.w)
    passing.assign(vec4(0))
    passingSeen.assign(0)
  })
}

/** What is seen of two steps, as if their samples were all of them. */
export interface SeenPair {
  /** Transmittance of each step. */
  readonly through: Vec2
  /** Part of the ray's light that each takes. */
  readonly seen: Vec2
  /** Sum of these. */
  readonly both: Float
}

/**
 * What is seen of two steps, as if each one's sample were all of it: L += T S (1 − e^{−τ}) conserves
 * energy for steps of any length.
 *
 * @param depth - Scaled optical depths of both steps.
 * @see Hillaire 2016, "Physically based sky, atmosphere and cloud rendering in Frostbite" §5.6.3
 */
export function seenOf({ transmittance }: RayLight, depth: Vec2): SeenPair {
  const through = depth.negate().exp().toConst() as Vec2
  const seen = vec2(
    transmittance.mul(through.x.oneMinus()),
    transmittance.mul(through.x).mul(through.y.oneMinus())
  ).toConst() as Vec2
  return { through, seen, both: seen.x.add(seen.y).toConst() }
}

/**
 * Adds the light of two steps.
 *
 * @param places - Distances of their samples [m].
 * @param sourceAt - Source of light at a distance, as shares: called where the last one is too old.
 */
export function addPair(
  { transmittance, sinceLit, source, passing, passingSeen }: RayLight,
  { through, seen, both }: SeenPair,
  places: readonly Float[],
  sourceAt: (distance: Float) => Vec3
): void {
  const weighted = places[0].mul(seen.x).add(places[1].mul(seen.y)).toConst()
  sinceLit.addAssign(both)
  If(sinceLit.greaterThan(SHARED_LIGHT), () => {
    source.assign(sourceAt(weighted.div(both)))
    sinceLit.assign(0)
  })
  passing.addAssign(vec4(source.mul(both), weighted))
  passingSeen.addAssign(both)
  transmittance.mulAssign(through.x.mul(through.y))
}

/** Light, transmittance and mean distance of a ray that is done. */
export interface SeenClouds {
  /** Spectral radiance at the clouds for unit irradiance of the bare sun [1/sr]. */
  radiance: Vec4
  /** Of the light behind, in [0, 1]. */
  transmittance: Float
  /** Mean distance of what is seen, by what each place contributes; of the first layer if nothing is [m]. */
  distance: Float
}

/**
 * What a ray has met, when it is done. What is as good as opaque is opaque: nothing bright may shine
 * through.
 *
 * @param nothing - Distance where it met nothing [m].
 */
export function seenClouds(
  { radiance, transmittance, weightedDistance }: RayLight,
  nothing: Float
): SeenClouds {
  const opacity = transmittance.oneMinus().toConst()
  const passed = transmittance
    .sub(LEAST_TRANSMITTANCE)
    .max(0)
    .div(1 - LEAST_TRANSMITTANCE)
    .toConst() as Float
  return {
    radiance: radiance.mul(passed.oneMinus().div(opacity.max(1e-6))).toConst(),
    transmittance: passed,
    distance: opacity
      .greaterThan(1e-4)
      .select(weightedDistance.div(opacity.max(1e-6)), nothing)
      .toConst()
  }
}

import { float, int, mix, smoothstep, vec4 } from 'three/tsl'
import { select } from '../../select'
import { hasStorms } from '../../density/kinds'
import { footprintOf, type CloudSample } from '../../density/tsl/sample'
import { extinctionsNearby } from '../../density/tsl/sampler'
import { sampleShadows } from '../../shadow/tsl/sampleShadows'
import { loop, type Float, type Int, type Vec3, type Vec4 } from '../../tsl-types'
import { LOWEST_COSINE } from './cloudLight'
import type { ShadedSample, ShadingContext, ShadingLight } from './shadingContext'

/**
 * Distance towards the light that is probed sample by sample: per distance from the camera, at least and
 * at most [m]. Shorter: billows lose the shading of their own bumps; longer: few samples miss them (*Cumulus*).
 */
const PROBED_GROWTH = 0.02
const LEAST_PROBED = 60
const MOST_PROBED = 600

/**
 * Most of that in tall clouds, over their layer's thickness: where no shadow map is, clouds go on beyond as at the last probe. 0: anvils are
 * dark from orbit, as if they went on up to their layer's top.
 */
const MOST_OF_TALL = 0.12

/**
 * Low light stays among clouds for longer: cosines between which it counts as low, the distance probed then
 * [m], and how many steps more. Less: clouds glow through each other at sunset (*Cirrus*).
 */
const LOW_LIGHT = 0.35
const LOWEST_LIGHT = 0.12
const LOW_LIGHT_PROBED = 700
const LOW_LIGHT_STEPS = 2

/** Fewest steps towards the light, from afar [–]. 1: clouds darken suddenly as one leaves (*World clouds*). */
const FEWEST_STEPS = 2

/**
 * Distance at which the cloud above and below is probed, as a part of the way to its top and to its base. Greater: towers count
 * as shallow, too bright from the sky (*Storm*).
 */
const PROBED_PART = 0.35
/** Mean extinction up to the top or the base: parts of that near the place, and of that at the probe. */
const MEAN = [PROBED_PART / 2, 0.5] as const

/**
 * Most of an isolated cloud above or below a place that counts for light of sky and ground: the rest is open to its sides [m].
 * Greater: shaded sides of towers are flat, as if cut out of paper (*Storm*).
 */
const MOST_REACH = 700

/**
 * Widest isolated clouds, over their layer's thickness: low light crosses no more of one where no shadow map is [–].
 * Greater: far clouds are dark at sunset (*World clouds*).
 */
const WIDEST = 1.5

/**
 * Mean extinction below a place of an isolated cloud, as a part of that near the place, if nothing is probed; twice as much in decks. Faces lean
 * over air: 0.35 is what single clouds of a large-eddy simulation have.
 */
const LIKELY_BELOW = 0.35

/** Probes whose texture reads do not wait for each other, in skies that are known to have no storms: the code of these is long. 3: slower. */
const TOGETHER = 2

/** Optical depths around a sample, not delta-scaled. */
export interface LocalDepths {
  /** Depth from the sample to the light. */
  toLight: Float
  /** Optical depth of all clouds on the ray of light through the sample. */
  through: Float
  above: Float
  below: Float
  /** Depth below that is likely of itself, without a probe: `lateralLeakFit` was found with it. */
  likelyBelow: Float
  /** Mean extinction on that ray, from end to end of its clouds, over the layers'; above 1 where there is no map. */
  filled: Float
}

/**
 * Optical depths around a sample: a few steps near it, which see what is smaller than the shadow map's
 * texels, and the map beyond. Where there is no map, the cloud is taken to be as dense as it is near.
 */
export function localDepths(
  { field, shadows, quality }: ShadingContext,
  { sample, weather, layers: { base, top, layered, density } }: ShadedSample,
  { direction: toLight, isMapped, cosine: cosLight }: ShadingLight
): LocalDepths {
  const [rise, fall] = [top.sub(sample.altitude), sample.altitude.sub(base)].map(length =>
    length.max(1).toConst()
  )
  const [above, below] = [rise, fall].map(length =>
    mix(length.min(MOST_REACH), length, layered).toConst()
  )
  const slant = cosLight.abs().max(LOWEST_COSINE).reciprocal().toConst()
  const toTop = select(cosLight.greaterThan(0), rise, fall).mul(slant).toConst() as Float
  const lowness = smoothstep(-LOW_LIGHT, -LOWEST_LIGHT, cosLight.abs().negate()).toConst() as Float
  const ofTall = top.sub(base).mul(MOST_OF_TALL).toConst() as Float
  const probed = sample.distance
    .mul(PROBED_GROWTH)
    .clamp(LEAST_PROBED, ofTall.max(MOST_PROBED))
    .max(lowness.mul(LOW_LIGHT_PROBED))
    .min(toTop)
    .toConst() as Float
  /** Extinction near the sample, optical depth towards the light, extinction above and below. */
  const found = vec4(0).toVar() as Vec4
  /** Extinction at the last probe towards the light. */
  const last = float(0).toVar() as Float & { addAssign: (n: Float) => void }
  const asked = float(quality.lightSteps).add(lowness.mul(LOW_LIGHT_STEPS).ceil())
  // Steps shorter than a pixel see nothing more.
  const seen = probed.div(footprintOf(field, sample).max(1e-3)).ceil().max(FEWEST_STEPS)
  const count = asked.min(seen).toInt().toConst() as Int
  // Decks have no undersides but their own.
  const isIsolated = layered.lessThan(1)
  const probes = count.add(select(isIsolated, int(2), int(1))).toConst() as Int
  const together = hasStorms(field) === false ? TOGETHER : 1
  const placeOf = (index: Int): { place: CloudSample; add: (extinction: Float) => void } => {
    const isAside = index.greaterThanEqual(count).toConst()
    const isAbove = index.equal(count).toConst()
    // Steps grow from the sample on: (i/n)² of the way.
    const from = float(index).div(float(count)).toConst() as Float
    const to = float(index).add(1).div(float(count)).toConst() as Float
    const [start, end] = [from.mul(from).mul(probed), to.mul(to).mul(probed)]
    const height = select(isAbove, above, below.negate()).mul(PROBED_PART)
    const step = toLight.mul(start.add(end).mul(0.5))
    const offset = sample.offset
      .add(select(isAside, sample.up.mul(height), step) as Vec3)
      .toConst() as Vec3
    const { altitude, up } = field.view.localCoordinates(offset)
    const add = (extinction: Float): void => {
      const isFirst = index.equal(int(0))
      const along = vec4(select(isFirst, extinction, 0), extinction.mul(end.sub(start)), 0, 0)
      const aside = select(isAbove, vec4(0, 0, extinction, 0), vec4(0, 0, 0, extinction))
      const own = select(isAside, aside, along)
      found.addAssign(select(index.lessThan(probes), own, vec4(0)))
      last.addAssign(select(index.equal(count.sub(int(1))), extinction, 0))
    }
    return { place: { offset, altitude, up, distance: sample.distance }, add }
  }
  // The density function is inlined for few places at once, whatever their direction: shaders stay short.
  loop('probes', probes.add(int(together - 1)).div(int(together)), turn => {
    const places = Array.from({ length: together }, (_, i) =>
      placeOf(turn.mul(int(together)).add(int(i)).toConst() as Int)
    )
    const samples = places.map(({ place }) => place)
    extinctionsNearby(field, weather, samples).forEach((extinction, i) => {
      places[i].add(extinction.toConst())
    })
  })
  const beyond = sample.offset.add(toLight.mul(probed)).toConst() as Vec3
  const { toLight: far, through: all, stretch, inMap } = sampleShadows(shadows, beyond)
  const unmapped = inMap.mul(isMapped).oneMinus().toConst() as Float
  // Where no map is: as near, thinning out towards the top; tall clouds as at the last probe.
  const mean = found.y.div(probed).toConst()
  const farther = select(ofTall.greaterThan(MOST_PROBED), last, mean)
  const widest = top.sub(base).mul(WIDEST).div(layered.oneMinus().max(1e-3))
  const guess = farther.mul(toTop.min(widest).sub(probed).max(0)).toConst()
  const depthToLight = found.y.add(far.mul(isMapped)).add(guess.mul(unmapped)).toConst() as Float
  const behind = select(cosLight.greaterThan(0), fall, rise).mul(slant).mul(mean)
  const through = all
    .mul(isMapped)
    .add(depthToLight.add(behind).mul(unmapped))
    .max(depthToLight)
    .toConst() as Float
  const near = found.x.mul(MEAN[0]).toConst()
  const likelyBelow = below.mul(found.x).mul(layered.add(1).mul(LIKELY_BELOW)).toConst() as Float
  const probedBelow = below.mul(found.w.mul(MEAN[1]).add(near))
  return {
    toLight: depthToLight,
    through,
    above: above.mul(found.z.mul(MEAN[1]).add(near)),
    below: mix(probedBelow, likelyBelow, layered),
    likelyBelow,
    filled: all.mul(all).div(stretch.mul(density).max(1e-6)).add(unmapped)
  }
}

import { float, int, mix, smoothstep, vec4 } from 'three/tsl'
import { footprintOf } from '../../density/tsl/sample'
import { extinctionNearby } from '../../density/tsl/sampler'
import { sampleShadows } from '../../shadow/tsl/sampleShadows'
import { loop, type Float, type Int, type Vec3, type Vec4 } from '../../tsl-types'
import type { Chord } from './lateralLeak'
import type { ShadedSample, ShadingContext, ShadingLight } from './shadingContext'

/** Cosine of the lowest light whose rays grow longer with its height. */
const LOWEST_COSINE = 0.12

/**
 * Distance towards the light that is probed sample by sample: per distance from the camera, at least and
 * at most [m]. Shorter: billows lose the shading of their own bumps; longer: few samples miss them (*Cumulus*).
 */
const PROBED_GROWTH = 0.02
const LEAST_PROBED = 60
const MOST_PROBED = 600

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
 * Distances at which the cloud above and below is probed, as parts of the way to the layer's top and base, and their
 * width, as a part of the layer's thickness. Narrower: probes meet holes and bumps that tell nothing of the cloud. The chord
 * of the lateral leak, decks and unresolved clouds have a sharp probe above, at `SHARP_ABOVE`.
 */
const VERTICAL = 0.15
const VERTICAL_WIDTH = 0.09
const SHARP_ABOVE = 0.35

/**
 * Mean extinction of an isolated cloud to its layer's top or base: parts of that near the place and of the probed one; and
 * of a deck. Tops lie below their layer's, bases at it. From single clouds of a large-eddy simulation, as is the weight of the shadow map's depths, which grows with the light's height.
 */
const ISOLATED_ABOVE = [0.03, 0.31] as const
const ISOLATED_BELOW = [0.03, 0.4] as const
const DECK_MEAN = [0.175, 0.5] as const
const DECK_BELOW = 0.7
const MAPPED = 0.8
const MAPPED_POWER = 3

/**
 * Widest isolated clouds, over their layer's thickness: low light crosses no more of one where no shadow map is [–].
 * Greater: far clouds are dark at sunset (*World clouds*).
 */
const WIDEST = 1.5

/** Optical depths around a sample, not delta-scaled. */
export interface LocalDepths {
  /** Depth from the sample to the light. */
  toLight: Float
  /** Optical depth of all clouds on the ray of light through the sample. */
  through: Float
  /** Depths to the top and to the base, which share the light of sky and ground. */
  above: Float
  below: Float
  /** Chord of the cloud along the vertical: deeper in isolated clouds, as `lateralLeakFit` knows it. */
  chord: Chord
  /** 1 where clouds are resolved one by one, 0 where not. */
  resolved: Float
}

/**
 * Optical depths around a sample: a few steps near it, which see what is smaller than the shadow map's
 * texels, and the map beyond. Where there is no map, the cloud is taken to be as dense as it is near.
 */
export function localDepths(
  { field, shadows, quality }: ShadingContext,
  { sample, weather, layers: { base, top, layered } }: ShadedSample,
  { direction: toLight, isMapped, cosine: cosLight }: ShadingLight
): LocalDepths {
  const rise = top.sub(sample.altitude).max(1).toConst()
  const fall = sample.altitude.sub(base).max(1).toConst()
  const slant = cosLight.abs().max(LOWEST_COSINE).reciprocal().toConst()
  const toTop = cosLight.greaterThan(0).select(rise, fall).mul(slant).toConst() as Float
  const lowness = smoothstep(-LOW_LIGHT, -LOWEST_LIGHT, cosLight.abs().negate()).toConst() as Float
  const probed = sample.distance
    .mul(PROBED_GROWTH)
    .clamp(LEAST_PROBED, MOST_PROBED)
    .max(lowness.mul(LOW_LIGHT_PROBED))
    .min(toTop)
    .toConst() as Float
  /** Extinction near the sample, optical depth towards the light, extinction above and below. */
  const found = vec4(0).toVar() as Vec4
  const sharpAbove = float(0).toVar() as Float
  // Clouds are about as wide as their layer is thick.
  const resolved = footprintOf(field, sample)
    .div(top.sub(base).max(1))
    .oneMinus()
    .clamp()
    .toConst() as Float
  // What is narrower than that is left out, as from afar.
  const width = rise.add(fall).mul(VERTICAL_WIDTH)
  const afar = sample.distance.max(width.div(field.pixelAngle.max(1e-6))).toConst() as Float
  const asked = float(quality.lightSteps).add(lowness.mul(LOW_LIGHT_STEPS).ceil())
  // Steps shorter than a pixel see nothing more.
  const seen = probed.div(footprintOf(field, sample).max(1e-3)).ceil().max(FEWEST_STEPS)
  const count = asked.min(seen).toInt().toConst() as Int
  // The density function is inlined once for all directions: shaders stay short.
  loop('probe', count.add(int(3)), index => {
    const isAside = index.greaterThanEqual(count).toConst()
    const isSharp = index.equal(count).toConst()
    const isAbove = index.equal(count.add(int(1))).toConst()
    // Steps grow from the sample on: (i/n)² of the way.
    const from = float(index).div(float(count)).toConst() as Float
    const to = float(index).add(1).div(float(count)).toConst() as Float
    const [start, end] = [from.mul(from).mul(probed), to.mul(to).mul(probed)]
    const wide = isAbove.select(rise, fall.negate()).mul(VERTICAL)
    const height = isSharp.select(rise.mul(SHARP_ABOVE), wide)
    const step = toLight.mul(start.add(end).mul(0.5))
    const offset = sample.offset.add(isAside.select(sample.up.mul(height), step)).toConst() as Vec3
    const { altitude, up } = field.view.localCoordinates(offset)
    const distance = isAside.and(isSharp.not()).select(afar, sample.distance).toConst() as Float
    const extinction = extinctionNearby(field, weather, { offset, altitude, up, distance })
    const isFirst = index.equal(int(0))
    const along = vec4(isFirst.select(extinction, 0), extinction.mul(end.sub(start)), 0, 0)
    const aside = isAbove.select(vec4(0, 0, extinction, 0), vec4(0, 0, 0, extinction))
    sharpAbove.addAssign(isSharp.select(extinction, 0))
    found.addAssign(isAside.select(isSharp.select(vec4(0), aside), along))
  })
  const beyond = sample.offset.add(toLight.mul(probed)).toConst() as Vec3
  const far = sampleShadows(shadows, beyond)
  const unmapped = far.inMap.mul(isMapped).oneMinus().toConst() as Float
  // Where no map is: as near, thinning out towards the top.
  const density = found.y.div(probed).toConst()
  const widest = top.sub(base).mul(WIDEST).div(layered.oneMinus().max(1e-3))
  const guess = density.mul(toTop.min(widest).sub(probed).max(0)).toConst()
  const depthToLight = found.y
    .add(far.toLight.mul(isMapped))
    .add(guess.mul(unmapped))
    .toConst() as Float
  const behind = cosLight.greaterThan(0).select(fall, rise).mul(slant).mul(density)
  const through = far.through
    .mul(isMapped)
    .add(depthToLight.add(behind).mul(unmapped))
    .max(depthToLight)
    .toConst() as Float
  const deckAbove = rise.mul(found.x.mul(DECK_MEAN[0]).add(sharpAbove.mul(DECK_MEAN[1]))).toConst()
  const deckBelow = fall.mul(found.x).mul(DECK_BELOW).toConst() as Float
  const ownAbove = rise.mul(found.x.mul(ISOLATED_ABOVE[0]).add(found.z.mul(ISOLATED_ABOVE[1])))
  const ownBelow = fall.mul(found.x.mul(ISOLATED_BELOW[0]).add(found.w.mul(ISOLATED_BELOW[1])))
  // The shadow map knows the whole depths; the higher the light, the more are they the vertical's.
  const known = cosLight.abs().pow(MAPPED_POWER).mul(MAPPED).mul(unmapped.oneMinus()).toConst()
  const lit = depthToLight.mul(cosLight.abs()).toConst() as Float
  const shaded = through.sub(depthToLight).mul(cosLight.abs()).toConst() as Float
  const isHigh = cosLight.greaterThan(0)
  const chord = [deckAbove, deckBelow.mul(layered.add(1).div(2)).toConst() as Float] as const
  const own = layered.oneMinus().mul(resolved).toConst() as Float
  const combined = (deck: Float, guess: Float, mapped: Float): Float =>
    mix(deck, mapped.mul(known).add(guess).div(known.add(1)), own).toConst()
  return {
    resolved,
    toLight: depthToLight,
    through,
    above: combined(chord[0], ownAbove, isHigh.select(lit, shaded)),
    below: combined(chord[1], ownBelow, isHigh.select(shaded, lit)),
    chord
  }
}

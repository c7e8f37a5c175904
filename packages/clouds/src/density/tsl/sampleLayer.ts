import { If } from 'three/tsl'
import type { CloudField } from '../CloudField'
import type { Float, Vec2, Vec3 } from '../../tsl-types'
import { billows, detail, fineShare, MOST_DETAIL } from './billows'
import { densityOf, edgeAt } from './density'
import { bendAtHeight, billowStrength, densityAtHeight, neededStrength } from './heightForm'
import { heightIn, type LayerNodes } from './layer'
import { footprintOf, subpointOffset, type CloudSample } from './sample'
import { billowsLost, columnStrength } from './strength'
import { mixedDensity, unresolvedDensity, type Unresolved } from './unresolved'
import { cloudWeather, leanAt, type CloudWeather } from './weather'
import { unpackBackground, type PackedBackground } from './weatherBackground'

/** A layer at a place. */
export interface LayerSample {
  /** Extinction [1/m], at least 0. */
  readonly extinction: Float
  /**
   * Strength of the column with all its billows, less what the height needs: cloud is where it is above 0
   * [–]. Far away, where single clouds are not resolved, at least 0.
   */
  readonly strength: Float
}

/** Options of {@link sampleLayer}. */
export interface SampleOptions {
  /** Detail at the edges; without, clouds keep their size. */
  readonly detail: boolean
  /** Meaning of unresolved clouds; by default their mean. */
  readonly unresolved?: Unresolved
  /** Direction of the ray on which they are met, in the mapped space; left out, straight up. */
  readonly direction?: Vec3
}

/** A layer at a place, before detail. */
interface Body {
  readonly sample: CloudSample
  readonly height: Float
  readonly footprint: Float
  readonly weather: CloudWeather
  /** Strength with coarse billows, and with fine ones, too. */
  readonly body: Float
  readonly strength: Float
  /** Strength over which density rises. */
  readonly edge: Float
  /** Strength of detail, per deviation of its noise. */
  readonly detailStrength: Float
}

/** Weather → column → billows: two texture reads, of which the second waits for the first. */
function bodyAt(
  field: CloudField,
  layer: LayerNodes,
  packed: PackedBackground,
  sample: CloudSample
): Body {
  const height = heightIn(layer, sample.altitude).clamp(0, 1).toConst() as Float
  const background = unpackBackground(packed)
  const footprint = footprintOf(field, sample)
  const shape = billows(field, layer, sample.offset, background.shift, footprint)
  const subpoint = subpointOffset(field, sample).sub(leanAt(layer, sample.up, height))
  const bend = shape.curl.mul(layer.bend.mul(bendAtHeight(height))).toConst() as Vec2
  const weather = cloudWeather(
    field,
    layer,
    background,
    subpoint.toConst(),
    bend,
    footprint,
    'where unresolved'
  )
  const lost = billowsLost(shape.level)
  const amount = billowStrength(layer, height)
  const body = columnStrength(layer, weather, background.coverage, lost)
    .sub(neededStrength(layer, height))
    .add(shape.coarse.mul(amount.coarse))
    .toConst() as Float
  const share = fineShare(body)
  const strength = body.add(shape.fine.mul(amount.fine).mul(share)).toConst() as Float
  const detailStrength = amount.detail.mul(share).toConst() as Float
  const edge = edgeAt(layer, height)
  return { sample, height, footprint, weather, body, strength, edge, detailStrength }
}

/**
 * One layer at places near each other, in the weather on large scales around them: their texture reads do
 * not wait for each other.
 *
 * @param background - `weatherBackground` around all of them.
 * @param samples - Within the layer's altitudes, or else they are taken to be at its boundary.
 */
export function sampleLayerAt(
  field: CloudField,
  layer: LayerNodes,
  background: PackedBackground,
  samples: readonly CloudSample[],
  { detail: hasDetail, unresolved = 'mean', direction }: SampleOptions
): LayerSample[] {
  const bodies = samples.map(sample => bodyAt(field, layer, background, sample))
  const strengths = bodies.map(({ strength }) => strength.toVar() as Float)
  if (hasDetail) {
    bodies.forEach(({ sample, footprint, strength, edge, detailStrength }, i) => {
      const most = detailStrength.abs().mul(MOST_DETAIL).toConst() as Float
      const isAtEdge = strength
        .greaterThan(most.negate())
        .and(strength.lessThan(most.add(edge)))
        .and(most.greaterThan(0))
      If(isAtEdge, () => {
        const fine = detail(field, layer, sample.offset, footprint)
        strengths[i].addAssign(fine.mul(detailStrength))
      })
    })
  }
  return bodies.map(({ sample, height, weather, body, edge }, i) => {
    const near = densityOf(strengths[i], body, edge).mul(densityAtHeight(layer, height))
    const density = near.toVar() as Float
    const { unresolvedFraction, filteredCoverage } = weather
    If(unresolvedFraction.mul(filteredCoverage).greaterThan(0), () => {
      const cosine = direction?.dot(sample.up).toConst() as Float | undefined
      const mean = unresolvedDensity(field, layer, filteredCoverage, height, unresolved, cosine)
      density.assign(mixedDensity(mean.columnDepth, density, mean.density, unresolvedFraction))
      strengths[i].assign(strengths[i].max(0))
    })
    const extinction = layer.density.mul(density).toConst() as Float
    return { extinction, strength: strengths[i] }
  })
}

/** One layer at a place: see {@link sampleLayerAt}. */
export function sampleLayer(
  field: CloudField,
  layer: LayerNodes,
  background: PackedBackground,
  sample: CloudSample,
  options: SampleOptions
): LayerSample {
  return sampleLayerAt(field, layer, background, [sample], options)[0]
}

import { If, float } from 'three/tsl'
import { select } from '../../select'
import type { CloudField } from '../CloudField'
import { billowForm } from '../formConstants'
import type { Bool, Float, Vec3 } from '../../tsl-types'
import { billows, bulge, detail, fineShare, MOST_DETAIL, topBillows } from './billows'
import { crumbDensity, densityOf, edgeAt, surfaceStrength, type LayerSample } from './density'
import { bendAtHeight, billowStrength, densityAtHeight, neededStrength } from './heightForm'
import { heightIn, type LayerNodes } from './layer'
import { resolutionAt, type Resolution } from './resolution'
import { footprintOf, type CloudSample } from './sample'
import { ifStorm } from './storm'
import type { StormNearby } from './stormNearby'
import { stormStrength } from './stormStrength'
import { columnStrength } from './strength'
import { mixedDensity, unresolvedDensity, type Unresolved } from './unresolved'
import { cloudWeather, footOf, type CloudWeather } from './weather'
import {
  unpackBackground,
  type PackedBackground,
  type WeatherBackground
} from './weatherBackground'

/** Options of {@link sampleLayer}. */
export interface SampleOptions {
  /** Detail at the edges; without, clouds keep their size. */
  readonly detail: boolean
  /** Meaning of unresolved clouds; by default their mean. */
  readonly unresolved?: Unresolved
  /** Direction of the ray on which they are met, in the mapped space; left out, straight up. */
  readonly direction?: Vec3
  /** True for places that are not near each other: unresolved clouds are asked for at each. */
  readonly areApart?: boolean
  /** In layers of storms, the one nearest to the samples; left out, it is looked for. */
  readonly storm?: StormNearby
}

/** A layer at a place, before detail. */
interface Body {
  readonly height: Float
  readonly weather: CloudWeather
  /** Strength with all billows. */
  readonly strength: Float
  /** Strength of detail, per deviation of its noise [–]. */
  readonly detailStrength: Float
  /** Strength over which density rises at edges [–]. */
  readonly edge: Float
  /** Factor of the density: `crumbDensity`, or `StormStrength.density`. */
  readonly crumbs: Float
}

/** Weather → column → billows: two texture reads, of which the second waits for the first. */
function bodyAt(
  field: CloudField,
  layer: LayerNodes,
  background: WeatherBackground,
  sample: CloudSample,
  resolution: Resolution,
  nearby?: StormNearby
): Body {
  const height = heightIn(layer, sample.altitude).clamp().toConst() as Float
  const { shapeLevel } = resolution
  const shape = billows(field, layer, sample.offset, background.shift, shapeLevel)
  const weather = cloudWeather(
    field,
    layer,
    background,
    footOf(field, layer, sample, height),
    shape.curl.mul(layer.bend.mul(bendAtHeight(height))).toConst(),
    resolution,
    nearby
  )
  const [strength, detailStrength] = [0, 1].map(() => float(0).toVar() as Float)
  const edge = edgeAt(layer, height).toVar() as Float
  const crumbs = float(1).toVar() as Float
  ifStorm(
    layer,
    () => {
      const storm = stormStrength(field, layer, weather, shape, height, shapeLevel)
      strength.assign(storm.strength)
      detailStrength.assign(storm.detail)
      edge.assign(storm.edge)
      crumbs.assign(storm.density)
    },
    () => {
      const amount = billowStrength(layer, height)
      const column = columnStrength(layer, weather, background.coverage, resolution)
      const rough = topBillows(column)
      const needed = neededStrength(layer, height).toConst() as Float
      const coarse = shape.coarse.mul(amount.coarse).mul(rough).toConst() as Float
      const body = column
        .sub(needed)
        .add(bulge(coarse, column, needed))
        .toConst() as Float
      const share = fineShare(body)
      const fine = shape.fine.mul(amount.fine).mul(rough)
      strength.assign(body.add(fine.mul(share)))
      detailStrength.assign(amount.detail.mul(share))
      crumbs.assign(crumbDensity(column, needed))
    }
  )
  return { height, weather, strength, detailStrength, edge, crumbs }
}

/**
 * Strength of the clear air of a user's own clouds, of which nothing more is known [–]. Less: small clouds are missed
 * here and there, as grain (*Real or not*).
 */
const CLEAR_STRENGTH = -4

/**
 * One layer at places near each other, in the weather on large scales around them: their texture reads do
 * not wait for each other.
 *
 * @param background - `weatherBackground` around all of them.
 * @param middle - Between them: their level of detail is that of this place.
 * @param samples - Within the layer's altitudes, or else they are taken to be at its boundary.
 */
export function sampleLayerAt(
  field: CloudField,
  layer: LayerNodes,
  background: PackedBackground,
  middle: CloudSample,
  samples: readonly CloudSample[],
  { detail: hasDetail, unresolved = 'mean', areApart, direction, storm }: SampleOptions
): LayerSample[] {
  if (field.extinction)
    return samples.map(sample => {
      const extinction = field.extinction!(sample)
      const strength = select(extinction.greaterThan(0), 1, CLEAR_STRENGTH) as Float
      return { extinction, strength, surface: strength }
    })
  const weather = unpackBackground(background)
  const { billowFootprints = billowForm.footprints } = middle
  const resolution = resolutionAt(layer, footprintOf(field, middle), billowFootprints)
  const { footprint, unresolvedFraction } = resolution
  const bodies = samples.map(each => bodyAt(field, layer, weather, each, resolution, storm))
  const found = bodies.map(({ strength }) => ({
    density: float(0).toVar(),
    strength: strength.toVar()
  }))
  if (hasDetail) {
    const atEdge = bodies.map(({ strength, detailStrength, edge }): Bool => {
      const most = detailStrength.abs().mul(MOST_DETAIL).toConst()
      return strength.add(most).greaterThan(0).and(strength.sub(most).lessThan(edge)).toConst()
    })
    // Of all samples if one is at an edge: reads that wait for each other take longer than those too many.
    If(
      atEdge.reduce((any, each) => any.or(each)),
      () => {
        detail(field, layer, samples, footprint).forEach((fine, i) => {
          found[i].strength.addAssign(select(atEdge[i], fine.mul(bodies[i].detailStrength), 0))
        })
      }
    )
  }
  bodies.forEach(({ height, edge, crumbs }, i) => {
    const { density, strength } = found[i]
    If(strength.greaterThan(0), () => {
      const full = densityAtHeight(layer, height).mul(crumbs)
      density.assign(densityOf(strength, edge).mul(full))
    })
  })
  const mixUnresolved = (from: number, to: number, { altitude }: CloudSample): void => {
    const covered = bodies
      .slice(from, to)
      .map(({ weather: around }) => around.filteredCoverage())
      .reduce((sum, each) => sum.add(each))
      .div(to - from)
      .toConst()
    If(covered.greaterThan(0), () => {
      const height = heightIn(layer, altitude).clamp().toConst() as Float
      const cosine = direction?.dot(middle.up).toConst() as Float | undefined
      const mean = unresolvedDensity(field, layer, covered, height, unresolved, cosine)
      for (const { density, strength } of found.slice(from, to)) {
        density.assign(mixedDensity(mean.columnDepth, density, mean.density, unresolvedFraction))
        strength.assign(strength.max(0))
      }
    })
  }
  If(unresolvedFraction.greaterThan(0), () => {
    if (areApart) samples.forEach((sample, i) => mixUnresolved(i, i + 1, sample))
    else mixUnresolved(0, samples.length, middle)
  })
  return found.map(({ density, strength }, i) => ({
    extinction: layer.density.mul(density).toConst(),
    strength,
    surface: surfaceStrength(layer, strength, bodies[i].edge)
  }))
}

/** One layer at a place: see {@link sampleLayerAt}. */
export function sampleLayer(
  field: CloudField,
  layer: LayerNodes,
  background: PackedBackground,
  sample: CloudSample,
  options: SampleOptions
): LayerSample {
  return sampleLayerAt(field, layer, background, sample, [sample], options)[0]
}

import { MathUtils } from 'three'
import type { CloudLayerParameters } from './CloudLayer'
import {
  billowForm,
  columnForm,
  densityForm,
  heightForm,
  strengthForm
} from '../density/formConstants'
import { stormBillows, stormIce } from '../density/stormForm'
import { layerForms, layerPeriods, weatherScales } from './layerUniforms'
import { isStorm, stormBody, stormRadius } from './storms'

// Integrals over a layer's columns and heights in float64, for clouds that are not seen one by one. The
// functions of the height are those of density/tsl/heightForm.ts.

/** Means over a layer's cloudy columns, relative to the layer's greatest density. */
export interface MeanColumn {
  /** Density of an even column that lets as much light through as cloudy columns do in the mean [–]. */
  readonly columnDensity: number
  /** Density of an even column that lets as much diffuse light through as columns where all is covered [–]. */
  readonly fullDensity: number
  /** Mean density inside of clouds, straight up through the middle of strong columns [–]. */
  readonly insideDensity: number
  /** Mean over all heights of the share of cloudy columns that are seen there: `seenShare` [–]. */
  readonly profileMean: number
}

/** Strength that a column needs at a height: `neededStrength` of density/tsl/heightForm.ts. */
export function neededStrength(
  { profileExponent, baseRelief, anvil }: CloudLayerParameters,
  height: number
): number {
  const { top, inversion, inversionStrength } = heightForm
  const { tower, towerHeights, anvil: needed, anvilHeights, overshoot, relief } = heightForm
  const base = baseRelief > 0 ? relief * Math.max(1 - height / baseRelief, 0) ** 2 : 0
  const column =
    base +
    top * Math.max(height, 1e-4) ** profileExponent +
    inversionStrength * Math.max(height - inversion, 0) ** 2
  const end = Math.max(height - anvilHeights[0], 0) / (1 - anvilHeights[0])
  const spread =
    (tower * (1 - MathUtils.smoothstep(height, ...towerHeights)) + needed) *
      Math.min(8 * height, 1) +
    overshoot * end ** 2
  return column + anvil * (spread - column)
}

/** Extinction at a height over the layer's greatest: `densityAtHeight` of density/tsl/heightForm.ts. */
export function densityAtHeight(
  { densityGrowth, anvil }: CloudLayerParameters,
  height: number
): number {
  const { grown, iceDensity } = heightForm
  const ice = iceAt(anvil, height)
  return MathUtils.clamp(height / grown, 1e-4, 1) ** densityGrowth * (1 + ice * (iceDensity - 1))
}

/** Share of ice at a height of a layer with a share of anvils: `iceAt` of density/tsl/heightForm.ts. */
export const iceAt = (anvil: number, height: number): number =>
  anvil * MathUtils.smoothstep(height, ...heightForm.iceHeights)

/** Share of ice in a storm at a distance from a tower's axis [m]. */
export const iceAround = (
  { anvil }: CloudLayerParameters,
  height: number,
  towerDistance: number,
  radius: number
): number =>
  iceAt(anvil, height) *
  MathUtils.smoothstep(towerDistance / Math.max(radius, 1), ...stormIce.aside)

/** Factor of a storm's billows in a share of ice. */
export const stormRoughness = ({ shapeAmount }: CloudLayerParameters, ice: number): number =>
  shapeAmount * MathUtils.lerp(1, stormBillows.inIce, ice)

/** Density of a storm over what its layer has at a height [–]: see density/tsl/stormStrength.ts. Lengths [m]. */
export function stormDensity(
  { anvil }: CloudLayerParameters,
  height: number,
  ice: number,
  distance: number,
  radius: number,
  towerDistance = distance
): number {
  const { rim, end, least, streaming } = stormIce
  const [fromAxis, fromTower] = [distance, towerDistance].map(each => each / Math.max(radius, 1))
  const width = rim * MathUtils.clamp(fromTower, ...streaming)
  const inside = MathUtils.clamp((end - fromAxis) / width, least, 1)
  const { iceDensity } = heightForm
  return (
    MathUtils.lerp(1, inside ** 2 * iceDensity, ice) /
    MathUtils.lerp(1, iceDensity, iceAt(anvil, height))
  )
}

/** Factor of coarse billows in clear air of a strength [–]. */
export const stormNearness = (strength: number): number =>
  MathUtils.clamp(1 + strength / stormBillows.reach, 0, 1)

/** Strength over which density rises at a storm's edges in a share of ice [–]. */
export const stormEdge = (layer: CloudLayerParameters, ice: number): number =>
  layerForms(layer).edge * (1 + stormBillows.softIce * ice)

/** Strength of a storm without billows [–]: `smoothStormStrength` of density/tsl/stormStrength.ts. Lengths [m]. */
export const smoothStormStrength = (
  layer: CloudLayerParameters,
  distance: number,
  radius: number,
  height: number,
  towerDistance = distance
): number =>
  stormBody(layer, distance, radius, height, towerDistance) /
    (stormBillows.unit * layerPeriods(layer).shape) -
  stormBillows.offset * layer.shapeAmount

/** Strength over which density rises at edges at a height [–]: `edgeAt` of density/tsl/density.ts. */
export const edgeAt = (layer: CloudLayerParameters, height: number): number =>
  layerForms(layer).edge * (1 + densityForm.softerBase * (1 - height) ** 2)

/** Density of a strength over the layer's at that height: `densityOf` of density/tsl/density.ts. */
export const densityOf = (edge: number, strength: number): number =>
  MathUtils.clamp(strength / edge, 0, 1)

/** Factor of the billows of a column of a strength: `topBillows` of density/tsl/billows.ts. */
export const topBillows = (column: number): number =>
  1 + (billowForm.atTops - 1) * MathUtils.smoothstep(column, ...billowForm.middle)

/** Strength that coarse billows add to a column: `bulge` of density/tsl/billows.ts. */
export function bulge(billow: number, column: number, needed: number): number {
  const { bulgeFrom, bulgeAbove } = billowForm
  const lacking = 1 - MathUtils.smoothstep(column - needed, ...bulgeFrom)
  const share = 1 - lacking * MathUtils.smoothstep(needed, ...bulgeAbove)
  return Math.max(billow, 0) * share + Math.min(billow, 0)
}

/** Factor of the density of bits that only billows make: `crumbDensity` of density/tsl/density.ts. */
export function crumbDensity(column: number, needed: number): number {
  const { crumb, crumbFrom, crumbHeight } = densityForm
  return crumb + (1 - crumb) * MathUtils.smoothstep(column - crumbHeight * needed, ...crumbFrom)
}

/** Share of cloudy columns that are seen at a height from afar: `seenShare` of density/tsl/unresolved.ts. */
export function seenShare(layer: CloudLayerParameters, height: number): number {
  const { tops, hiddenBelow, hiddenByAnvil, leastSeen } = columnForm
  const hidden = hiddenBelow + layer.anvil * (hiddenByAnvil - hiddenBelow)
  const reached = 1 - neededStrength(layer, height) / strengthForm.strongest
  return MathUtils.clamp(tops * reached, 0, 1) * MathUtils.clamp(height / hidden, leastSeen, 1)
}

/** Numbers of heights and of columns that means are taken over. */
const HEIGHTS = 24
const COLUMNS = 8
/** Deviations of the billows, and their weights: three-point Gauss–Hermite. */
const BILLOWS = [
  [-Math.sqrt(3), 1 / 6],
  [0, 2 / 3],
  [Math.sqrt(3), 1 / 6]
] as const

/** Light that comes through a column, by its scaled optical depth, and the inverse. */
interface Passing {
  readonly through: (depth: number) => number
  readonly depthOf: (through: number) => number
}

/** Direct light: past the clouds, it falls through gaps. */
const direct: Passing = {
  through: depth => Math.exp(-depth),
  depthOf: through => -Math.log(Math.max(through, 1e-30))
}

/** Diffuse light, by `eddingtonDiffuse` of environment/cpu/decks.ts for droplets: a closed deck lets nothing else through. */
const DIFFUSION = 0.5
const diffuse: Passing = {
  through: depth => 1 / (1 + DIFFUSION * depth),
  depthOf: through => (1 / through - 1) / DIFFUSION
}

/**
 * Strength of the i-th of a layer's columns at a height, without billows, and one deviation of coarse ones; strength over which density
 * rises at edges, and a factor of that [–].
 */
type Strengths = (
  i: number,
  height: number
) => { column: number; needed: number; rough: number; edge: number; crumbs: number }

/** Columns of a layer whose strength is as frequent at any value of a range of `strongest`. */
function strengthsOf(layer: CloudLayerParameters, coverage: number): Strengths {
  const { strongest, offset, coverageOffset, fullCoverageExcess } = strengthForm
  const { shapeAmount } = layer
  const least =
    shapeAmount * (offset + coverageOffset * coverage) + fullCoverageExcess * coverage ** 32
  return (i, height) => {
    const column = least + ((i + 0.5) / COLUMNS) * strongest
    const rough = shapeAmount * billowForm.coarse * topBillows(column)
    const needed = neededStrength(layer, height)
    const crumbs = crumbDensity(column, needed)
    return { column, needed, rough, edge: edgeAt(layer, height), crumbs }
  }
}

/** Columns of a storm, where the weather on large scales is as in the mean: rings of the same area. */
function strengthsOfStorm(layer: CloudLayerParameters, coverage: number): Strengths {
  const { weatherWeights, openCells } = layer
  const [, , weight] = weatherScales(weatherWeights, false, openCells).clouds
  const radius = stormRadius(layer, 0, coverage, weight)
  return (i, height) => {
    const distance = radius * Math.sqrt(1 - (i + 0.5) / COLUMNS)
    const column = smoothStormStrength(layer, distance, radius, height)
    const ice = iceAround(layer, height, distance, radius)
    const rough = stormRoughness(layer, ice) * stormNearness(column) * stormBillows.coarse
    const crumbs = stormDensity(layer, height, ice, distance, radius)
    return { column, needed: 0, rough, edge: stormEdge(layer, ice), crumbs }
  }
}

/** Density of an even column for a coverage, and the mean density of the strongest columns [–]. */
function columnAt(
  layer: CloudLayerParameters,
  coverage: number,
  depth: number,
  passing: Passing
): { density: number; inside: number } {
  const strengths = (isStorm(layer) ? strengthsOfStorm : strengthsOf)(layer, coverage)
  let through = 0
  let inside = 0
  for (let i = 0; i < COLUMNS; i++) {
    const mean = meanOverHeights(height => {
      const { column, needed, rough, edge, crumbs } = strengths(i, height)
      const here = BILLOWS.reduce((part, [deviation, weight]) => {
        const strength = column - needed + bulge(rough * deviation, column, needed)
        return part + weight * densityOf(edge, strength) * crumbs
      }, 0)
      return here * densityAtHeight(layer, height)
    })
    through += passing.through(depth * mean) / COLUMNS
    inside = Math.max(inside, mean)
  }
  return { density: passing.depthOf(through) / depth, inside }
}

/** Mean of a function over the heights of a layer. */
function meanOverHeights(value: (height: number) => number): number {
  let sum = 0
  for (let i = 0; i < HEIGHTS; i++) sum += value((i + 0.5) / HEIGHTS)
  return sum / HEIGHTS
}

/**
 * Means over a layer's columns.
 *
 * @param depthScale - Scaled optical depth over optical depth, by which light comes through [–].
 */
export function meanColumn(layer: CloudLayerParameters, depthScale = 1): MeanColumn {
  const { baseAltitude, topAltitude, coverage, density } = layer
  const depth = Math.max(density * (topAltitude - baseAltitude) * depthScale, 1e-4)
  const column = columnAt(layer, coverage, depth, direct)
  return {
    columnDensity: column.density,
    fullDensity: columnAt(layer, 1, depth, diffuse).density,
    insideDensity: column.inside * (isStorm(layer) ? columnForm.insideStorms : 1),
    profileMean: Math.max(
      meanOverHeights(height => seenShare(layer, height)),
      1e-3
    )
  }
}

const _columns = new WeakMap<CloudLayerParameters, { depthScale: number; column: MeanColumn }>()

/** {@link meanColumn} of parameters that do not change any more, computed once. */
export function meanColumnOf(layer: CloudLayerParameters, depthScale: number): MeanColumn {
  const cached = _columns.get(layer)
  if (cached?.depthScale === depthScale) return cached.column
  const column = meanColumn(layer, depthScale)
  _columns.set(layer, { depthScale, column })
  return column
}

/** Density of a cloudy column, over the layer's [–]: `columnDensityAt` of density/tsl/unresolved.ts. */
export const columnDensityAt = (
  { columnDensity, fullDensity }: MeanColumn,
  coverage: number
): number => columnDensity + coverage ** 32 * (fullDensity - columnDensity)

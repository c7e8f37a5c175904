import type { CloudLayerParameters } from '@welkin/clouds'
import type { ArgTypes } from '@storybook/html-vite'

/** A layer's parameters, each a control of its own. Units are those of `CloudLayerParameters`. */
export interface LayerArgs {
  baseAltitude: number
  topAltitude: number
  coverage: number
  density: number
  profileExponent: number
  baseRelief: number
  shapeAmount: number
  detailAmount: number
  weatherScale: number
  shapeScale: number
  detailScale: number
  edgeSoftness: number
  turbulence: number
  shear: number
  anvil: number
  openCells: number
  densityGrowth: number
  /** Weights of the weather's channels. */
  cumulus: number
  stratocumulus: number
  cumulonimbus: number
  cirrus: number
  windEast: number
  windNorth: number
  shadow: boolean
}

/** Thinnest layer that controls make [m]. */
const THINNEST = 50

export function layerArgs(parameters: CloudLayerParameters): LayerArgs {
  const { weatherWeights, wind, precipitation: _, ...rest } = parameters
  const [cumulus, stratocumulus, cumulonimbus, cirrus] = weatherWeights
  return {
    ...rest,
    cumulus,
    stratocumulus,
    cumulonimbus,
    cirrus,
    windEast: wind.east,
    windNorth: wind.north
  }
}

/** The other way round. A layer upside down becomes a thin one at its base. */
export function layerParameters(args: LayerArgs): Omit<CloudLayerParameters, 'precipitation'> {
  const { baseAltitude, topAltitude, coverage, density, profileExponent, baseRelief } = args
  const { shapeAmount, detailAmount, weatherScale, shapeScale, detailScale } = args
  const { edgeSoftness, turbulence, shear, anvil, openCells, densityGrowth, shadow } = args
  return {
    baseAltitude,
    topAltitude: Math.max(topAltitude, baseAltitude + THINNEST),
    coverage,
    density,
    profileExponent,
    baseRelief,
    shapeAmount,
    detailAmount,
    weatherScale,
    shapeScale,
    detailScale,
    edgeSoftness,
    turbulence,
    shear,
    anvil,
    openCells,
    densityGrowth,
    shadow,
    weatherWeights: [args.cumulus, args.stratocumulus, args.cumulonimbus, args.cirrus],
    wind: { east: args.windEast, north: args.windNorth }
  }
}

const category = 'Layer'

const range = (name: string, min: number, max: number, step: number, description = '') => ({
  name,
  description,
  control: { type: 'range', min, max, step } as const,
  table: { category }
})

const weather = (name: string) =>
  range(`Weather: ${name}`, 0, 1, 0.05, 'Weight of this channel of the weather')

export const layerArgTypes: ArgTypes<LayerArgs> = {
  baseAltitude: range('Base [m]', 0, 12_000, 50, 'Above the ellipsoid'),
  topAltitude: range('Top [m]', 50, 14_000, 50, 'Above the ellipsoid'),
  coverage: range('Coverage', 0, 1, 0.01, 'Share of the sky that is covered'),
  density: range('Density [1/m]', 0, 0.2, 0.0005, 'Extinction of the densest cloud'),
  densityGrowth: range('Density growth', 0, 4, 0.05, 'Growth of the extinction with height'),
  profileExponent: range(
    'Profile exponent',
    0.1,
    4,
    0.01,
    'Small: tops at all heights; great: nearly all at one height'
  ),
  baseRelief: range('Base relief', 0, 1, 0.01, 'Bases of weak columns are higher'),
  shapeAmount: range('Shape', 0, 1, 0.01, 'Billows: bulges that meet in creases'),
  detailAmount: range('Detail', 0, 1, 0.01, 'What is finer than the billows'),
  weatherScale: range('Weather scale', 0.1, 10, 0.05, 'Size and distance of single clouds'),
  shapeScale: range('Shape scale', 0.1, 10, 0.05, 'Size of billows'),
  detailScale: range('Detail scale', 0.1, 10, 0.05, 'Size of detail'),
  edgeSoftness: range('Edge softness', 0, 1, 0.01, '0 is crisp, 1 fades out as cirrus does'),
  turbulence: range('Turbulence', 0, 2, 0.01, 'Bends columns and drags their edges along'),
  shear: range('Shear [m/m]', -5, 5, 0.05, 'Displacement downwind per height above the base'),
  anvil: range('Anvil', 0, 1, 0.01, 'Share of an anvil below the top'),
  openCells: range('Open cells', 0, 1, 0.01, 'Share of cells with clear middles, in stratocumulus'),
  cumulus: weather('cumulus'),
  stratocumulus: weather('stratocumulus'),
  cumulonimbus: weather('cumulonimbus'),
  cirrus: weather('cirrus'),
  windEast: range('Wind to the east [m/s]', -60, 60, 1),
  windNorth: range('Wind to the north [m/s]', -60, 60, 1),
  shadow: {
    name: 'Shadow',
    description: 'Whether the layer casts shadows',
    control: 'boolean',
    table: { category }
  }
}

import type { CloudLayerParameters } from './CloudLayer'
import { named } from '../check'
import { checkCount, CloudLayers } from './CloudLayers'

type Layers = readonly Partial<CloudLayerParameters>[]

const cumulus: Partial<CloudLayerParameters> = {
  topAltitude: 2000,
  coverage: 0.3,
  wind: { east: 7, north: 2 }
}

const altocumulus: Partial<CloudLayerParameters> = {
  baseAltitude: 3600,
  topAltitude: 4000,
  coverage: 0.5,
  density: 0.03,
  profileExponent: 1.5,
  shapeAmount: 0.6,
  edgeSoftness: 0.4,
  weatherScale: 0.35,
  shapeScale: 0.7,
  turbulence: 0.4,
  weatherWeights: [0, 1, 0, 0],
  wind: { east: 16, north: -3 }
}

const congestus: Partial<CloudLayerParameters> = {
  baseAltitude: 800,
  topAltitude: 4300,
  coverage: 0.25,
  profileExponent: 1,
  shapeAmount: 0.75,
  turbulence: 0.5,
  weatherScale: 1.2,
  shapeScale: 0.8,
  wind: { east: 9, north: 3 }
}

const storm: Partial<CloudLayerParameters> = {
  baseAltitude: 800,
  topAltitude: 11_000,
  coverage: 0.25,
  density: 0.08,
  turbulence: 0.8,
  shear: 0.2,
  anvil: 1,
  weatherWeights: [0, 0, 1, 0],
  wind: { east: 12, north: 3 }
}

/** Rain and hail of a storm with an anvil, without their rate. */
const hail = { share: 0.4, freezingLevel: 3000, hail: 0.4 }

const smallCumulus: Partial<CloudLayerParameters> = {
  ...cumulus,
  baseAltitude: 800,
  topAltitude: 1900,
  coverage: 0.25
}

/** A closed deck, even from below. */
const deck: Partial<CloudLayerParameters> = {
  baseAltitude: 600,
  topAltitude: 1500,
  coverage: 1,
  density: 0.02,
  profileExponent: 0.7,
  shapeAmount: 0.7,
  edgeSoftness: 0.4,
  weatherWeights: [0, 1, 0, 0],
  wind: { east: 10, north: 5 }
}

/** Fog from sea level up, through which one sees 150 m. */
const fog: Partial<CloudLayerParameters> = {
  ...deck,
  baseAltitude: 0,
  topAltitude: 400,
  profileExponent: 4
}

const cirrus: Partial<CloudLayerParameters> = {
  baseAltitude: 8500,
  topAltitude: 9600,
  coverage: 0.5,
  density: 0.003,
  profileExponent: 1,
  detailAmount: 0.5,
  edgeSoftness: 0.8,
  weatherScale: 0.5,
  turbulence: 1.5,
  shear: 2,
  densityGrowth: 0,
  weatherWeights: [0, 0, 0, 1],
  wind: { east: 28, north: -8 },
  shadow: false
}

/** Names of {@link cloudPreset}. */
export type CloudPresetName =
  | 'fairWeather'
  | 'congestus'
  | 'stratocumulus'
  | 'overcast'
  | 'cumulonimbus'
  | 'altocumulus'
  | 'cirrus'
  | 'mixed'
  | 'shower'
  | 'nimbostratus'
  | 'snowShower'
  | 'hailstorm'
  | 'fog'

const presets: Readonly<Record<CloudPresetName, Layers>> = {
  fairWeather: [cumulus],
  congestus: [congestus],
  stratocumulus: [
    {
      baseAltitude: 800,
      topAltitude: 1300,
      coverage: 0.8,
      density: 0.07,
      profileExponent: 1.5,
      edgeSoftness: 0.25,
      weatherWeights: [0, 1, 0, 0],
      wind: { east: 9, north: 4 }
    }
  ],
  overcast: [{ ...deck, density: 0.025, baseRelief: 0.5, edgeSoftness: 0.2 }],
  cumulonimbus: [{ ...storm, precipitation: { rate: 0, ...hail } }, smallCumulus],
  altocumulus: [altocumulus],
  cirrus: [cirrus],
  mixed: [
    { ...cumulus, coverage: 0.25 },
    { ...altocumulus, coverage: 0.35 },
    { ...cirrus, coverage: 0.4 }
  ],
  shower: [
    {
      ...storm,
      baseAltitude: 1000,
      topAltitude: 7000,
      weatherScale: 0.5,
      anvil: 0.4,
      precipitation: { rate: 12, streaks: 1.8 }
    },
    cumulus
  ],
  nimbostratus: [
    { ...deck, topAltitude: 3500, precipitation: { rate: 3, share: 0.6, streaks: 1.8 } }
  ],
  snowShower: [
    {
      ...congestus,
      profileExponent: 0.7,
      weatherScale: 0.6,
      shapeScale: 0.5,
      shapeAmount: 1,
      turbulence: 1,
      precipitation: { rate: 1.5, share: 0.6, freezingLevel: 0 }
    }
  ],
  hailstorm: [{ ...storm, precipitation: { rate: 30, ...hail } }, smallCumulus],
  fog: [fog]
}

/** All names of {@link cloudPreset}, for menus. */
export const cloudPresetNames = /*#__PURE__*/ Object.keys(presets) as readonly CloudPresetName[]

/**
 * Layers for a well-known sky, to be changed as one likes.
 *
 * - `fairWeather`: scattered cumulus
 * - `congestus`: towering cumulus, up to 4 km
 * - `stratocumulus`: a deck with gaps
 * - `overcast`: a closed grey sky, with relief and brighter thin places
 * - `cumulonimbus`: storms up to 11 km, with tower and anvil, among small cumulus
 * - `altocumulus`: small regular cells at 4 km
 * - `cirrus`: thin, fibrous, high
 * - `mixed`: cumulus, altocumulus and cirrus above each other
 * - `shower`: towers up to 7 km with rain of 12 mm/h, among small cumulus
 * - `nimbostratus`: a thick closed deck with rain of 3 mm/h
 * - `snowShower`: towering cumulus in cold air, with snow of 1.5 mm/h of water
 * - `hailstorm`: `cumulonimbus` with rain of 30 mm/h, and shafts of hail in its midst
 * - `fog`: from sea level up to 400 m, through which one sees 150 m; `layers.at(0).set({ baseAltitude, topAltitude })` puts it elsewhere
 *
 * Those with rain, snow and hail need `clouds` with a `precipitation`. `cumulonimbus` is dry until its first layer has a rate, and then has hail, too:
 * `layers.at(0).precipitation = { rate: 30 }`.
 *
 * @param count - Least number of layers, to take other presets by `copy` later.
 * @throws If there is no preset of this name, or the count is none.
 */
export function cloudPreset(name: CloudPresetName, count = 1): CloudLayers {
  checkCount('cloudPreset', count)
  return new CloudLayers(named('cloudPreset', 'name', presets, name), count)
}

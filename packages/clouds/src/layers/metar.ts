import { checkRange } from '@welkin/atmosphere'
import { checkBoolean, checkOptions, fail } from '@welkin/geo'
import type { CloudLayerParameters, CloudWind } from './CloudLayer'
import { checkCount, CloudLayers } from './CloudLayers'
import type { CloudPrecipitation } from './precipitation'
import { cloudPreset, type CloudPresetName } from './presets'

/** Options of {@link cloudLayersFromMETAR}. */
export interface METAROptions {
  /** Elevation of the aerodrome above the ellipsoid, in [−500, 9000] [m]; default 0. */
  readonly stationElevation?: number
  /** Least number of layers, to `copy` other reports later; default 1. */
  readonly count?: number
  /** True for layers from which falls what is reported, for clouds with a `precipitation`; default false. */
  readonly precipitation?: boolean
}

type Parameters = Partial<CloudLayerParameters>

const WHERE = 'cloudLayersFromMETAR'

/** Beginning of trends and remarks, where the report proper ends. */
const LATER = /\s(?:RMK|TEMPO|BECMG|INTER|FM\d{4,6}|PROB\d\d)\b/

/** Mark of a report: its time, or one of the words for a sky without clouds. */
const TELLING = /^(?:\d{6}Z|SKC|CLR|NSC|NCD|CAVOK)$/

const WIND =
  /^(?:(\d{3})P?(\d{2,3})|(?:VRB|\d{3}|\/{3})P?(?:\d{2,3}|\/\/))(?:G(?:P?\d{2,3}|\/\/))?(KT|MPS)$/
const CLOUD = /^(FEW|SCT|BKN|OVC|VV|\/{3})([0-5]\d\d|\/{3})(CB|TCU|\/{3})?$/

/** Present weather that falls: intensity, descriptors, kinds. Drifting and blowing snow (DRSN, BLSN) lies already. */
const FALLING = /^([-+]?)(?:SH|TS|FZ)*((?:DZ|RA|SN|SG|PL|GR|GS|UP)+)$/

/** Temperature and dew point [°C]. */
const TEMPERATURE = /^(M?)(\d\d)\/(?:M?\d\d|\/\/)?$/

/**
 * Rates of light, moderate and heavy drizzle, snow and rain [mm/h of water]: middles of the ranges of WMO-No. 8, vol. I, annex 1.B.
 */
const rates = { drizzle: [0.07, 0.3, 0.7], snow: [0.5, 2, 6], rain: [1.2, 5, 20] } as const

/** Fall of temperature with height in the standard atmosphere [°C/m]. */
const LAPSE = 0.0065

/** Depth of air above 0 °C through which what is reported as rain has fallen, at least [m]. */
const MELTED = 300

/** A group of which something is known. */
const KNOWN = /[^/]/

// Groups that were meant as wind or clouds; SCTE and VNKT are aerodromes, and NIL is no report.
const LIKE_WIND = /^(?:VRB|[\d/]).*(?:KT|MPS)$/
const LIKE_CLOUD = /^(?:FEW|SCT|BKN|OVC|VV)(?![A-Z]+$)|^NIL$/

/** One knot [m/s]. */
const KNOT = 1852 / 3600

/** Middles of the ranges of eighths that words stand for; of an unknown amount, SCT's. */
const eighths: Readonly<Record<string, number>> = { FEW: 1.5, BKN: 6, OVC: 8, VV: 8 }
const eighthsOf = ([, amount]: Group): number => eighths[amount] ?? 3.5

/** A hundred feet [m]. */
const HUNDRED_FEET = 30.48

/** Base and vertical visibility where the report has none [hundreds of feet]. */
const UNKNOWN_BASE = 30
const UNKNOWN_VISIBILITY = 3

/** Heights above the station at which medium and high clouds begin: WMO's étages of temperate regions [m]. */
const MEDIUM = 2000
const HIGH = 6000

/** Thickness of towering cumulus [m]. */
const TOWERING = 3500

/** Height of a cumulonimbus' top, and its least thickness [m]. */
const STORM_TOP = 11_000
const STORM_THICKNESS = 6000

/** Thickness of fog whose top one does not see, at most [m]. */
const DEEPEST_FOG = 900

/** Least thickness of other clouds [m]. */
const LEAST_THICKNESS = 200

/** Optical depth along what is just visible, for the least contrast of 0.05: WMO's visual range. */
const VISUAL_DEPTH = 3

/** A cloud group: amount, base, kind. */
type Group = readonly [text: string, amount: string, base: string, kind?: string]

const isTall = ([, , , kind]: Group): boolean => kind === 'CB' || kind === 'TCU'

const preset = (name: CloudPresetName, index = 0): CloudLayerParameters =>
  cloudPreset(name).at(index).parameters

/** Fog from the ground on, even, in which one sees a distance up [m]. */
const fog = (visibility: number): Parameters => ({
  ...preset('fog'),
  topAltitude: DEEPEST_FOG,
  density: VISUAL_DEPTH / Math.max(visibility, HUNDRED_FEET),
  profileExponent: 8,
  densityGrowth: 0,
  shapeAmount: 0.2
})

/** Well-known layer for a cloud at a height above the station [m]. */
function layerOfKind(group: Group, height: number): Parameters {
  if (isTall(group)) return preset(group[3] === 'CB' ? 'cumulonimbus' : 'congestus')
  if (height >= HIGH) return preset('cirrus')
  const isMedium = height >= MEDIUM
  const altocumulus = preset('altocumulus')
  const { density, wind } = altocumulus
  const amount = eighthsOf(group)
  if (amount === 8) return { ...preset('overcast'), ...(isMedium && { density, wind }) }
  if (isMedium) return altocumulus
  return preset(amount === 6 ? 'stratocumulus' : 'fairWeather')
}

function layerOf(
  group: Group,
  elevation: number,
  wind: CloudWind | undefined,
  precipitation: CloudPrecipitation | null
): Parameters {
  const [, amount, base, kind] = group
  const isFog = amount === 'VV'
  const unknown = isFog ? UNKNOWN_VISIBILITY : UNKNOWN_BASE
  /** Height of the base above the station; in fog, how far one sees up. */
  const height = HUNDRED_FEET * (base === '///' ? unknown : Number(base))
  const isLow = height < MEDIUM
  const layer = isFog ? fog(height) : layerOfKind(group, height)
  const { baseAltitude: from = 0, topAltitude: to = 0 } = layer
  const baseAltitude = Math.max(elevation + (isFog ? 0 : height), 0)
  // Clouds that begin low are shallow.
  let thickness = isLow ? Math.min(Math.max(height, LEAST_THICKNESS), to - from) : to - from
  if (kind === 'TCU') thickness = TOWERING
  if (kind === 'CB') thickness = Math.max(STORM_TOP - baseAltitude, STORM_THICKNESS)
  return {
    ...layer,
    ...(isLow && wind && { wind }),
    coverage: eighthsOf(group) / 8,
    baseAltitude,
    topAltitude: Math.min(baseAltitude + thickness, 30_000),
    precipitation
  }
}

/**
 * Layers of the clouds in an aerodrome's routine report (METAR or SPECI, ICAO's or the USA's).
 *
 * ```ts
 * const report = 'EDDM 221150Z 24008KT 9999 FEW018 SCT035TCU BKN080 10/04 Q1015'
 * const layers = cloudLayersFromMETAR(report, { stationElevation: 453 })
 * ```
 *
 * A layer per group, in the report's order. Amounts are the middle of their eighths (FEW 1–2, SCT 3–4,
 * BKN 5–7, OVC 8), bases hundreds of feet above the station, tops guesses: reports have none. Below 2 km
 * clouds are cumulus, from BKN on stratocumulus, and an overcast; below 6 km altocumulus or altostratus,
 * above that cirrus. TCU are 3.5 km tall, CB reach 11 km. `VV002` is fog, so thick that one sees 200 ft up.
 *
 * With `precipitation: true`, what falls (`-RA`, `SHRA`, `+TSRA`, `SN`, `DZ`) falls from CB, or else TCU, or else the layer that covers most, at the middle of the rates that
 * its intensity stands for, with hail for `GR` and `GS`; the temperature says how high the freezing level is. Mist and fog (`BR`, `FG`) have no layer but `VV`'s: {@link visibilityFromMETAR} has what is seen through them. Under `VV` alone what falls has the fog's layer, and no shaft is seen: its rate is for
 * `rainfall` and `snowfall`. Unknown precipitation (`UP`) is snow in frost, else rain.
 *
 * The wind moves clouds below 2 km. Where it is variable, or its direction or speed unknown (`///05KT`), and above, they have their preset's.
 * An unknown base (`///`) is 3000 ft, an unknown amount SCT; a group of which nothing is known is left out.
 * Without clouds (`SKC`, `CLR`, `NSC`, `NCD`, `CAVOK`), one layer covers nothing. Of more groups than
 * `CloudLayers.maxLayers`, those that cover least are left out, CB and TCU last. Trends (`TEMPO`, `BECMG`, `FM`) and
 * remarks (`RMK`) are not read.
 *
 * @param report - The whole report, or its cloud groups.
 * @throws Error when it is no report, or a group of wind or clouds is malformed; the message has the group.
 * @see WMO-No. 306, Manual on Codes, FM 15; FMH-1, Surface Weather Observations and Reports, §12
 */
export function cloudLayersFromMETAR(report: string, options: METAROptions = {}): CloudLayers {
  checkOptions(WHERE, options, 'stationElevation', 'count', 'precipitation')
  const { stationElevation = 0, count = 1, precipitation = false } = options
  checkBoolean(WHERE, 'precipitation', precipitation)
  checkCount(WHERE, count)
  checkRange(WHERE, 'stationElevation', stationElevation, -500, 9000)
  if (typeof report !== 'string') fail(WHERE, 'report must be a string', report)
  const groups: Group[] = []
  let isReport = false
  let wind: CloudWind | undefined
  let falling: RegExpExecArray | null = null
  let temperature: number | undefined
  for (const text of report
    .toUpperCase()
    .split(LATER)[0]
    .split(/[\s=$]+/)) {
    const group = CLOUD.exec(text) as Group | null
    if (group && KNOWN.test(text)) groups.push(group)
    if (!group && LIKE_CLOUD.test(text)) fail(WHERE, "clouds must be like 'SCT035TCU'", text)
    falling ??= FALLING.exec(text)
    const [, sign, degrees] = TEMPERATURE.exec(text) ?? []
    if (degrees !== undefined) temperature = Number(degrees) * (sign ? -1 : 1)
    if (LIKE_WIND.test(text)) wind = windOf(text)
    isReport ||= group !== null || TELLING.test(text)
  }
  if (!isReport) fail(WHERE, 'report must be a METAR', report)
  const rank = (group: Group): number => eighthsOf(group) + (isTall(group) ? 8 : 0)
  const ranked = groups.toSorted((a, b) => rank(b) - rank(a))
  const [source] = ranked.toSorted((a, b) => kindRank(b) - kindRank(a))
  const falls =
    falling && precipitation ? precipitationOf(falling, temperature, stationElevation) : null
  const layers = groups
    .filter(group => ranked.indexOf(group) < CloudLayers.maxLayers)
    .map(group => layerOf(group, stationElevation, wind, group === source ? falls : null))
  return new CloudLayers(layers, Math.max(count, 1))
}

/** Clouds that rain rather than others: storms, and towers. */
const kindRank = ([, , , kind]: Group): number => (kind === 'CB' ? 2 : kind === 'TCU' ? 1 : 0)

/**
 * Precipitation by a group such as `+SHRA`.
 *
 * @param temperature - At the station [°C]; undefined if it is not known.
 * @param elevation - Altitude of the station [m].
 */
function precipitationOf(
  [text, intensity, kinds]: readonly string[],
  temperature: number | undefined,
  elevation: number
): CloudPrecipitation {
  const each = kinds.match(/../g)!
  // What a station cannot tell (UP) is snow in frost, unless it freezes where it falls.
  const isFrozen = (temperature ?? 1) <= 0 && !text.includes('FZ')
  const isSnow =
    each.some(kind => /SN|SG/.test(kind) || (kind === 'UP' && isFrozen)) && !each.includes('RA')
  const isDrizzle = kinds === 'DZ'
  const rate = (isSnow ? rates.snow : isDrizzle ? rates.drizzle : rates.rain)[
    ['-', '', '+'].indexOf(intensity)
  ]
  const freezing = elevation + (temperature ?? 15) / LAPSE
  const freezingLevel = isSnow
    ? Math.min(freezing, elevation)
    : Math.max(freezing, elevation + MELTED)
  return {
    rate,
    share: /SH|TS/.test(text) ? 0.5 : 0.9,
    freezingLevel: Math.max(freezingLevel, -1000),
    hail: /GR|GS/.test(kinds) ? 0.3 : 0
  }
}

/** Middle of what `0000` stands for, less than 50 m [m]. */
const LEAST_VISIBILITY = 25

const VISIBILITY = /^(?:CAVOK|(\d{4})(?:NDV)?|([PM]?)(?:(\d+)|(?:(\d+) )?(\d)\/(\d+))SM)$/

/**
 * Prevailing visibility in an aerodrome's report [m]: 10,000 for `9999` and `CAVOK`, 25 for `0000`, which is less than 50; null where it is not
 * known. Mist (`BR`) has 1 to 5 km, fog (`FG`) less than 1 km: `heightFog({ density: 3 / (visibility ?? 10_000) })` shows them.
 *
 * @param report - The whole report.
 * @throws Error when it is no string.
 * @see WMO-No. 306, Manual on Codes, FM 15, 15.6
 */
export function visibilityFromMETAR(report: string): number | null {
  if (typeof report !== 'string') fail('visibilityFromMETAR', 'report must be a string', report)
  const [proper] = report.toUpperCase().split(LATER)
  // Miles may be two groups: 1 1/2SM.
  const texts = proper.replace(/ (\d) (\d\/\d+SM)/, ' $1_$2').split(/[\s=$]+/)
  for (const text of texts) {
    const found = VISIBILITY.exec(text.replace('_', ' '))
    if (!found) continue
    const [all, metres, , miles, whole = 0, part, of] = found
    if (all === 'CAVOK' || metres === '9999') return 10_000
    const inMiles = miles === undefined ? Number(whole) + Number(part) / Number(of) : Number(miles)
    return Math.max(metres === undefined ? 1609.344 * inMiles : Number(metres), LEAST_VISIBILITY)
  }
  return null
}

/** Wind of a group such as `24008G18KT`, from 240°; undefined where it is variable or unknown. */
function windOf(text: string): CloudWind | undefined {
  const found = WIND.exec(text)
  const [, from, speed, unit] = found ?? []
  if (!found || Number(from) > 360) fail(WHERE, "wind must be like '24008KT'", text)
  if (from === undefined) return undefined
  const angle = (Number(from) * Math.PI) / 180
  const metres = -Number(speed) * (unit === 'KT' ? KNOT : 1)
  return { east: metres * Math.sin(angle), north: metres * Math.cos(angle) }
}

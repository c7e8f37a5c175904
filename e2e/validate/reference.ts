import { readFileSync } from 'node:fs'
import type { AtmosphereParametersInit, Spectrum } from '@welkin/atmosphere'

/** Values of the file's wavelengths, one to four. */
export type Values = number[]

interface Angles {
  h_km: number
  view_zenith_deg: number
  sun_zenith_deg: number
  rel_azimuth_deg: number
}

export interface SkySample extends Angles {
  L_total: Values
  L_total_stderr: Values
}

export interface SegmentSample extends Angles {
  distance_km: number
  inscatter: Values
  inscatter_stderr: Values
  transmittance: Values
}

export interface IrradianceSample {
  sun_zenith_deg: number
  direct: Values
  sky: Values
  sky_stderr: Values
}

/** A file like `reference/sky.json`: spectral values at up to four wavelengths. */
export interface SkyReference {
  parameters: AtmosphereParametersInit
  /** Number of values per ray in the file, of four. */
  channels: number
  /** Irradiance of the sun above the air, per channel [W/m²/nm]. */
  solarIrradiance: Values
  sky?: SkySample[]
  segments?: SegmentSample[]
  irradiance?: IrradianceSample[]
}

export interface ColorSample extends Angles {
  /** CIE 1931 [cd/m²]. */
  XYZ: [number, number, number]
}

export type Json = Record<string, unknown>

/** An input file, with errors that say where it is wrong. */
export class Reader {
  constructor(
    readonly file: string,
    readonly where = ''
  ) {}

  fail(what: string): never {
    throw new Error(`${this.file}: ${this.where === '' ? 'the file' : this.where} ${what}`)
  }

  at(key: string | number): Reader {
    const next = typeof key === 'number' ? `${this.where}[${key}]` : `${this.where}.${key}`
    return new Reader(this.file, next.replace(/^\./, ''))
  }

  object(value: unknown): Json {
    const isObject = typeof value === 'object' && value !== null && !Array.isArray(value)
    return isObject ? (value as Json) : this.fail(`must be an object, got ${show(value)}`)
  }

  list(value: unknown): unknown[] {
    return Array.isArray(value) ? value : this.fail(`must be a list, got ${show(value)}`)
  }

  number(value: unknown): number {
    return typeof value === 'number' && Number.isFinite(value)
      ? value
      : this.fail(`must be a finite number, got ${show(value)}`)
  }

  numbers(value: unknown, count: number): number[] {
    const list = this.list(value)
    if (list.length !== count) this.fail(`must have ${count} numbers, got ${list.length}`)
    return list.map((item, i) => this.at(i).number(item))
  }

  /** The first number that a pattern finds in a text. */
  numbersInText(value: unknown, pattern: RegExp): number[] {
    const found = typeof value === 'string' ? pattern.exec(value) : null
    return found === null
      ? this.fail(`must read like ${pattern.source}, got ${show(value)}`)
      : found.slice(1).map(Number)
  }
}

function show(value: unknown): string {
  return value === undefined ? 'nothing' : JSON.stringify(value).slice(0, 60)
}

/** Reads a JSON file that holds an object. */
export function readJson(file: string): { reader: Reader; content: Json } {
  let text: string
  try {
    text = readFileSync(file, 'utf8')
  } catch (error) {
    throw new Error(`${file}: cannot be read (${(error as NodeJS.ErrnoException).code})`, {
      cause: error
    })
  }
  const reader = new Reader(file)
  try {
    return { reader, content: reader.object(JSON.parse(text)) }
  } catch (error) {
    if (error instanceof SyntaxError) {
      throw new Error(`${file}: is not JSON (${error.message})`, { cause: error })
    }
    throw error
  }
}

function angles(reader: Reader, item: Json): Angles {
  const angle = (key: keyof Angles, min: number, max: number): number => {
    const value = reader.at(key).number(item[key])
    if (value < min || value > max) reader.at(key).fail(`must be in [${min}, ${max}], got ${value}`)
    return value
  }
  return {
    h_km: angle('h_km', 0, 1e7),
    view_zenith_deg: angle('view_zenith_deg', 0, 180),
    sun_zenith_deg: angle('sun_zenith_deg', 0, 180),
    rel_azimuth_deg: angle('rel_azimuth_deg', -360, 360)
  }
}

/** A number of {@link Spectrum}'s length: a single number for all, or the list, its last repeated. */
function spectrum(reader: Reader, value: unknown, channels: number, scale = 1): Spectrum {
  const values =
    typeof value === 'number' ? [reader.number(value)] : reader.numbers(value, channels)
  return [0, 1, 2, 3].map(
    i => scale * values[Math.min(i, values.length - 1)]
  ) as unknown as Spectrum
}

function readParameters(reader: Reader, p: Json, channels: number): AtmosphereParametersInit {
  const number = (key: string, scale = 1): number => scale * reader.at(key).number(p[key])
  const values = (key: string, scale = 1): Spectrum =>
    spectrum(reader.at(key), p[key], channels, scale)
  const [asymmetry] = reader.at('mie_phase').numbersInText(p.mie_phase, /g\s*=\s*(-?[\d.]+)/)
  const [peak, halfWidth] = reader
    .at('absorption_profile')
    .numbersInText(p.absorption_profile, /\|h-([\d.]+)\|\/([\d.]+)/)
  return {
    solarIrradiance: values('solar_irradiance'),
    sunAngularRadius: number('sun_angular_radius_rad'),
    bottomRadius: number('bottom_radius_km', 1e3),
    topRadius: number('top_radius_km', 1e3),
    rayleighScattering: values('rayleigh_scattering_per_km', 1e-3),
    rayleighScaleHeight: number('rayleigh_scale_height_km', 1e3),
    mieScattering: values('mie_scattering_per_km', 1e-3),
    mieExtinction: values('mie_extinction_per_km', 1e-3),
    mieScaleHeight: number('mie_scale_height_km', 1e3),
    mieAsymmetry: asymmetry,
    absorptionExtinction: values('absorption_extinction_per_km', 1e-3),
    absorptionAltitude: 1e3 * peak,
    absorptionHalfWidth: 1e3 * halfWidth,
    groundAlbedo: values('ground_albedo')
  }
}

/**
 * Reads a file of spectral radiances. Sections that it lacks stay undefined.
 *
 * @throws If it cannot be read, or is not of this schema; the message says where.
 */
export function readSkyReference(file: string): SkyReference {
  const { reader, content } = readJson(file)
  const meta = reader.at('meta').object(content.meta)
  const at = reader.at('meta').at('parameters')
  const raw = at.object(meta.parameters)
  const channels = at.at('solar_irradiance').list(raw.solar_irradiance).length
  if (channels < 1 || channels > 4) {
    at.at('solar_irradiance').fail(`must have 1 to 4 numbers, got ${channels}`)
  }
  const parameters = readParameters(at, raw, channels)
  const section = <T>(key: string, read: (reader: Reader, item: Json) => T): T[] | undefined => {
    if (content[key] === undefined) return undefined
    const list = reader.at(key).list(content[key])
    return list.map((item, i) => {
      const place = reader.at(key).at(i)
      return read(place, place.object(item))
    })
  }
  const values = (place: Reader, item: Json, key: string): Values =>
    place.at(key).numbers(item[key], channels)
  return {
    parameters,
    channels,
    solarIrradiance: parameters.solarIrradiance!.slice(0, channels),
    sky: section('sky', (place, item) => ({
      ...angles(place, item),
      L_total: values(place, item, 'L_total'),
      L_total_stderr: values(place, item, 'L_total_stderr')
    })),
    segments: section('aerial_perspective', (place, item) => ({
      ...angles(place, item),
      distance_km: place.at('distance_km').number(item.distance_km),
      inscatter: values(place, item, 'inscatter'),
      inscatter_stderr: values(place, item, 'inscatter_stderr'),
      transmittance: values(place, item, 'transmittance')
    })),
    irradiance: section('irradiance', (place, item) => ({
      sun_zenith_deg: place.at('sun_zenith_deg').number(item.sun_zenith_deg),
      direct: values(place, item, 'direct'),
      sky: values(place, item, 'sky'),
      sky_stderr: values(place, item, 'sky_stderr')
    }))
  }
}

/**
 * Reads a file of sky colours like `reference/spectral_sky.json`.
 *
 * @throws If it cannot be read, or is not of this schema; the message says where.
 */
export function readColorReference(file: string): ColorSample[] {
  const { reader, content } = readJson(file)
  return reader
    .at('sky')
    .list(content.sky)
    .map((value, i) => {
      const place = reader.at('sky').at(i)
      const item = place.object(value)
      const XYZ = place.at('XYZ').numbers(item.XYZ, 3) as [number, number, number]
      return Object.assign(angles(place, item), { XYZ })
    })
}

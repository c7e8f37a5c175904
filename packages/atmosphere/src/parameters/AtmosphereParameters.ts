import { checkEllipsoid, checkOptions, fail } from '@welkin/geo'
import type { Ellipsoid } from '@welkin/geo'
import { checkRange } from '../check'

/** Four numbers, one per wavelength, in the order of {@link AtmosphereParameters.wavelengths}. */
export type Spectrum = readonly [number, number, number, number]

/** Three rows (X, Y, Z) of four columns, one per wavelength. */
export type SpectralMatrix = readonly [Spectrum, Spectrum, Spectrum]

/** Layers of air, from the ground up: altitude where one begins, and its scale height [m]. */
export type ScaleHeightLayers = readonly (readonly [baseAltitude: number, scaleHeight: number])[]

/**
 * Composition of an atmosphere as plain numbers in SI units; spectra have four values.
 *
 * The density of molecules and aerosols falls off exponentially (that of molecules layer by layer, with
 * {@link AtmosphereParametersInit.rayleighLayers}); the absorber, ozone on Earth, has a tent-shaped
 * profile; the ground is Lambertian.
 */
export interface AtmosphereParametersFields {
  /** The four wavelengths [nm]. */
  wavelengths?: Spectrum
  /** Spectral irradiance of the sun above the air [W/m²/nm]. */
  solarIrradiance?: Spectrum
  /** Angular radius of the sun's disc, in (0, 0.2] [rad]. */
  sunAngularRadius?: number
  /** Limb darkening u of the sun, I(ρ) ∝ 1 − u (1 − √(1 − ρ²)), in [0, 1]. */
  limbDarkening?: Spectrum
  /** Planet's centre to the ground: radius of the sphere that the ellipsoid is mapped to [m]. */
  bottomRadius?: number
  /**
   * The planet's figure; null, the default, is WGS84 where `bottomRadius` is within 2 % of the Earth's,
   * else a sphere.
   */
  ellipsoid?: Ellipsoid | null
  /** Planet's centre to the top of the air [m]. */
  topRadius?: number
  /** Scattering by molecules at the ground [1/m]. */
  rayleighScattering?: Spectrum
  /** Scale height of molecules, in the lowest layer if there are more [m]. */
  rayleighScaleHeight?: number
  /**
   * Layers above the lowest with other scale heights of molecules: at most three, from the ground up; base
   * altitudes and scale heights in [1, 1e6] [m]. By default none.
   *
   * `standardEarthParameters()` has those of the U.S. Standard Atmosphere 1976.
   */
  rayleighLayers?: ScaleHeightLayers
  /** Scattering by aerosols at the ground, at most `mieExtinction` [1/m]. */
  mieScattering?: Spectrum
  /** Extinction (scattering and absorption) by aerosols at the ground [1/m]. */
  mieExtinction?: Spectrum
  /** Scale height of aerosols [m]. */
  mieScaleHeight?: number
  /** Asymmetry g of the aerosols' Cornette–Shanks phase function, in (−1, 1); one, or per wavelength. */
  mieAsymmetry?: number | Spectrum
  /** Absorption coefficient in the middle of the tent-shaped layer [1/m]. */
  absorptionExtinction?: Spectrum
  /** Altitude of that layer's middle [m]. */
  absorptionAltitude?: number
  /** Half width of that layer, over which density falls linearly to 0 above and below [m]. */
  absorptionHalfWidth?: number
  /** Albedo of the ground, in [0, 1]. */
  groundAlbedo?: Spectrum
  /**
   * Matrix from spectral radiance at the four wavelengths to CIE 1931 XYZ
   * [683⁻¹ cd/m² per W/m²/sr/nm].
   *
   * Fitted by `packages/atmosphere/scripts/fit-color.ts` to a solution at 35 wavelengths. Skies that
   * the fit has not seen: ΔE2000 mean 0.07, 95th percentile 0.19; `spectral_sky.json`: 0.09, 0.27.
   * Sunlight at zenith angles from 0° to 88°: chromaticity ΔE2000 ≤ 0.14, illuminance within 0.3 %;
   * above the air 132 klx.
   */
  spectralToXYZ?: SpectralMatrix
}

/** Fields of {@link AtmosphereParameters}, and two everyday numbers that stand for some of them. */
export interface AtmosphereParametersInit extends AtmosphereParametersFields {
  /**
   * The Earth's haziness as aerosol optical depth, in [1, 20]: 1 none, 2 the clear air of the default,
   * growing in proportion. In place of `mieScattering` and `mieExtinction`.
   */
  turbidity?: number
  /** The Earth's ozone, in [0, 1000], in place of `absorptionExtinction` [Dobson units]. */
  ozone?: number
}

type Fields = Required<AtmosphereParametersFields>

/** Rayleigh scattering of air at sea level times λ⁴ [µm⁴/m]. @see Bruneton 2017, demo/demo.cc `kRayleigh` */
const RAYLEIGH_COEFFICIENT = 1.24062e-6

/** Molecules in a column of one Dobson unit [1/m²]. */
const DOBSON_UNIT = 2.687e20

/** Cross-section of ozone at 440, 520, 560, 630 nm; 233 K, averaged over 10 nm [m²]. @see IUP Bremen */
const OZONE_CROSS_SECTION: Spectrum = [1.582e-26, 2.139e-25, 4.266e-25, 3.215e-25]

/** Extinction by the aerosols of clear air at the ground [1/m]: optical depth 5.328e-3 to the zenith. */
const CLEAR_AEROSOL_EXTINCTION = 5.328e-3 / 1200

const all = (value: number): Spectrum => [value, value, value, value]

/** Spectrum of a constant, or the spectrum itself. */
export const spectrumOf = (value: number | Spectrum): Spectrum =>
  typeof value === 'number' ? all(value) : value

const map = (values: Spectrum, f: (value: number) => number): Spectrum => [
  f(values[0]),
  f(values[1]),
  f(values[2]),
  f(values[3])
]

/** Wavelengths of the default's spectra [nm]. */
const EARTH_WAVELENGTHS: Spectrum = [440, 520, 560, 630]
/** Half of the altitudes that the ozone layer spans: a tent over the altitude [m]. */
const OZONE_HALF_WIDTH = 15_000

const earthOzone = (dobsonUnits: number): Spectrum =>
  map(OZONE_CROSS_SECTION, area => (area * dobsonUnits * DOBSON_UNIT) / OZONE_HALF_WIDTH)

/** Default of every field, the Earth's, and the range of its numbers. */
const FIELDS: {
  readonly [Name in keyof Fields]: readonly [earth: Fields[Name], least: number, most: number]
} = {
  wavelengths: [EARTH_WAVELENGTHS, 100, 3000],
  solarIrradiance: [[1.91198, 1.8685, 1.8341, 1.64654], 0, 1e4],
  sunAngularRadius: [0.004675, 1e-6, 0.2],
  limbDarkening: [[0.75, 0.65, 0.6, 0.52], 0, 1],
  bottomRadius: [6_378_137, 1e3, 1e9],
  ellipsoid: [null, 0, 0],
  topRadius: [6_378_137 + 60_000, 1e3, 2e9],
  rayleighScattering: [
    /*#__PURE__*/ map(EARTH_WAVELENGTHS, nm => RAYLEIGH_COEFFICIENT / (nm * 1e-3) ** 4),
    0,
    1
  ],
  rayleighScaleHeight: [8000, 1, 1e6],
  rayleighLayers: [[], 1, 1e6],
  mieScattering: [/*#__PURE__*/ all(0.9 * CLEAR_AEROSOL_EXTINCTION), 0, 1],
  mieExtinction: [/*#__PURE__*/ all(CLEAR_AEROSOL_EXTINCTION), 0, 1],
  mieScaleHeight: [1200, 1, 1e6],
  mieAsymmetry: [0.8, -0.99, 0.99],
  absorptionExtinction: [/*#__PURE__*/ earthOzone(300), 0, 1],
  absorptionAltitude: [25_000, -1e6, 1e6],
  absorptionHalfWidth: [OZONE_HALF_WIDTH, 1, 1e6],
  groundAlbedo: [/*#__PURE__*/ all(0.1), 0, 1],
  spectralToXYZ: [
    [
      [15.663, -1.271, 49.385, 42.533],
      [2.555, 30.708, 53.273, 20.437],
      [80.267, 44.313, -19.464, 1.186]
    ],
    -1e4,
    1e4
  ]
}

const CLASS = 'AtmosphereParameters'

/** Names of all options. */
const NAMES = [...Object.keys(FIELDS), 'turbidity', 'ozone'] as (keyof AtmosphereParametersInit)[]

/** Fields, with those that turbidity and ozone stand for. */
function fieldsOf({ turbidity, ozone, ...fields }: AtmosphereParametersInit): object {
  const made: AtmosphereParametersFields = {}
  if (turbidity !== undefined) {
    check('turbidity', turbidity, 1, 20)
    const extinction = CLEAR_AEROSOL_EXTINCTION * (turbidity - 1)
    made.mieScattering = all(0.9 * extinction)
    made.mieExtinction = all(extinction)
  }
  if (ozone !== undefined) {
    check('ozone', ozone, 0, 1000)
    made.absorptionExtinction = earthOzone(ozone)
  }
  for (const name of Object.keys(made) as (keyof Fields)[]) {
    if (fields[name] === undefined) continue
    const other = name.startsWith('mie') ? 'turbidity' : 'ozone'
    fail(CLASS, `${other} must not be given together with ${name}`)
  }
  return { ...fields, ...made }
}

const check = (name: string, value: unknown, min: number, max: number): void =>
  checkRange(CLASS, name, value, min, max)

/** Checked copy of a field's value, which must have the shape of the Earth's. */
function checkedCopy<T>(name: string, value: T, earth: T, least: number, most: number): T {
  if (!Array.isArray(earth)) {
    check(name, value, least, most)
    return value
  }
  if (!Array.isArray(value) || value.length !== earth.length) {
    fail(CLASS, `${name} must be an array of ${earth.length} values`, value)
  }
  return earth.map((part, i) => checkedCopy(`${name}[${i}]`, value[i], part, least, most)) as T
}

/**
 * Composition of an atmosphere. Fields are immutable; {@link set} replaces some and counts `version` up, so
 * that tables made from them are known to be stale.
 *
 * ```ts
 * const parameters = new AtmosphereParameters({ turbidity: 4, ozone: 280 })
 * parameters.set({ turbidity: 6, groundAlbedo: [0.3, 0.3, 0.3, 0.3] })
 * ```
 */
export class AtmosphereParameters {
  #version = 0

  declare readonly wavelengths: Spectrum
  declare readonly solarIrradiance: Spectrum
  declare readonly sunAngularRadius: number
  declare readonly limbDarkening: Spectrum
  declare readonly bottomRadius: number
  declare readonly ellipsoid: Ellipsoid | null
  declare readonly topRadius: number
  declare readonly rayleighScattering: Spectrum
  declare readonly rayleighScaleHeight: number
  declare readonly rayleighLayers: ScaleHeightLayers
  declare readonly mieScattering: Spectrum
  declare readonly mieExtinction: Spectrum
  declare readonly mieScaleHeight: number
  declare readonly mieAsymmetry: number | Spectrum
  declare readonly absorptionExtinction: Spectrum
  declare readonly absorptionAltitude: number
  declare readonly absorptionHalfWidth: number
  declare readonly groundAlbedo: Spectrum
  declare readonly spectralToXYZ: SpectralMatrix

  /**
   * @param init - Fields that differ from the Earth's.
   * @throws If a field is unknown, of the wrong kind or out of its range.
   */
  constructor(init: AtmosphereParametersInit = {}) {
    const earth = Object.entries(FIELDS).map(([name, [value]]) => [name, value])
    this.set(Object.fromEntries(earth)).set(init)
    this.#version = 0
  }

  /** Number of calls of {@link set}. */
  get version(): number {
    return this.#version
  }

  /** True if nothing scatters or absorbs light. */
  get isAirless(): boolean {
    const { rayleighScattering, mieExtinction, absorptionExtinction } = this
    return [rayleighScattering, mieExtinction, absorptionExtinction].every(spectrum =>
      spectrum.every(value => value === 0)
    )
  }

  /**
   * Replaces fields. Tables made from these parameters are baked again.
   *
   * @param init - The fields to replace; arrays are copied, undefined changes nothing.
   * @throws If a field is unknown, of the wrong kind or out of its range; then nothing has changed.
   */
  set(init: AtmosphereParametersInit): this {
    // Options are plain objects, and a clone's are parameters.
    const options: AtmosphereParametersInit =
      init instanceof AtmosphereParameters ? Object.assign({}, init) : init
    checkOptions(CLASS, options, ...NAMES)
    const next: AtmosphereParametersFields = {}
    for (const [name, value] of Object.entries(fieldsOf(init))) {
      if (value === undefined) continue
      const field: readonly [unknown, number, number] = FIELDS[name as keyof Fields]
      const [earth, least, most] = field
      // The fields of more than one shape.
      if (name === 'ellipsoid') {
        if (value !== null) checkEllipsoid(CLASS, value)
        next.ellipsoid = value as unknown as Ellipsoid | null
        continue
      }
      let shape = name === 'mieAsymmetry' && Array.isArray(value) ? all(0) : earth
      if (name === 'rayleighLayers') {
        if (!Array.isArray(value) || value.length > 3) {
          fail(CLASS, `${name} must be an array of at most 3 layers`, value)
        }
        shape = value.map(() => [0, 0])
      }
      Object.assign(next, { [name]: checkedCopy<unknown>(name, value, shape, least, most) })
    }
    const { bottomRadius, topRadius, mieScattering, mieExtinction } = Object.assign({}, this, next)
    mieScattering.forEach((value, i) => check('mieScattering', value, 0, mieExtinction[i]))
    next.rayleighLayers?.reduce((below, [base], i) => {
      check(`rayleighLayers[${i}][0]`, base, below, 1e6)
      return base
    }, 1)
    check('topRadius', topRadius, bottomRadius * (1 + 1e-5), bottomRadius * 1.5)
    for (const [name, value] of Object.entries(next)) {
      // Assigning to a field throws: those who hold tables would not learn of it.
      Object.defineProperty(this, name, { configurable: true, enumerable: true, value })
    }
    this.#version++
    return this
  }

  /** Independent copy. */
  clone(): AtmosphereParameters {
    return new AtmosphereParameters(this)
  }
}

/** @throws If they are no parameters. */
export function checkParameters(where: string, value: AtmosphereParameters): void {
  if (!(value instanceof AtmosphereParameters)) {
    fail(where, 'parameters must be AtmosphereParameters', value)
  }
}

/** Four numbers, one per wavelength, in the order of {@link AtmosphereParameters.wavelengths}. */
export type Spectrum = readonly [number, number, number, number]

/** Three rows (X, Y, Z) of four columns, one per wavelength. */
export type SpectralMatrix = readonly [Spectrum, Spectrum, Spectrum]

/**
 * What an atmosphere is made of, as plain numbers in SI units; spectra have four values.
 *
 * Molecules and aerosols thin out exponentially, an absorber (on Earth ozone) has the profile of a
 * tent, the ground is Lambertian.
 */
export interface AtmosphereParametersInit {
  /** The four wavelengths [nm]. */
  wavelengths?: Spectrum
  /** Spectral irradiance of the sun above the air [W/m²/nm]. */
  solarIrradiance?: Spectrum
  /** Angular radius of the sun's disc, in (0, 0.2] [rad]. */
  sunAngularRadius?: number
  /** Darkening u of the sun's limb, I(ρ) ∝ 1 − u (1 − √(1 − ρ²)), in [0, 1]. */
  limbDarkening?: Spectrum
  /** Planet's centre to the ground: radius of the sphere that the ellipsoid is mapped to [m]. */
  bottomRadius?: number
  /** Planet's centre to the top of the air [m]. */
  topRadius?: number
  /** Scattering by molecules at the ground [1/m]. */
  rayleighScattering?: Spectrum
  /** Height over which molecules thin out by a factor e [m]. */
  rayleighScaleHeight?: number
  /** Scattering by aerosols at the ground [1/m]. */
  mieScattering?: Spectrum
  /** Extinction (scattering and absorption) by aerosols at the ground [1/m]. */
  mieExtinction?: Spectrum
  /** Height over which aerosols thin out by a factor e [m]. */
  mieScaleHeight?: number
  /** Asymmetry g of the aerosols' Cornette–Shanks phase function, in (−1, 1); one, or per wavelength. */
  mieAsymmetry?: number | Spectrum
  /** Absorption by the tent-shaped layer where it is densest [1/m]. */
  absorptionExtinction?: Spectrum
  /** Altitude at which that layer is densest [m]. */
  absorptionAltitude?: number
  /** Distance above and below over which it thins out linearly to nothing [m]. */
  absorptionHalfWidth?: number
  /** Part of the light that the ground reflects, in [0, 1]. */
  groundAlbedo?: Spectrum
  /**
   * Turns spectral radiance at the four wavelengths into CIE 1931 XYZ
   * [683⁻¹ cd/m² per W/m²/sr/nm].
   *
   * Fitted by `packages/atmosphere/scripts/fit-color.ts` to a solution at 35 wavelengths. Skies that
   * the fit has not seen: ΔE2000 mean 0.07, 95th percentile 0.19; `spectral_sky.json`: 0.09, 0.27.
   * Sunlight at zenith angles from 0° to 88°: chromaticity ΔE2000 ≤ 0.14, illuminance within 0.3 %;
   * above the air 132 klx.
   */
  spectralToXYZ?: SpectralMatrix
}

/** Air at sea level scatters this over λ⁴, λ in µm [µm⁴/m]. Bruneton 2017, after Penndorf 1957. */
const RAYLEIGH_COEFFICIENT = 1.24062e-6

/** Molecules in a column of one Dobson unit [1/m²]. */
const DOBSON_UNIT = 2.687e20

/** Cross-section of ozone at 440, 520, 560, 630 nm; 233 K, averaged over 10 nm [m²]. IUP Bremen. */
const OZONE_CROSS_SECTION: Spectrum = [1.582e-26, 2.139e-25, 4.266e-25, 3.215e-25]

/** Extinction by the clear air's aerosols at the ground [1/m]: optical depth 5.328e-3 to the zenith. */
const CLEAR_AEROSOL_EXTINCTION = 5.328e-3 / 1200

const all = (value: number): Spectrum => [value, value, value, value]

/** Four numbers from one that stands for all, or from four. */
export const spectrumOf = (value: number | Spectrum): Spectrum =>
  typeof value === 'number' ? all(value) : value

const map = (values: Spectrum, f: (value: number) => number): Spectrum => [
  f(values[0]),
  f(values[1]),
  f(values[2]),
  f(values[3])
]

const EARTH_WAVELENGTHS: Spectrum = [440, 520, 560, 630]
const OZONE_HALF_WIDTH = 15_000

const earthOzone = (dobsonUnits: number): Spectrum =>
  map(OZONE_CROSS_SECTION, area => (area * dobsonUnits * DOBSON_UNIT) / OZONE_HALF_WIDTH)

const EARTH: Required<AtmosphereParametersInit> = {
  wavelengths: EARTH_WAVELENGTHS,
  solarIrradiance: [1.91198, 1.8685, 1.8341, 1.64654],
  sunAngularRadius: 0.004675,
  limbDarkening: [0.75, 0.65, 0.6, 0.52],
  bottomRadius: 6_378_137,
  topRadius: 6_378_137 + 60_000,
  rayleighScattering: /*#__PURE__*/ map(
    EARTH_WAVELENGTHS,
    nm => RAYLEIGH_COEFFICIENT / (nm * 1e-3) ** 4
  ),
  rayleighScaleHeight: 8000,
  mieScattering: /*#__PURE__*/ all(0.9 * CLEAR_AEROSOL_EXTINCTION),
  mieExtinction: /*#__PURE__*/ all(CLEAR_AEROSOL_EXTINCTION),
  mieScaleHeight: 1200,
  mieAsymmetry: 0.8,
  absorptionExtinction: /*#__PURE__*/ earthOzone(300),
  absorptionAltitude: 25_000,
  absorptionHalfWidth: OZONE_HALF_WIDTH,
  groundAlbedo: /*#__PURE__*/ all(0.1),
  spectralToXYZ: [
    [15.663, -1.271, 49.385, 42.533],
    [2.555, 30.708, 53.273, 20.437],
    [80.267, 44.313, -19.464, 1.186]
  ]
}

function check(name: string, value: number, min: number, max: number): void {
  if (!(value >= min && value <= max)) {
    throw new Error(`AtmosphereParameters: ${name} must be in [${min}, ${max}], got ${value}`)
  }
}

function checkSpectrum(name: string, values: Spectrum, min: number, max: number): void {
  if (values.length !== 4) {
    throw new Error(`AtmosphereParameters: ${name} must have 4 values, got ${values.length}`)
  }
  values.forEach((value, i) => check(`${name}[${i}]`, value, min, max))
}

/**
 * What an atmosphere is made of. Immutable fields; {@link set} replaces some and counts `version` up,
 * so that tables made from them know that they are stale.
 *
 * ```ts
 * const parameters = AtmosphereParameters.earth({ turbidity: 4, ozone: 280 })
 * parameters.set({ groundAlbedo: [0.3, 0.3, 0.3, 0.3] })
 * ```
 */
export class AtmosphereParameters {
  /** Counts the calls of {@link set}. */
  version = 0

  readonly wavelengths!: Spectrum
  readonly solarIrradiance!: Spectrum
  readonly sunAngularRadius!: number
  readonly limbDarkening!: Spectrum
  readonly bottomRadius!: number
  readonly topRadius!: number
  readonly rayleighScattering!: Spectrum
  readonly rayleighScaleHeight!: number
  readonly mieScattering!: Spectrum
  readonly mieExtinction!: Spectrum
  readonly mieScaleHeight!: number
  readonly mieAsymmetry!: number | Spectrum
  readonly absorptionExtinction!: Spectrum
  readonly absorptionAltitude!: number
  readonly absorptionHalfWidth!: number
  readonly groundAlbedo!: Spectrum
  readonly spectralToXYZ!: SpectralMatrix

  /**
   * @param init - Fields that differ from the Earth's.
   * @throws If a field is not a number or out of its range.
   */
  constructor(init: AtmosphereParametersInit = {}) {
    Object.assign(this, EARTH)
    this.set(init)
    this.version = 0
  }

  /**
   * The Earth's atmosphere from two everyday numbers.
   *
   * @param options - `turbidity` in [1, 20]: haziness as aerosol optical depth, 1 none, 2 the clear
   *   air of the default, growing in proportion; `ozone` in [0, 1000] [Dobson units], default 300.
   * @throws If a number is out of its range.
   */
  static earth(options: { turbidity?: number; ozone?: number } = {}): AtmosphereParameters {
    return new AtmosphereParameters().setEarth(options)
  }

  /**
   * Sets turbidity and ozone as {@link earth} does, keeping everything else.
   *
   * @throws If a number is out of its range; then nothing has changed.
   */
  setEarth({ turbidity, ozone }: { turbidity?: number; ozone?: number }): this {
    if (turbidity !== undefined) check('turbidity', turbidity, 1, 20)
    if (ozone !== undefined) check('ozone', ozone, 0, 1000)
    if (turbidity !== undefined) {
      const extinction = CLEAR_AEROSOL_EXTINCTION * (turbidity - 1)
      this.set({ mieScattering: all(0.9 * extinction), mieExtinction: all(extinction) })
    }
    if (ozone !== undefined) this.set({ absorptionExtinction: earthOzone(ozone) })
    return this
  }

  /**
   * Replaces fields. Whoever holds tables made from these parameters re-bakes them.
   *
   * @param init - The fields to replace.
   * @throws If a field is not a number or out of its range; then nothing has changed.
   */
  set(init: AtmosphereParametersInit): this {
    const next = { ...(this as Required<AtmosphereParametersInit>), ...init }
    checkSpectrum('wavelengths', next.wavelengths, 100, 3000)
    checkSpectrum('solarIrradiance', next.solarIrradiance, 0, 1e4)
    check('sunAngularRadius', next.sunAngularRadius, 1e-6, 0.2)
    checkSpectrum('limbDarkening', next.limbDarkening, 0, 1)
    check('bottomRadius', next.bottomRadius, 1e3, 1e9)
    check('topRadius', next.topRadius, next.bottomRadius * (1 + 1e-5), next.bottomRadius * 1.5)
    checkSpectrum('rayleighScattering', next.rayleighScattering, 0, 1)
    check('rayleighScaleHeight', next.rayleighScaleHeight, 1, 1e6)
    checkSpectrum('mieScattering', next.mieScattering, 0, 1)
    checkSpectrum('mieExtinction', next.mieExtinction, 0, 1)
    check('mieScaleHeight', next.mieScaleHeight, 1, 1e6)
    checkSpectrum('mieAsymmetry', spectrumOf(next.mieAsymmetry), -0.99, 0.99)
    checkSpectrum('absorptionExtinction', next.absorptionExtinction, 0, 1)
    check('absorptionAltitude', next.absorptionAltitude, -1e6, 1e6)
    check('absorptionHalfWidth', next.absorptionHalfWidth, 1, 1e6)
    checkSpectrum('groundAlbedo', next.groundAlbedo, 0, 1)
    next.spectralToXYZ.forEach((row, i) => checkSpectrum(`spectralToXYZ[${i}]`, row, -1e4, 1e4))
    const { version } = this
    Object.assign(this, init)
    this.version = version + 1
    return this
  }

  /** A copy that shares nothing with this one. */
  clone(): AtmosphereParameters {
    return new AtmosphereParameters(this)
  }
}

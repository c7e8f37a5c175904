/** Latent heat of vaporization near 10 °C [MJ/kg]. */
const LATENT_HEAT = 2.48
/** Psychrometric constant at sea level [kPa/K]. */
const PSYCHROMETRIC = 0.066
/** Water of an hour's radiation: 1 W/m² is 0.0036 MJ/(m² h). */
const MEGAJOULES_PER_HOUR = 0.0036

/** Density of new snow, and of snow that has settled [kg/m³]. */
export const NEW_SNOW = 100
const SETTLED_SNOW = 300
/** Rate at which snow settles [1/h]. */
const SETTLING = 0.01
/** Exponent of density in the depth that covers the ground (Niu & Yang 2007; land models also take 1, as CLM 4.5 does) [–]. */
const MELTING_FACTOR = 1.6
/** Roughness length of bare ground [m]. */
const ROUGHNESS_LENGTH = 0.01

/**
 * Pressure of saturated vapour over water [kPa].
 *
 * @param temperature - Temperature of the air [°C].
 * @see Murray 1967, "On the computation of saturation vapor pressure", J. Appl. Meteor. 6, pp. 203–204 (Tetens's formula)
 */
export const saturationPressure = (temperature: number): number =>
  0.6108 * Math.exp((17.27 * temperature) / (temperature + 237.3))

/**
 * Evaporation of a wet surface [mm/h], ≥ 0.
 *
 * Radiation is the absorbed sunlight: what the surface loses as infrared light is left out.
 *
 * @param temperature - Air temperature [°C].
 * @param humidity - Relative humidity, in [0, 1] [–].
 * @param wind - Speed at 2 m [m/s].
 * @param absorbed - Sunlight that the surface absorbs [W/m²].
 * @see Penman 1948, "Natural evaporation from open water, bare soil and grass", Proc. R. Soc. A 194, pp. 120–145, in the units of Shuttleworth 1993
 */
export function evaporation(
  temperature: number,
  humidity: number,
  wind: number,
  absorbed: number
): number {
  const pressure = saturationPressure(temperature)
  const slope = (4098 * pressure) / (temperature + 237.3) ** 2
  const deficit = pressure * (1 - humidity)
  const aerodynamic = ((PSYCHROMETRIC * 6.43) / 24) * (1 + 0.536 * wind) * deficit
  const radiative = slope * absorbed * MEGAJOULES_PER_HOUR
  return (radiative + aerodynamic) / (LATENT_HEAT * (slope + PSYCHROMETRIC))
}

/**
 * Melt of snow, as water [mm/h].
 *
 * @param temperature - Air temperature [°C]; at 1 °C and below nothing melts.
 * @param irradiance - Sunlight and skylight on the snow [W/m²].
 * @param albedo - Albedo of the snow [–].
 * @see Pellicciotti et al. 2005, "An enhanced temperature-index glacier melt model", J. Glaciol. 51, pp. 573–587
 */
export const snowmelt = (temperature: number, irradiance: number, albedo = 0.8): number =>
  temperature > 1 ? 0.05 * temperature + 0.0094 * (1 - albedo) * irradiance : 0

/**
 * Density of snow after some hours [kg/m³].
 *
 * @param density - Before [kg/m³].
 * @see Verseghy 1991, "CLASS – a Canadian land surface scheme for GCMs, I", Int. J. Climatol. 11, pp. 111–133
 */
export const settledDensity = (density: number, hours: number): number =>
  SETTLED_SNOW + (density - SETTLED_SNOW) * Math.exp(-SETTLING * hours)

/**
 * Share of the ground that snow covers, in [0, 1) [–].
 *
 * @param water - Water equivalent of the snow, ≥ 0 [mm].
 * @param density - Density of the snow [kg/m³].
 * @see Niu & Yang 2007, "An observation-based formulation of snow cover fraction", J. Geophys. Res. vol. 112, D21101
 */
export function snowCoverFraction(water: number, density: number): number {
  const depth = water / density // mm of water are kg/m²
  return Math.tanh(depth / (2.5 * ROUGHNESS_LENGTH * (density / NEW_SNOW) ** MELTING_FACTOR))
}

/**
 * Share of a surface that is wet, in [0, 1] [–].
 *
 * @param film - Water on it, over what it can hold, in [0, 1] [–].
 * @see Deardorff 1978, "Efficient prediction of ground surface temperature and moisture", J. Geophys. Res. 83, pp. 1889–1903 (of leaves)
 */
export const wetFraction = (film: number): number => Math.min(film, 1) ** (2 / 3)

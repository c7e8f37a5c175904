import type { AtmosphereParameters } from '../AtmosphereParameters'

/** Densities of molecules, aerosols and absorber at an altitude [m], relative to their references. */
export function densities(p: AtmosphereParameters, altitude: number): [number, number, number] {
  return [
    Math.exp(-altitude / p.rayleighScaleHeight),
    Math.exp(-altitude / p.mieScaleHeight),
    Math.max(0, 1 - Math.abs(altitude - p.absorptionAltitude) / p.absorptionHalfWidth)
  ]
}

/**
 * Extinction coefficient of air with given densities, one value per wavelength [1/m]; or of a column,
 * from densities integrated along it [m], the optical depth.
 */
export function extinction(
  p: AtmosphereParameters,
  [molecules, aerosols, absorber]: readonly [number, number, number]
): number[] {
  return [0, 1, 2, 3].map(
    i =>
      p.rayleighScattering[i] * molecules +
      p.mieExtinction[i] * aerosols +
      p.absorptionExtinction[i] * absorber
  )
}

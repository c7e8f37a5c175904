import type { AtmosphereParameters } from '../../parameters/AtmosphereParameters'

/** Density of molecules at an altitude h ≥ 0 [m], relative to the ground's. */
export function molecularDensity(p: AtmosphereParameters, altitude: number): number {
  let [base, scaleHeight, depth] = [0, p.rayleighScaleHeight, 0]
  for (const [nextBase, nextScaleHeight] of p.rayleighLayers) {
    if (altitude <= nextBase) break
    depth += (nextBase - base) / scaleHeight
    ;[base, scaleHeight] = [nextBase, nextScaleHeight]
  }
  return Math.exp(-depth - (altitude - base) / scaleHeight)
}

/**
 * Height of the homogeneous atmosphere: that of a column with as many molecules, without a top, as
 * dense all the way as at the ground [m]. Of a single layer it is the scale height.
 */
export function homogeneousHeight(p: AtmosphereParameters): number {
  let [height, scaleHeight] = [p.rayleighScaleHeight, p.rayleighScaleHeight]
  for (const [base, nextScaleHeight] of p.rayleighLayers) {
    height += molecularDensity(p, base) * (nextScaleHeight - scaleHeight)
    scaleHeight = nextScaleHeight
  }
  return height
}

/** Densities of molecules, aerosols and absorber at an altitude [m], relative to their references. */
export function densities(p: AtmosphereParameters, altitude: number): [number, number, number] {
  return [
    molecularDensity(p, altitude),
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

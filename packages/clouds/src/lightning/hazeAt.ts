import type { AtmosphereView } from '@welkin/atmosphere'

/** Scattering by molecules and aerosols at an altitude, 520 nm [1/m]. */
export function hazeAt({ atmosphere }: AtmosphereView, altitude: number): number {
  const { rayleighScattering, rayleighScaleHeight, mieScattering, mieScaleHeight } =
    atmosphere.parameters
  return (
    rayleighScattering[1] * Math.exp(-altitude / rayleighScaleHeight) +
    mieScattering[1] * Math.exp(-altitude / mieScaleHeight)
  )
}

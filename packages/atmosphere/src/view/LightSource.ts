import type { Vector3 } from 'three'
import { Vector4 } from 'three'
import { fail } from '@welkin/geo'
import type { Spectrum } from '../parameters/AtmosphereParameters'
import { vector4 } from '../uniforms'

/**
 * Source of light in the air: the sun, or the moon. Tables are per unit of irradiance, so one set serves both,
 * and so are sky volumes, of which there are some for each source.
 */
export class LightSource {
  /**
   * Irradiance above the air over `solarIrradiance` at the camera [–], a uniform of four values. 1 for
   * the bare sun.
   */
  readonly irradiance = vector4(new Vector4(1, 1, 1, 1))

  /**
   * @param direction - Writes the direction to the source into its target, and answers with it: in world
   *   space, of unit length. `from` is the position that it is seen from, in world space.
   * @param lightsAir - True if its light in the air is seen, so that sky volumes are computed for it.
   */
  constructor(
    readonly direction: (target: Vector3, from?: Vector3) => Vector3,
    public lightsAir = true
  ) {}

  /** {@link irradiance} at a position in world space. */
  irradianceAt: (position: Vector3) => Spectrum = () => [1, 1, 1, 1]
}

/** @throws If it is no source of light. */
export function checkSource(where: string, name: string, source: LightSource): void {
  if (!(source instanceof LightSource)) {
    fail(where, `${name} must be a LightSource, such as a moon's source`, source)
  }
}

/** @throws If they are no sources of light. */
export function checkSources(where: string, sources: readonly LightSource[]): void {
  if (!Array.isArray(sources)) fail(where, 'sources must be an array', sources)
  sources.forEach((source, i) => checkSource(where, `sources[${i}]`, source))
}

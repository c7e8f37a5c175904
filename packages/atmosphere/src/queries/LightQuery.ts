import { Vector3 } from 'three'
import { checkDirection, checkVector, fail } from '@welkin/geo'
import type { Atmosphere } from '../Atmosphere'
import type { AtmosphereParameters, Spectrum } from '../parameters/AtmosphereParameters'
import { spectralToLinearSRGB, type Triple } from '../air/cpu/color'
import type { DiffuseLightData } from '../diffuseLight/cpu/diffuseLight'
import type { SphericalSpace } from '../view/cpu/spherical'
import { checkSource, type LightSource } from '../view/LightSource'
import { checkAtmosphere } from '../view/ViewNodes'

export const clampCosine = (value: number): number => Math.min(Math.max(value, -1), 1)

/** A question about one source's light at a position of the scene, in float64: what all answers begin with. */
export class LightQuery {
  readonly parameters: AtmosphereParameters
  /** Planet's centre to the position, at least to the ground [m]. */
  readonly radius: number
  /** Position in world space. */
  readonly position: Vector3
  /** μ_s. */
  readonly cosLight: number
  /** Zenith at the position, and direction to the source: unit length, in the mapped space. */
  readonly #up: Vector3
  readonly #lightDirection: Vector3
  readonly #where: string
  readonly #space: SphericalSpace
  readonly #data: DiffuseLightData | null
  /** Irradiance of the source, over the bare sun's. */
  readonly #irradiance: Spectrum

  /**
   * @param where - The function that the user called.
   * @param position - World.
   * @param source - Source of the light.
   */
  constructor(
    where: string,
    atmosphere: Atmosphere,
    position: Vector3,
    source: LightSource = atmosphere?.sun
  ) {
    checkAtmosphere(where, atmosphere)
    checkVector(where, 'position', position)
    checkSource(where, 'source', source)
    const { parameters, space, tables } = atmosphere
    this.#where = where
    this.position = position
    this.parameters = parameters
    this.#space = space
    this.#data = tables.data
    this.#up = space.position(position, new Vector3())
    // At the planet's centre there is no zenith.
    checkDirection(where, 'position', this.#up)
    this.radius = Math.max(this.#up.length(), parameters.bottomRadius)
    this.#up.normalize()
    this.#irradiance = source.irradianceAt(position)
    this.#lightDirection = this.#direction('source', source.direction(new Vector3(), position))
    this.cosLight = clampCosine(this.#up.dot(this.#lightDirection))
  }

  /** Altitude above the ground [m]. */
  get altitude(): number {
    return this.radius - this.parameters.bottomRadius
  }

  /** A direction [world] in the mapped space, unit length. */
  #direction(name: string, world: Vector3): Vector3 {
    checkDirection(this.#where, name, world)
    return this.#space.direction(world, new Vector3())
  }

  /** Cosines between a direction and the zenith, and between it and the source. */
  cosinesOf(name: string, world: Vector3): { zenith: number; light: number } {
    const direction = this.#direction(name, world)
    return {
      zenith: clampCosine(direction.dot(this.#up)),
      light: clampCosine(direction.dot(this.#lightDirection))
    }
  }

  /** The diffuse-light table. @throws Before it was read back. */
  get data(): DiffuseLightData {
    const missing = 'there are no tables yet: await atmosphere.bake(renderer) first'
    return this.#data ?? fail(this.#where, missing)
  }

  /** Linear sRGB from values per unit of the source's irradiance. */
  linearSRGB(perIrradiance: readonly number[]): Triple {
    const { solarIrradiance } = this.parameters
    const values = perIrradiance.map((value, i) => value * solarIrradiance[i] * this.#irradiance[i])
    return spectralToLinearSRGB(this.parameters, values as unknown as Spectrum)
  }
}

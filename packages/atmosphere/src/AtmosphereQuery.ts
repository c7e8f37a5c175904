import { Vector3 } from 'three'
import { checkDirection, checkVector, fail } from '@welkin/geo'
import type { AtmosphereParameters, Spectrum } from './parameters/AtmosphereParameters'
import { spectralToLinearSRGB, type Triple } from './air/cpu/color'
import type { DiffuseLightData } from './diffuseLight/cpu/diffuseLight'
import { skyIrradiance } from './diffuseLight/cpu/skyIrradiance'
import type { SphericalSpace } from './view/cpu/spherical'
import { lightTransmittance } from './transmittance/cpu/transmittance'

export const clampCosine = (value: number): number => Math.min(Math.max(value, -1), 1)

/** Answers questions about light at places and in directions of a scene, in float64. */
export class AtmosphereQuery {
  readonly parameters: AtmosphereParameters
  readonly #space: SphericalSpace
  readonly #data: DiffuseLightData | null
  /** Irradiance of the source, over the bare sun's. */
  readonly #irradiance: Spectrum
  readonly lightDirection: Vector3

  constructor(
    parameters: AtmosphereParameters,
    space: SphericalSpace,
    sunWorld: Vector3,
    data: DiffuseLightData | null,
    irradiance: Spectrum
  ) {
    this.parameters = parameters
    this.#space = space
    this.#data = data
    this.#irradiance = irradiance
    this.lightDirection = space.direction(sunWorld, new Vector3())
  }

  /** Place of a position [world] in the mapped space. */
  place(position: Vector3) {
    checkVector('Atmosphere', 'position', position)
    const up = this.#space.position(position, new Vector3())
    // At the planet's centre there is no zenith.
    checkDirection('Atmosphere', 'position', up)
    const radius = Math.max(up.length(), this.parameters.bottomRadius)
    up.normalize()
    return { up, radius, cosLight: clampCosine(up.dot(this.lightDirection)) }
  }

  /** A direction [world] in the mapped space. */
  direction(name: string, world: Vector3): Vector3 {
    checkDirection('Atmosphere', name, world)
    return this.#space.direction(world, new Vector3())
  }

  /** The diffuse-light table, for a method that needs it. */
  table(method: string): DiffuseLightData {
    if (this.#data === null) {
      fail(method, 'there are no tables yet: await atmosphere.bake(renderer) first')
    }
    return this.#data
  }

  /** Linear sRGB from values per unit of the source's irradiance. */
  linearSRGB(perIrradiance: number[]): Triple {
    const { solarIrradiance } = this.parameters
    const values = perIrradiance.map((value, i) => value * solarIrradiance[i] * this.#irradiance[i])
    return spectralToLinearSRGB(this.parameters, values as unknown as Spectrum)
  }

  directIlluminance(position: Vector3): Triple {
    const { radius, cosLight } = this.place(position)
    return this.linearSRGB(lightTransmittance(this.parameters, radius, cosLight))
  }

  skyIlluminance(position: Vector3, normal: Vector3): Triple {
    const data = this.table('Atmosphere.skyIlluminanceAt')
    const { up, radius, cosLight } = this.place(position)
    const n = this.direction('normal', normal)
    const altitude = radius - this.parameters.bottomRadius
    const cosNormal = clampCosine(n.dot(up))
    const cosNormalLight = clampCosine(n.dot(this.lightDirection))
    return this.linearSRGB(
      skyIrradiance(this.parameters, data, altitude, cosNormal, cosLight, cosNormalLight)
    )
  }
}

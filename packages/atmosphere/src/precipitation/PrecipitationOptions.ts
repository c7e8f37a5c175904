import type { Camera, Light } from 'three'
import type { Node } from 'three/webgpu'
import { fail } from '@welkin/geo'
import type { PrecipitationWind } from './FallingLattice'
import { isLamp } from './LampUniforms'
import type { PrecipitationShelter } from './PrecipitationShelter'

/** Options of {@link Precipitation}. */
export interface PrecipitationOptions {
  /** See {@link Precipitation.rate}; by default 5. */
  rate?: number
  /** See {@link Precipitation.wind}; by default none. */
  wind?: PrecipitationWind
  /** See {@link Precipitation.gusts}; by default 0.25. */
  gusts?: number
  /** See {@link Precipitation.shutter}; by default 1/120. */
  shutter?: number
  /** See {@link Precipitation.aperture}; by default 0.005. */
  aperture?: number
  /** See {@link Precipitation.focus}; by default 10. */
  focus?: number
  /** See {@link Precipitation.strength}; by default 1. */
  strength?: number
  /** See {@link Precipitation.time}; by default null. */
  time?: number | null
  /**
   * Lights of the scene that fall on it: sun, moon and other directional lights, probes and ambient lights, and up to four
   * `PointLight`s and `SpotLight`s. By default none.
   */
  lights?: readonly Light[]
  /** Roofs that keep it off; by default none. Shared, not owned. */
  shelter?: PrecipitationShelter
  /** Depth that hides it, of `depthCamera`, for a scene of its own that is laid over a picture; by default the depth test does. */
  depth?: Node
  /** Camera that drew `depth`. */
  depthCamera?: Camera
  /** Most particles of each of four classes of size, a positive integer; by default 32,768 in rain, 65,536 in snow. */
  maxParticles?: number
}

export const SETTINGS = [
  'rate',
  'wind',
  'gusts',
  'shutter',
  'aperture',
  'focus',
  'strength',
  'time'
] as const
export const OTHERS = ['lights', 'shelter', 'depth', 'depthCamera', 'maxParticles'] as const

/** Most lamps. */
const LAMPS = 4

/** @throws If they are no lights, or more lamps than four. */
export function checkLights(where: string, lights: readonly Light[]): void {
  if (!Array.isArray(lights)) fail(where, 'lights must be an array of Lights', lights)
  lights.forEach((light: Light, i) => {
    if (!light?.isLight) fail(where, `lights[${i}] must be a Light`, light)
  })
  const lamps = lights.filter(isLamp).length
  if (lamps > LAMPS) fail(where, `lights must have at most ${LAMPS} lamps`, lamps)
}

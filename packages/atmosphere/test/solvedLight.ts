import { AtmosphereParameters } from '@welkin/atmosphere'
import {
  solveDiffuseLight,
  type DiffuseLightQuality
} from '../src/diffuseLight/cpu/solveDiffuseLight'
import type { DiffuseLightData } from '../src/diffuseLight/cpu/diffuseLight'

let solved: DiffuseLightData | undefined

/** Diffuse light of the default air, which is solved once for all tests of a worker: it takes seconds. */
export function solvedLight(): DiffuseLightData {
  solved ??= solveDiffuseLight(new AtmosphereParameters())
  return solved
}

/** Resolution that is enough for colours of skies: a third of the time of the default. */
export const QUICK: Partial<DiffuseLightQuality> = {
  sun: { elevations: 8, azimuths: 8, steps: 6 },
  diffuse: { elevations: 5, azimuths: 4, steps: 4 }
}

import { distanceFog, heightFog } from '@welkin/atmosphere'
import { createLand } from './globe/land'
import type { Place } from './globe/places'
import { applyTime } from './scene'
import type { RendererArgs, SceneHandle, TimeArgs } from './scene'

/** Position and direction of the camera. */
export const VIEWS = {
  ridge: {
    label: 'Above the mist',
    longitude: -84.163,
    latitude: 36.492,
    height: 760,
    heading: 36,
    pitch: -5
  },
  slope: {
    label: 'At its upper edge',
    longitude: -84.178,
    latitude: 36.622,
    height: 372,
    heading: 60,
    pitch: 4
  },
  floor: {
    label: 'In the mist',
    longitude: -84.178,
    latitude: 36.622,
    height: 342,
    heading: 318,
    pitch: 4
  },
  high: {
    label: 'From 4 km',
    longitude: -84.1517,
    latitude: 36.43,
    height: 4000,
    heading: 10,
    pitch: -22
  }
} satisfies Record<string, Place>

export interface FogValleyArgs extends RendererArgs, TimeArgs {
  view: keyof typeof VIEWS
  /** Extinction of the mist at its base [1/km]. */
  density: number
  /** Altitude over which it falls to 1/e [m]. */
  falloff: number
  /** Altitude of its base [m]. */
  base: number
  /** Density of the fog by distance [1/km]. */
  distance: number
}

/** Mist in the valleys along the Jacksboro fault at sunrise: real heights, in ECEF metres. */
export const createFogValley = (
  canvas: HTMLCanvasElement,
  args: FogValleyArgs
): Promise<SceneHandle<FogValleyArgs>> =>
  createLand(canvas, args, 46, ({ renderer, air }) => {
    const { atmosphere } = air
    // #region fog
    atmosphere.frame = 'ecef' // the world's axes are the Earth's, its origin the Earth's centre
    const mist = heightFog({ base: 300, falloff: 40, density: 0.006 }) // metres, 1/m: in the valleys
    const murk = distanceFog({ density: 1 / 8000 }) // 1/m: where the scene ends
    atmosphere.add(murk, mist)
    // #endregion
    return {
      place: ({ view }) => VIEWS[view],
      apply(current) {
        applyTime(renderer, air, current)
        const { density, falloff, base, distance } = current
        mist.set({ density: density / 1000, falloff, base })
        murk.density = distance / 1000
      }
    }
  })

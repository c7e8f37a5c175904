import { CloudLayers, cloudPreset, clouds, cloudSkyLight } from '@welkin/clouds'
import type { CloudQualityName } from '@welkin/clouds'
import { screenUV, uniform } from 'three/tsl'
import {
  loadSimulation,
  MOST_EXTINCTION,
  SIMULATED_THICKNESS,
  SimulatedClouds
} from './clouds/simulatedClouds'
import { STILL_QUALITY } from './clouds/still'
import { createLand } from './globe/land'
import type { Place } from './globe/places'
import { applyTime } from './scene'
import type { RendererArgs, SceneHandle, TimeArgs } from './scene'

export interface RealOrNotArgs extends RendererArgs, TimeArgs {
  view: keyof typeof VIEWS
  /** Share of the picture, from the left, that shows the simulation. */
  split: number
  quality: CloudQualityName
}

/** Altitude of both skies' bases [m]. */
const BASE = 1000

/** Places of the camera; the simulated field stands on the first. */
export const VIEWS = {
  ground: {
    label: 'Ground',
    longitude: -84.178,
    latitude: 36.622,
    height: 341.8,
    heading: 318,
    pitch: 18
  },
  among: {
    label: 'Among the clouds',
    longitude: -84.178,
    latitude: 36.622,
    height: 1700,
    heading: 20,
    pitch: -4
  },
  above: {
    label: 'Above',
    longitude: -84.178,
    latitude: 36.622,
    height: 4000,
    heading: 300,
    pitch: -22
  }
} as const satisfies Record<string, Place>

/** Frames of a still, in which coarse marches converge. */
const STILL_FRAMES = 4

/** One sky, whose left part is simulated and whose right part is a preset, under the same sun. */
export async function createRealOrNot(
  canvas: HTMLCanvasElement,
  args: RealOrNotArgs
): Promise<SceneHandle<RealOrNotArgs>> {
  const post: RealOrNotArgs = { ...args, path: 'post' }
  const qualityOf = ({ frame, quality }: RealOrNotArgs) => (frame ? STILL_QUALITY : quality)
  const simulation = await loadSimulation()
  return createLand(canvas, post, 55, ({ renderer, camera, air }) => {
    const { atmosphere, sky, post: picture } = air
    if (picture === undefined) throw new Error('createRealOrNot: there must be a post effect')
    const { pipeline, color, depth } = picture
    atmosphere.frame = 'ecef'
    const quality = qualityOf(args)
    const field = new SimulatedClouds(simulation, atmosphere, { ...VIEWS.ground, height: BASE })
    const split = uniform(args.split)
    const { extinction } = field
    // #region two skies
    // #shown import { float } from 'three/tsl'
    // #shown const [BASE, SIMULATED_THICKNESS, MOST_EXTINCTION] = [1000, 1500, 0.226]
    // #shown const [quality, split] = ['high', 0.5] as const
    // #shown const extinction = () => float(0) // of your clouds at a place [1/m]
    const preset = cloudPreset('fairWeather')
    preset.at(0).set({ baseAltitude: BASE, topAltitude: BASE + 1200, coverage: 0.3 })
    const made = clouds(color, depth, camera, atmosphere, preset, { quality })

    const given = new CloudLayers([
      { baseAltitude: BASE, topAltitude: BASE + SIMULATED_THICKNESS, density: MOST_EXTINCTION }
    ])
    const simulated = clouds(color, depth, camera, atmosphere, given, {
      quality,
      extinction,
      noise: made.noise,
      light: made.light
    })
    pipeline.outputNode = screenUV.x.lessThan(split).select(simulated, made)
    // #endregion
    cloudSkyLight(sky, made)
    for (const node of [made, simulated]) node.time = 0
    return {
      warmUpFrames: STILL_FRAMES,
      place: ({ view }) => VIEWS[view],
      apply(current) {
        applyTime(renderer, air, current)
        split.value = current.split
        for (const node of [made, simulated]) node.quality = qualityOf(current)
      },
      beforeDraw() {
        field.follow(camera)
        if (args.frame) made.field.bake(renderer)
      },
      dispose() {
        simulation.dispose()
        made.dispose()
        simulated.dispose()
      }
    }
  })
}

import {
  cloudPreset,
  clouds,
  cloudsDebug,
  cloudShadow,
  cloudSkyLight,
  cloudWorldMap,
  precipitationShafts
} from '@welkin/clouds'
import type { CloudPresetName, CloudQuality, CloudQualityName, CloudsDebug } from '@welkin/clouds'
import { shadow } from 'three/tsl'
import { STILL_QUALITY } from './clouds/still'
import { cloudCover } from './clouds/cloudCover'
import { layerArgs, layerParameters } from './clouds/layerArgs'
import type { LayerArgs } from './clouds/layerArgs'
import { createBalloons, createCockpit } from './clouds/props'
import { noiseSlices } from './clouds/noiseSlices'
import { ambientAt, stages } from './clouds/stages'
import type { Stage } from './clouds/stages'
import { createLand } from './globe/land'
import type { Place } from './globe/places'
import { applyTime } from './scene'
import type { RendererArgs, SceneHandle, TimeArgs } from './scene'

export interface CloudsArgs extends RendererArgs, TimeArgs, LayerArgs {
  preset: CloudPresetName
  /** Index of the layer that the layer's arguments set. */
  layer: number
  /** The preset and the layer that they were of when they were set. */
  shown: string
  quality: CloudQualityName
  /** Intermediate picture shown instead of the clouds. */
  debug: CloudsDebug | 'off'
  /** Speed of the wind over its real speed. */
  timeLapse: number
  /** Takes the coverage from a map of the world. */
  world: boolean
  /** Stage up to which the layers are made. */
  stage: Stage
  /** Slices of the noise in place of the clouds, and their place in it, in [0, 1]. */
  noise: boolean
  slice: number
  props: 'none' | 'cockpit' | 'balloons'
  /** [degrees] */
  longitude: number
  /** [degrees] */
  latitude: number
  /** Height of the camera above the ellipsoid [m]. */
  altitude: number
  /** Direction of view, from north, clockwise [degrees]. */
  heading: number
  /** Direction of view above the horizontal [degrees]. */
  pitch: number
}

const STILL = { quality: STILL_QUALITY, frames: 4 }

const qualityOf = ({ frame, quality }: CloudsArgs): CloudQuality | CloudQualityName =>
  frame ? STILL.quality : quality

/** Name of a layer, for {@link CloudsArgs.shown}. */
export const shownBy = (preset: CloudPresetName, layer: number): string => `${preset} ${layer}`

/** Clouds over the Earth's land, from a meadow to 20,000 km: the same ones all the way. */
export async function createClouds(
  canvas: HTMLCanvasElement,
  args: CloudsArgs
): Promise<SceneHandle<CloudsArgs>> {
  const cover = args.world ? await cloudCover() : null
  const worldMap = cover && cloudWorldMap(cover)
  const { preset } = args
  const quality = qualityOf(args)
  const post: CloudsArgs = { ...args, path: 'post' }
  let onArgs: SceneHandle<CloudsArgs>['onArgs']

  const handle = await createLand(canvas, post, 55, ({ scene, camera, ...land }) => {
    const { renderer, air } = land
    const { atmosphere, sun, sky, post } = air
    if (post === undefined) throw new Error('createClouds: there must be a post effect')
    const { pipeline, color, depth } = post
    atmosphere.frame = 'ecef' // the world's axes are the Earth's, its origin the Earth's centre
    // #region clouds
    // #shown const preset = 'fairWeather' // or another
    // #shown const quality = 'medium' as const
    // #shown const worldMap = null // of cloud cover, for globes
    const layers = cloudPreset(preset)
    const falls = [...layers].some(layer => layer.precipitation?.rate) // rain or snow
    const precipitation = falls ? precipitationShafts() : undefined
    const options = { quality, worldMap, precipitation }
    const node = clouds(color, depth, camera, atmosphere, layers, options)
    pipeline.outputNode = node
    Object.assign(sun.shadow, { shadowNode: cloudShadow(node, shadow(sun)) }) // with three's own
    cloudSkyLight(sky, node) // the sky's light, through clouds and from them
    // #endregion

    const placeOf = placing()
    const props =
      args.props === 'cockpit'
        ? createCockpit()
        : args.props === 'balloons'
          ? createBalloons(placeOf(args))
          : null
    if (props !== null) scene.add(props.object)

    /** The layers, finished: those on show may be a stage of them. */
    const finished = cloudPreset(preset)

    /** Whatever layer the arguments are meant for takes them, or they take that of the layer. */
    const applyLayer = (current: CloudsArgs): void => {
      const index = Math.min(Math.max(Math.round(current.layer), 0), layers.length - 1)
      const layer = finished.at(index)
      const shown = shownBy(preset, index)
      if (current.shown === shown) {
        layer.set(layerParameters(current))
        return
      }
      const changes = { ...layerArgs(layer.parameters), layer: index, shown }
      Object.assign(current, changes)
      onArgs?.(changes)
    }

    const applyStage = ({ stage }: CloudsArgs): void => {
      node.ambient = ambientAt(stage)
      for (let i = 0; i < layers.length; i++) {
        layers.at(i).set({ ...finished.at(i).parameters, ...stages[stage] })
      }
    }

    const debug = cloudsDebug(node, null)
    const slices = noiseSlices(node.noise)
    const show = (current: CloudsArgs): void => {
      debug.view = current.debug === 'off' ? null : current.debug
      slices.place.value = current.slice
      const output = current.noise ? slices.node : debug.view === null ? node : debug
      if (pipeline.outputNode === output) return
      pipeline.outputNode = output
      pipeline.needsUpdate = true
    }

    let lapse = args.timeLapse
    let before = performance.now()
    node.time = 0
    return {
      warmUpFrames: STILL.frames,
      place: placeOf,
      apply(current) {
        applyTime(renderer, air, current)
        applyLayer(current)
        applyStage(current)
        node.quality = qualityOf(current)
        show(current)
        lapse = current.frame ? 0 : current.timeLapse
      },
      beforeDraw() {
        const now = performance.now()
        node.time = (node.time ?? 0) + ((now - before) / 1000) * lapse
        before = now
        // The clouds' node draws its noise with the clouds.
        if (args.frame || pipeline.outputNode === slices.node) node.field.bake(renderer)
        props?.follow(camera)
      },
      dispose() {
        props?.dispose()
        node.dispose()
        cover?.dispose()
      }
    }
  })
  return Object.defineProperty(handle, 'onArgs', {
    set(value: typeof onArgs) {
      onArgs = value
    }
  })
}

/** Gives the same object as long as the arguments are the same. */
function placing(): (args: CloudsArgs) => Place {
  let latest: Place | undefined
  return ({ longitude, latitude, altitude, heading, pitch }) => {
    const place = { label: '', longitude, latitude, height: altitude, heading, pitch }
    if (JSON.stringify(place) !== JSON.stringify(latest)) latest = place
    return latest ?? place
  }
}

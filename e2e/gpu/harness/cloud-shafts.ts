import type { AirOccluder } from '@welkin/atmosphere'
import {
  cloudAirShadow,
  CloudLightTable,
  clouds,
  type CloudLayers,
  type CloudNoise,
  type CloudsNode,
  type CloudsOptions
} from '@welkin/clouds'
import { PerspectiveCamera } from 'three'
import { float, vec4 } from 'three/tsl'
import { RenderPipeline, type WebGPURenderer } from 'three/webgpu'
import { drawToFloat } from './atmosphere'
import { coarse } from './cloud-view'
import { nextFrame } from './graphics'
import { stageSize as size, type Stage } from './shaft-stage'

/** Clouds that are drawn for their shadow maps, by a camera of their own, and not seen. */
export async function unseenClouds(
  renderer: WebGPURenderer,
  { camera: { position }, atmosphere }: Stage,
  layers: CloudLayers,
  noise: CloudNoise,
  extinction?: CloudsOptions['extinction']
): Promise<{ node: CloudsNode; draw: () => Promise<void>; dispose: () => void }> {
  const light = new CloudLightTable()
  const camera = new PerspectiveCamera(60, 2, 1, 1e6)
  camera.position.copy(position)
  const node = clouds(vec4(0), float(1), camera, atmosphere, layers, {
    quality: coarse,
    noise,
    light,
    extinction
  })
  node.time = 0
  const pipeline = new RenderPipeline(renderer)
  pipeline.outputNode = node
  return {
    node,
    async draw() {
      camera.updateMatrixWorld()
      await nextFrame()
      await drawToFloat(renderer, () => pipeline.render())
    },
    dispose() {
      for (const owned of [node, pipeline, light, noise]) owned.dispose()
    }
  }
}

/** Clouds that take light scattered once alone, for which there are closed forms. */
export const castsOnce = (node: CloudsNode): AirOccluder => ({
  castInto(shafts) {
    const shadow = cloudAirShadow(node).castInto(shafts)
    return {
      get isCast() {
        return shadow.isCast
      },
      update: (view, renderer) => shadow.update?.(view, renderer),
      transmittance: ray => shadow.transmittance(ray),
      dispose: () => shadow.dispose?.()
    }
  }
})

/** Parts of the light of the middle of the picture that shafts take, at three wavelengths. */
export async function measuredLoss({ draw, shafts }: Stage): Promise<number[]> {
  const [x, y] = [size.width / 2, size.height / 2]
  shafts.enabled = true
  const shadowed = (await draw()).at(x, y)
  shafts.enabled = false
  const lit = (await draw()).at(x, y)
  return [0, 1, 2].map(k => (lit[k] - shadowed[k]) / shafts.source.irradiance.value.getComponent(k))
}

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
import { PerspectiveCamera, Vector3 } from 'three'
import { float, vec4 } from 'three/tsl'
import { RenderPipeline, type WebGPURenderer } from 'three/webgpu'
import { distanceToTop } from '../../../packages/atmosphere/src/air/cpu/boundary'
import { inScatter } from '../../../packages/atmosphere/src/scattering/cpu/scattering'
import { drawToFloat } from './atmosphere'
import { coarse, drawUnseen } from './cloud-view'
import { nextFrame } from './graphics'
import { parameters, type Stage } from './shaft-stage'

/** Size of pictures of which {@link measuredLoss} reads the middle alone. For clouds without noise: wide pixels blur it. */
export const raySize = { width: 16, height: 9 }

export const radians = (degrees: number): number => (degrees * Math.PI) / 180

/** Pieces of a ray whose lost light is summed in float64. */
const PIECES = 160

/** A view ray of the stage's camera, in the plane of sun and zenith. */
export interface North {
  /** Above the horizon in the north, where the sun is; beyond 90° it looks south [°]. */
  view: number
  sun: number
}

/** Light scattered once on a ray, all of it and what is lost where a part of the light does not arrive, in float64. */
export function marchedLoss(
  { view, sun }: North,
  distance: number,
  darkAt: (distance: number) => number,
  altitude = 2
): { whole: number[]; lost: number[] } {
  const air = parameters()
  const ray = {
    radius: air.bottomRadius + altitude,
    cosView: Math.sin(radians(view)),
    cosLight: Math.sin(radians(sun)),
    cosViewLight: Math.cos(radians(view - sun))
  }
  const end = Math.min(distance, distanceToTop(ray.radius, ray.cosView, air.topRadius))
  const lost = [0, 0, 0]
  let before = [0, 0, 0, 0]
  for (let i = 1; i <= PIECES; i++) {
    const at = (part: number): number => end * part ** 3
    const sum = inScatter(air, null, ray, at(i / PIECES))
    const dark = darkAt(at((i - 0.5) / PIECES))
    lost.forEach((_, k) => (lost[k] += dark * (sum[k] - before[k])))
    before = sum
  }
  return { whole: before, lost }
}

/** Has the stage's camera look north or south. */
export function lookAt({ camera }: Stage, view: number): void {
  camera.fov = 0.2
  camera.updateProjectionMatrix()
  camera.lookAt(
    new Vector3(0, Math.sin(radians(view)), -Math.cos(radians(view))).add(camera.position)
  )
}

/** Clouds that are drawn for their shadow maps, by a camera of their own, and not seen. */
export async function unseenClouds(
  renderer: WebGPURenderer,
  { camera: { position }, atmosphere }: Pick<Stage, 'camera' | 'atmosphere'>,
  layers: CloudLayers,
  noise: CloudNoise,
  extinction?: CloudsOptions['extinction'],
  precipitation?: CloudsOptions['precipitation']
): Promise<{ node: CloudsNode; draw: () => Promise<void>; dispose: () => void }> {
  const light = new CloudLightTable()
  const camera = new PerspectiveCamera(60, 2, 1, 1e6)
  const node = clouds(vec4(0), float(1), camera, atmosphere, layers, {
    quality: coarse,
    noise,
    light,
    extinction,
    precipitation
  })
  node.time = 0
  drawUnseen(node)
  const pipeline = new RenderPipeline(renderer)
  pipeline.outputNode = node
  return {
    node,
    async draw() {
      camera.position.copy(position)
      camera.updateMatrixWorld()
      await nextFrame()
      await drawToFloat(renderer, () => pipeline.render())
    },
    dispose() {
      for (const owned of [node, pipeline, light, noise]) owned.dispose()
    }
  }
}

/**
 * Clouds that take light scattered once alone, for which there are closed forms.
 *
 * @param hasRoom - True if they have room beside their shadows for what materials read.
 */
export const castsOnce = (node: CloudsNode, hasRoom = false): AirOccluder => ({
  castInto(shafts) {
    const shadow = cloudAirShadow(node).castInto(shafts)
    return {
      get isCast() {
        return shadow.isCast
      },
      update: (view, renderer) => shadow.update?.(view, renderer),
      transmittance: ray => shadow.transmittance(ray),
      ...(hasRoom && { makeRoom: () => shadow.makeRoom!() }),
      dispose: () => shadow.dispose?.()
    }
  }
})

/** Parts of the light of the middle of the picture that shafts take, at three wavelengths. */
export async function measuredLoss({ draw, shafts }: Stage): Promise<number[]> {
  const middle = async (enabled: boolean): Promise<number[]> => {
    shafts.enabled = enabled
    const picture = await draw()
    return picture.at(picture.width >> 1, picture.height >> 1)
  }
  const [shadowed, lit] = [await middle(true), await middle(false)]
  return [0, 1, 2].map(k => (lit[k] - shadowed[k]) / shafts.source.irradiance.value.getComponent(k))
}

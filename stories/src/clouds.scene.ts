import { aerialPerspective, Atmosphere } from '@welkin/atmosphere'
import { cloudPreset, clouds } from '@welkin/clouds'
import type { CloudPresetName, CloudQualityName, CloudsDebug, CloudsNode } from '@welkin/clouds'
import { MathUtils, PerspectiveCamera, Scene } from 'three'
import { pass } from 'three/tsl'
import { RenderPipeline } from 'three/webgpu'
import { createRenderer, dateOf, exposureOf } from './scene'
import type { RendererArgs, SceneHandle } from './scene'

export interface CloudsArgs extends RendererArgs {
  /** [degrees] */
  longitude: number
  /** [degrees] */
  latitude: number
  /** Of the camera above the ellipsoid [m]. */
  altitude: number
  /** Direction of view, from north, clockwise [degrees]. */
  heading: number
  /** Direction of view above the horizontal [degrees]. */
  pitch: number
  /** A moment of the day [ms since 1970]. */
  day: number
  /** Hour of that day, UTC [h]. */
  hour: number
  /** [stops], 0 for daylight. */
  exposure: number
  preset: CloudPresetName
  /** Of the lowest layer, in [0, 1]; −1 for the preset's. */
  coverage: number
  quality: CloudQualityName
  /** What is shown instead of the clouds. */
  debug: CloudsDebug | 'off'
}

/** Time of a reproducible frame [s], and frames that fill what pixels remember. */
const STILL = { time: 0, frames: 48 }

export async function createClouds(
  canvas: HTMLCanvasElement,
  args: CloudsArgs
): Promise<SceneHandle<CloudsArgs>> {
  const renderer = await createRenderer(canvas, args.forceWebGL)
  const scene = new Scene()
  const camera = new PerspectiveCamera(60, 1, 1, 1e9)
  // #region clouds
  const atmosphere = new Atmosphere()
  const scenePass = pass(scene, camera, { samples: 0 })
  const depth = scenePass.getTextureNode('depth')
  const air = aerialPerspective(scenePass.getTextureNode(), depth, camera, atmosphere)
  const pipeline = new RenderPipeline(renderer)
  const addClouds = (preset: CloudPresetName, quality: CloudQualityName): CloudsNode => {
    const node = clouds(air, depth, camera, atmosphere, cloudPreset(preset), { quality })
    pipeline.outputNode = node
    pipeline.needsUpdate = true
    return node
  }
  // #endregion
  const current = { ...args }
  let node: CloudsNode | undefined

  /** A node's layers are its own: another preset takes another node. */
  const choose = (): void => {
    node?.dispose()
    node = addClouds(current.preset, current.quality)
  }
  const apply = (): void => {
    atmosphere.place(current)
    atmosphere.date = dateOf(current.day, current.hour)
    renderer.toneMappingExposure = exposureOf(current.exposure)
    camera.position.set(0, current.altitude, 0)
    const [pitch, heading] = [current.pitch, current.heading].map(MathUtils.degToRad)
    camera.rotation.set(pitch, -heading, 0, 'YXZ')
    camera.updateMatrixWorld()
    if (node === undefined) return
    node.quality = current.quality
    node.debugView = current.debug === 'off' ? null : current.debug
    node.time = current.frame ? STILL.time : null
    const { coverage } = cloudPreset(current.preset).at(0).parameters
    node.field.layers.at(0).set({ coverage: current.coverage < 0 ? coverage : current.coverage })
  }
  choose()
  apply()

  let ready: Promise<void> = Promise.resolve()
  const settle = async (): Promise<void> => {
    for (let i = 0; i < STILL.frames; i++) {
      await new Promise(requestAnimationFrame)
      pipeline.render()
    }
  }
  return {
    renderer,
    scene,
    camera,
    get ready() {
      return ready
    },
    progress: 1,
    render: () => pipeline.render(),
    resize(width, height, pixelRatio) {
      renderer.setPixelRatio(pixelRatio)
      renderer.setSize(width, height, false)
      camera.aspect = width / height
      camera.updateProjectionMatrix()
      if (current.frame) ready = settle()
    },
    update(changes) {
      const { preset } = current
      Object.assign(current, changes)
      if (current.preset !== preset) choose()
      apply()
    },
    dispose() {
      pipeline.dispose()
      node?.dispose()
      scenePass.dispose()
      atmosphere.dispose()
      void renderer.dispose()
    }
  }
}

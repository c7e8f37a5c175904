import { aerialPerspective, aerialPerspectiveFog, skyBackground } from '@welkin/atmosphere'
import type { Atmosphere } from '@welkin/atmosphere'
import { FloatType, RenderTarget, Scene, type Camera } from 'three'
import { pass } from 'three/tsl'
import { RenderPipeline, type WebGPURenderer } from 'three/webgpu'
import { expectTrue } from './expect'
import { nextFrame } from './graphics'
import { readPicture, type Picture } from './picture'

/** Pseudo-random numbers in [0, 1), the same for the same seed. */
export function random(seed: number): () => number {
  let state = seed
  return () => {
    state = (state + 0x6d2b79f5) | 0
    let x = Math.imul(state ^ (state >>> 15), 1 | state)
    x = (x + Math.imul(x ^ (x >>> 7), 61 | x)) ^ x
    return ((x ^ (x >>> 14)) >>> 0) / 4294967296
  }
}

/** Draws with sky and haze in the scene's own materials. The renderer's canvas sets the size. */
export async function drawForward(
  renderer: WebGPURenderer,
  scene: Scene,
  camera: Camera,
  atmosphere: Atmosphere
): Promise<Picture> {
  const [background, fog] = [scene.backgroundNode, scene.fogNode]
  scene.backgroundNode ??= skyBackground(atmosphere)
  scene.fogNode ??= aerialPerspectiveFog(atmosphere)
  const picture = await drawToFloat(renderer, () => renderer.render(scene, camera))
  Object.assign(scene, { backgroundNode: background, fogNode: fog })
  return picture
}

/** A scene that keeps its sky and haze, which are else made and compiled anew for each picture. */
export function airScene(atmosphere: Atmosphere, scene = new Scene()): Scene {
  scene.backgroundNode = skyBackground(atmosphere)
  scene.fogNode = aerialPerspectiveFog(atmosphere)
  return scene
}

/** Draws with sky and haze as a post effect. */
export interface PostPath {
  /** Draws to the renderer's target or canvas; anew only in a new frame of the page. */
  render: () => void
  draw: () => Promise<Picture>
  /** Compiles it anew. */
  refresh: () => void
  dispose: () => void
}

export function postPath(
  renderer: WebGPURenderer,
  scene: Scene,
  camera: Camera,
  atmosphere: Atmosphere
): PostPath {
  const scenePass = pass(scene, camera, { samples: 0, type: FloatType })
  const pipeline = new RenderPipeline(renderer)
  pipeline.outputColorTransform = false
  pipeline.outputNode = aerialPerspective(
    scenePass.getTextureNode(),
    scenePass.getTextureNode('depth'),
    camera,
    atmosphere
  )
  return {
    render: () => pipeline.render(),
    async draw() {
      await nextFrame()
      return drawToFloat(renderer, () => pipeline.render())
    },
    refresh() {
      pipeline.needsUpdate = true
    },
    dispose() {
      scenePass.dispose()
      pipeline.dispose()
    }
  }
}

/** Draws to a float32 target of the canvas's size and reads it back. */
export async function drawToFloat(renderer: WebGPURenderer, draw: () => void): Promise<Picture> {
  const { width, height } = renderer.domElement
  const target = new RenderTarget(width, height, { type: FloatType })
  renderer.setRenderTarget(target)
  draw()
  renderer.setRenderTarget(null)
  const picture = await readPicture(renderer, target)
  target.dispose()
  return picture
}

/** Fails if a pixel is not finite, negative or above 1e6, which is more than the sun's disc has. */
export function expectLight({ width, data }: Picture, label: string): void {
  const wrong = data.findIndex(value => !(value >= 0 && value < 1e6))
  const [x, y] = [(wrong >> 2) % width, Math.floor(wrong / 4 / width)]
  expectTrue(wrong < 0, `${label}: channel ${wrong % 4} of pixel (${x}, ${y}) is ${data[wrong]}`)
}

/**
 * Differences between pixels, relative to their brightness, ascending; a thousandth of the brightest
 * pixel is added to each, below which no eye sees a difference.
 */
export function relativeDifferences(a: Picture, b: Picture): number[] {
  const brightness = ({ data }: Picture, i: number): number => data[i] + data[i + 1] + data[i + 2]
  let most = 0
  for (let i = 0; i < a.data.length; i += 4) most = Math.max(most, Math.min(brightness(a, i), 10))
  const differences: number[] = []
  for (let i = 0; i < a.data.length; i += 4) {
    const apart = [0, 1, 2].map(k => Math.abs(a.data[i + k] - b.data[i + k]))
    const scale = (brightness(a, i) + brightness(b, i)) / 2 + 1e-3 * most + 1e-9
    differences.push(Math.max(...apart) / scale)
  }
  return differences.toSorted((x, y) => x - y)
}

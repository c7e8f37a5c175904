import {
  Mesh,
  MeshStandardMaterial,
  OrthographicCamera,
  Scene,
  SphereGeometry,
  type Camera
} from 'three'
import type { WebGPURenderer } from 'three/webgpu'
import { drawToFloat } from './atmosphere'
import type { Picture } from './picture'

/** Luminance of a linear-sRGB colour. */
export const luminance = ([r, g, b]: readonly number[]): number =>
  0.2126 * r + 0.7152 * g + 0.0722 * b

/** A ball that fills the picture of a camera that looks along −Z, and what lights it. */
export function ballScene(roughness: number, metalness: number): { scene: Scene; camera: Camera } {
  const scene = new Scene()
  const material = new MeshStandardMaterial({ color: 0xffffff, roughness, metalness })
  scene.add(new Mesh(new SphereGeometry(1, 128, 96), material))
  const camera = new OrthographicCamera(-1, 1, 1, -1, 0.1, 10)
  camera.position.z = 3
  return { scene, camera }
}

/** Draws a frame to linear float32 pixels. */
export const draw = (renderer: WebGPURenderer, scene: Scene, camera: Camera): Promise<Picture> =>
  drawToFloat(renderer, () => renderer.render(scene, camera))

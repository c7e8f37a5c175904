import {
  AtmosphereParameters,
  AtmosphereShell,
  type AtmosphereShellOptions
} from '@welkin/atmosphere'
import {
  Mesh,
  MeshBasicMaterial,
  PerspectiveCamera,
  Scene,
  SphereGeometry,
  type Camera
} from 'three'
import type { WebGPURenderer } from 'three/webgpu'
import { drawToFloat } from './atmosphere'
import type { Picture } from './picture'

export const size = { width: 64, height: 36 }
export const RADIUS = new AtmosphereParameters().bottomRadius
export const luminance = ([r, g, b]: readonly number[]): number =>
  0.2126 * r + 0.7152 * g + 0.0722 * b

/** An Earth of some size with a shell, and nothing else. */
export function body(radius: number, options: AtmosphereShellOptions, color = 0x203040) {
  const scene = new Scene()
  const globe = new Mesh(new SphereGeometry(1, 256, 128), new MeshBasicMaterial({ color }))
  globe.scale.setScalar(radius)
  scene.add(globe)
  const shell = new AtmosphereShell(new AtmosphereParameters(), 1, options)
  globe.add(shell)
  return {
    scene,
    globe,
    shell,
    dispose: () => {
      shell.dispose()
      globe.geometry.dispose()
      globe.material.dispose()
    }
  }
}

export const draw = (renderer: WebGPURenderer, scene: Scene, camera: Camera): Promise<Picture> =>
  drawToFloat(renderer, () => renderer.render(scene, camera))

/** A camera some radii from the centre. */
export function cameraAt(
  distance: number,
  radius: number,
  pitch: number,
  fov = 50
): PerspectiveCamera {
  const camera = new PerspectiveCamera(fov, 64 / 36)
  camera.position.set(0, distance * radius, 0)
  camera.rotation.x = pitch
  camera.near = Math.max((distance - 1) * 0.3, 1e-7) * radius
  camera.far = 2 * distance * radius
  camera.updateProjectionMatrix()
  camera.updateMatrixWorld()
  return camera
}

/** [distance from the centre in radii, pitch] */
export const VIEWS = [
  [3, -Math.PI / 2],
  [1.06, -0.4],
  [1.0005, -0.02]
] as const

/** View of the air above the horizon, from outside it, with a telescope: as `FAR_VIEW`. */
export const LIMB_VIEW = [1.06, -0.32, 10] as const

/** View from so far that the air is marched, with a telescope: distance, azimuth, field of view [°]. */
export const FAR_VIEW = [25, -Math.PI / 2, 6] as const

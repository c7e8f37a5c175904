import { Matrix4, Vector3 } from 'three'
import type { SunDirectionalLight } from '@welkin/atmosphere'
import type { PerspectiveCamera } from 'three'

const MAP_SIZE = 2048
const SMALLEST = 150
const LARGEST = 15_000
/** Height above which no shadow is big enough to see [m]. */
const CEILING = 40_000

const forward = new Vector3()
const focus = new Vector3()
const axes = new Matrix4()
const right = new Vector3()
const top = new Vector3()
const centre = new Vector3()

/** Shadow settings that hold at any altitude; `aimShadow` adapts the rest every frame. */
export function prepareShadow(light: SunDirectionalLight): void {
  light.castShadow = true
  light.shadow.mapSize.setScalar(MAP_SIZE)
  light.shadow.radius = 1.5
}

/**
 * Fits the shadow map to the ground near the camera: the higher it flies, the more ground and the coarser.
 *
 * The map moves in whole texels, so that the edges of shadows stand still while the camera moves.
 *
 * @param altitude - Altitude of the camera above the ground [m].
 * @param upWorld - Away from the ground, unit vector.
 */
export function aimShadow(
  light: SunDirectionalLight,
  camera: PerspectiveCamera,
  altitude: number,
  upWorld: Vector3
): void {
  const extent = Math.min(SMALLEST + 4 * altitude, LARGEST)
  camera.getWorldDirection(forward)
  forward.addScaledVector(upWorld, -forward.dot(upWorld))
  focus
    .copy(camera.position)
    .addScaledVector(upWorld, -altitude)
    .addScaledVector(forward, extent * 0.7)
  axes
    .lookAt(light.atmosphere.sunDirection, centre.set(0, 0, 0), camera.up)
    .extractBasis(right, top, centre)
  const texel = (2 * extent) / MAP_SIZE
  for (const axis of [right, top]) {
    const along = focus.dot(axis)
    focus.addScaledVector(axis, Math.round(along / texel) * texel - along)
  }
  light.target.position.copy(focus)
  light.distance = extent * 2
  light.target.updateMatrixWorld()
  const { shadow } = light
  shadow.camera.left = shadow.camera.bottom = -extent
  shadow.camera.right = shadow.camera.top = extent
  shadow.camera.near = 0
  shadow.camera.far = extent * 4
  shadow.camera.updateProjectionMatrix()
  light.updateMatrixWorld()
  shadow.updateMatrices(light)
  shadow.normalBias = texel * 1.5
  shadow.bias = 0
  shadow.intensity = altitude < CEILING ? 1 : 0
  shadow.autoUpdate = altitude < CEILING
}

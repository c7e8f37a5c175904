import { Matrix3, Matrix4, Vector2, Vector3 } from 'three'
import type { Camera } from 'three'
import { uniform } from 'three/tsl'
import type { NodeFrame } from 'three/webgpu'

const _worldToBody = new Matrix4()
const _size = new Vector2()

/** Camera and sun as a shell's shader sees them. The mapped space is the body's, in metres. */
export class ShellUniforms {
  /** Height of the camera above the ground, which may be negative [m]. */
  readonly height = uniform(0)
  /** Zenith at the camera, mapped space. */
  readonly up = uniform(new Vector3())
  /** Direction to the sun, mapped space, unit length. */
  readonly sunDirectionMapped = uniform(new Vector3())
  /** Displacements in view space [world units] to the mapped space [m]. */
  readonly viewToMapped = uniform(new Matrix3())
  /** Factors of linear sRGB on scattered light. */
  readonly tint = uniform(new Vector3(1, 1, 1))
  /** Half the diagonal of a pixel: angle for a perspective camera [rad], length for an orthographic one [m]. */
  readonly pixel = uniform(new Vector2())

  /**
   * Sets the camera's place.
   *
   * @param bodyToWorld - The shell's world matrix.
   * @param bottomRadius - Planet's centre to the ground [m].
   * @param scale - Metres per unit of the body.
   */
  setCamera(
    renderer: NonNullable<NodeFrame['renderer']>,
    camera: Camera,
    bodyToWorld: Matrix4,
    bottomRadius: number,
    scale: number
  ): void {
    _worldToBody.copy(bodyToWorld).invert()
    const up = this.up.value.setFromMatrixPosition(camera.matrixWorld)
    up.applyMatrix4(_worldToBody).multiplyScalar(scale)
    const radius = up.length()
    this.height.value = radius - bottomRadius
    if (radius > 0) up.divideScalar(radius)
    else up.set(0, 0, 1)
    this.viewToMapped.value.setFromMatrix4(_worldToBody.multiply(camera.matrixWorld))
    this.viewToMapped.value.multiplyScalar(scale)
    const rows = renderer.getRenderTarget()?.height ?? renderer.getDrawingBufferSize(_size).y
    const pixel = Math.SQRT2 / (camera.projectionMatrix.elements[5] * rows)
    const [x, y, z] = this.viewToMapped.value.elements
    if (isOrthographic(camera)) this.pixel.value.set(0, pixel * Math.hypot(x, y, z))
    else this.pixel.value.set(pixel, 0)
  }

  /**
   * Sets the direction to the sun.
   *
   * @param directionWorld - Direction to the sun, of any length; taken for +Y if zero.
   */
  setSun(directionWorld: Vector3, bodyToWorld: Matrix4): void {
    const direction = this.sunDirectionMapped.value.copy(directionWorld)
    direction.transformDirection(_worldToBody.copy(bodyToWorld).invert())
    if (!(direction.lengthSq() > 0)) direction.set(0, 1, 0)
  }
}

/** Parallel view rays, which do not start at the camera's position. */
export const isOrthographic = (camera: Camera): boolean =>
  camera.projectionMatrixInverse.elements[11] === 0

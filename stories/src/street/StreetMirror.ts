import {
  HalfFloatType,
  LinearMipmapLinearFilter,
  PerspectiveCamera,
  Quaternion,
  RenderTarget,
  Vector2,
  Vector3
} from 'three'
import type { Object3D, Scene, Camera } from 'three'
import {
  float,
  mix,
  normalView,
  normalViewGeometry,
  roughness,
  screenUV,
  texture,
  vec2,
  vec4
} from 'three/tsl'
import type { Node, WebGPURenderer } from 'three/webgpu'

/** Layer of what is not mirrored: the ground, and lamps, whose highlights three's lights make. */
const NOT_MIRRORED = 1
/** Size of the mirrored picture over the canvas. */
const SCALE = 0.5
/** Reads along the vertical: rough ground seen at a low angle draws lights out into streaks. */
const READS = 6
/** Half the length of a streak, and its blur, over the roughness' square [–, pixels]. */
const STREAK = 5
const BLUR = 300
/** Shift of the picture by waves, over their slope [–]. */
const WAVES = 0.3
/** Roughness of dry ground, in which nothing is mirrored. */
const DRY = 0.8

const _size = new Vector2()
const _rotation = new Quaternion()
const _halfTurn = new Quaternion(0, 0, 1, 0)
const _scale = new Vector3()

/** Mirror in wet ground at height 0: the scene again, seen from as far below. */
export class StreetMirror {
  readonly #camera = new PerspectiveCamera()
  readonly #target = new RenderTarget(1, 1, {
    type: HalfFloatType,
    minFilter: LinearMipmapLinearFilter,
    generateMipmaps: true
  })

  /** Leaves objects out of the mirror; cameras see them. */
  leaveOut(camera: Camera, ...objects: readonly Object3D[]): void {
    camera.layers.enable(NOT_MIRRORED)
    for (const object of objects) object.layers.set(NOT_MIRRORED)
  }

  /**
   * Light that ground mirrors, as an `envNode` of its material: the same that comes diffusely, which is less before walls than under the sky.
   *
   * @param sky - Luminance where nothing stands.
   */
  environment(sky: Node<'vec3'>): Node<'vec3'> {
    const alpha = roughness.mul(roughness)
    const waves = normalView.sub(normalViewGeometry).xy.mul(WAVES)
    const uv = screenUV.flipX().add(waves)
    const level = alpha.mul(BLUR).add(1).log2()
    let sum: Node<'vec4'> = vec4(0)
    for (let i = 0; i < READS; i++) {
      const aside = alpha.mul((STREAK * (2 * i + 1 - READS)) / READS)
      sum = sum.add(texture(this.#target.texture, uv.add(vec2(0, aside))).level(level))
    }
    const mirrored = sum.div(READS)
    const all = mirrored.rgb.add(sky.mul(float(1).sub(mirrored.a)))
    return mix(all, sky, roughness.div(DRY).clamp())
  }

  /** Draws the mirrored picture: to be called before that of the camera. */
  render(renderer: WebGPURenderer, scene: Scene, camera: PerspectiveCamera): void {
    const mirrored = this.#camera
    const { fov, aspect, near, far } = camera
    Object.assign(mirrored, { fov, aspect, near, far }).updateProjectionMatrix()
    camera.updateMatrixWorld()
    camera.matrixWorld.decompose(mirrored.position, _rotation, _scale)
    mirrored.position.y *= -1
    // A mirrored camera would be left-handed: it is turned about its axis, and its picture read from right to left.
    const { x, y, z, w } = _rotation
    mirrored.quaternion.set(-x, y, -z, w).multiply(_halfTurn)
    mirrored.updateMatrixWorld()
    const before = renderer.getRenderTarget()
    const { width, height } = before ?? renderer.getDrawingBufferSize(_size)
    this.#target.setSize(Math.ceil(width * SCALE), Math.ceil(height * SCALE))
    renderer.setRenderTarget(this.#target)
    renderer.render(scene, mirrored)
    renderer.setRenderTarget(before)
  }

  dispose(): void {
    this.#target.dispose()
  }
}

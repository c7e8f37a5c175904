import { Object3D } from 'three'
import type { Camera } from 'three'
import {
  float,
  mix,
  normalView,
  normalViewGeometry,
  reflector,
  roughness,
  screenUV,
  vec2,
  vec4
} from 'three/tsl'
import type { Node } from 'three/webgpu'

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

/** Mirror in wet ground at height 0: three's `reflector`, read as rough ground draws it out. */
export class StreetMirror {
  readonly #picture = reflector({
    target: new Object3D().rotateX(-Math.PI / 2), // its z-axis is the plane's normal
    resolutionScale: SCALE,
    generateMipmaps: true
  })

  constructor() {
    this.#picture.target.updateMatrixWorld()
  }

  /** Leaves objects out of the mirror; the camera sees them. */
  leaveOut(camera: Camera, ...objects: readonly Object3D[]): void {
    for (const object of objects) object.layers.set(NOT_MIRRORED)
    this.#picture.reflector.getVirtualCamera(camera).layers.disable(NOT_MIRRORED)
    camera.layers.enable(NOT_MIRRORED)
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
      sum = sum.add(this.#picture.sample(uv.add(vec2(0, aside))).level(level))
    }
    const mirrored = sum.div(READS)
    const all = mirrored.rgb.add(sky.mul(float(1).sub(mirrored.a)))
    return mix(all, sky, roughness.div(DRY).clamp())
  }

  dispose(): void {
    this.#picture.dispose()
  }
}

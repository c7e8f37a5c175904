import type { Camera, OrthographicCamera } from 'three'
import {
  Fn,
  If,
  float,
  getViewPosition,
  isBackgroundDepth,
  uniform,
  uv,
  vec3,
  vec4
} from 'three/tsl'
import type { Node, NodeBuilder } from 'three/webgpu'
import { checkPostEffect } from '../check'
import type { Atmosphere } from '../Atmosphere'
import { AtmosphereNode } from '../view/AtmosphereNode'
import type { SkyLayer, SkyRay } from '../view/SkyLayer'
import type { Stars } from './Stars'
import { linearSRGB } from '../air/tsl/color'
import { pixelAngle } from '../sky/tsl/sky'
import { aimAt, rayTargets, skyTransmittance } from '../skyVolume/tsl/skyVolume'
import type { Float, Vec3, Vec4 } from '../tsl-types'

const isOverlay = (layer: SkyLayer): layer is Stars =>
  (layer as Partial<Stars>).isStars === true && (layer as Stars).overlay

/**
 * Adds the stars after post-processing, so that depth of field, bloom and temporal anti-aliasing leave
 * them the points that they are.
 *
 * ```ts
 * atmosphere.add(milkyWay(), stars({ overlay: true }))
 * const finished = bloom(…)
 * pipeline.outputNode = starsOverlay(finished, scenePass.getTextureNode('depth'), camera, atmosphere)
 * ```
 *
 * Draws the layers that were made with `overlay: true`, which the sky leaves out, where the depth says
 * that nothing was drawn; layers that were added after them, such as a moon, hide them. It is in the
 * pipeline's output that stars are as crisp as its pixels are, whatever the scene's own resolution. The
 * colour must be linear: tone mapping comes after. Does not jitter with temporal anti-aliasing as long
 * as that takes its offset off the camera again, as three's does.
 */
export class StarsOverlayNode extends AtmosphereNode {
  static get type(): string {
    return 'StarsOverlayNode'
  }

  /** The finished picture: linear colour. */
  colorNode: Node
  /** The scene's depth, as the renderer writes it. */
  depthNode: Node
  /** The camera that drew the scene. */
  readonly camera: Camera
  readonly #projectionInverse

  /** @throws If an argument is missing. */
  constructor(colorNode: Node, depthNode: Node, camera: Camera, atmosphere: Atmosphere) {
    super(atmosphere, camera)
    checkPostEffect('StarsOverlayNode', colorNode, depthNode, camera)
    this.colorNode = colorNode
    this.depthNode = depthNode
    this.camera = camera
    this.#projectionInverse = uniform(camera.projectionMatrixInverse)
  }

  override setup(_builder: NodeBuilder): Node {
    // Parallel lines of sight all end at one point of the sky: there is no field of stars.
    if ((this.camera as OrthographicCamera).isOrthographicCamera)
      return vec4(this.colorNode as Vec4)
    return Fn(() => {
      const color = vec4(this.colorNode as Vec4).toConst()
      const depth = float((this.depthNode as Vec4).r).toConst()
      const rayView = getViewPosition(uv(), float(0.5), this.#projectionInverse).toConst() as Vec3
      const direction = this.view.toMapped(rayView).normalize().toConst() as Vec3
      const pixel = pixelAngle(direction)
      const added = vec3(0).toVar()
      If(isBackgroundDepth(depth), () => {
        const { uniforms } = this.view.air
        const { volume, eye } = this.view
        const cosView = direction.dot(this.view.up).clamp(-1, 1).toConst() as Float
        const cosViewSun = direction.dot(this.view.sunDirection).clamp(-1, 1).toConst() as Float
        const { hitsGround, meetsAir } = rayTargets(eye, cosView)
        // What is overlaid is asked for its light itself, which no air hides.
        const airlight = vec4(0) as Vec4
        const aim = aimAt(eye, cosView, hitsGround)
        const angles = { direction, cosViewSun, meetsAir, ...aim }
        const ray = { view: this.view, ...angles, pixel, airlight }
        If(hitsGround.not(), () => {
          const through = skyTransmittance(volume, eye, aim)
          added.assign(linearSRGB(uniforms, this.#light(ray).mul(through)))
        })
      })
      return vec4(color.rgb.add(added), color.a)
    })()
  }

  /** Light of the stars that nothing nearer hides. */
  #light(ray: SkyRay): Vec4 {
    let [light, without] = [vec4(0) as Vec4, vec4(0) as Vec4]
    for (const layer of this.atmosphere.layers) {
      if (isOverlay(layer)) {
        light = light.add(layer.light(ray)).toConst()
      } else if (layer.isAdditive !== true && layer.beyond !== undefined) {
        ;[light, without] = [layer.beyond(ray, light), layer.beyond(ray, without)]
      }
    }
    return vec4(light.sub(without).max(0))
  }
}

/** Adds the stars after post-processing: see {@link StarsOverlayNode}. */
export const starsOverlay = (
  color: Node,
  depth: Node,
  camera: Camera,
  atmosphere: Atmosphere
): StarsOverlayNode => new StarsOverlayNode(color, depth, camera, atmosphere)

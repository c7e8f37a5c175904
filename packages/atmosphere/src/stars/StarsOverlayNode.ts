import { checkOptions, fail } from '@welkin/geo'
import type { Camera, OrthographicCamera } from 'three'
import { Fn, If, float, getViewPosition, isBackgroundDepth, uv, vec3, vec4 } from 'three/tsl'
import type { Node, NodeBuilder } from 'three/webgpu'
import type { Atmosphere } from '../Atmosphere'
import { PostEffectNode } from '../view/PostEffectNode'
import type { SkyLayer, SkyRay } from '../view/SkyLayer'
import type { Stars } from './Stars'
import { linearSRGB } from '../air/tsl/color'
import { withMedia } from '../sky/tsl/aerialPerspective'
import { pixelAngle } from '../sky/tsl/sky'
import { skyTransmittance } from '../skyVolume/tsl/meanExtinction'
import { viewRay } from '../skyVolume/tsl/viewRay'
import { rayTargets } from '../skyVolume/tsl/rayLimits'
import type { Float, Vec3, Vec4 } from '../tsl-types'

const isOverlay = (layer: SkyLayer): layer is Stars =>
  (layer as Partial<Stars>).isStars === true && (layer as Stars).overlay

/** Options of {@link starsOverlay}. */
export interface StarsOverlayOptions {
  /**
   * Part of the light from afar that passes what was drawn over the sky without depth, in [0, 1]: a float
   * per pixel of the screen, such as the clouds' `cloudsNode.transmittance`.
   * Left out, nothing is in the way.
   */
  transmittance?: Node
}

/**
 * Draws the stars after post-processing, so that depth of field, bloom and temporal anti-aliasing leave
 * them points.
 *
 * ```ts
 * atmosphere.add(milkyWay(), stars({ overlay: true }))
 * const finished = bloom(…)
 * pipeline.outputNode = starsOverlay(finished, scenePass.getTextureNode('depth'), camera, atmosphere)
 * ```
 *
 * Air and fog dim them; clouds that were drawn before do, too, where `transmittance` is theirs.
 *
 * Layers made with `overlay: true`, which the sky leaves out, are drawn where the depth is that of the
 * background. Layers added after them, such as a moon, hide them. Put it into the pipeline's output: stars
 * are then as crisp as its pixels, whatever the scene's own resolution. The colour must be linear; tone
 * mapping comes after. Stars do not jitter with temporal anti-aliasing, as long as that takes its offset
 * off the camera again, as three's does.
 */
export class StarsOverlayNode extends PostEffectNode {
  static get type(): string {
    return 'StarsOverlayNode'
  }

  /** Part of the light from afar that passes what was drawn over the sky: see {@link StarsOverlayOptions}. */
  readonly transmittanceNode: Node | null

  /** @throws If an argument is missing or of the wrong kind. */
  constructor(
    color: Node,
    depth: Node,
    camera: Camera,
    atmosphere: Atmosphere,
    options: StarsOverlayOptions = {}
  ) {
    super(color, depth, camera, atmosphere)
    checkOptions('StarsOverlayNode', options, 'transmittance')
    const { transmittance = null } = options
    if (transmittance !== null && !transmittance.isNode) {
      fail('StarsOverlayNode', 'transmittance must be a node', transmittance)
    }
    this.transmittanceNode = transmittance
  }

  override setup(_builder: NodeBuilder): Node {
    // Parallel view rays all end at one point of the sky: there is no field of stars.
    if ((this.camera as OrthographicCamera).isOrthographicCamera)
      return vec4(this.colorNode as Vec4)
    return Fn(() => {
      const color = vec4(this.colorNode as Vec4).toConst()
      const depth = float((this.depthNode as Vec4).r).toConst()
      const rayView = getViewPosition(uv(), float(0.5), this._projectionInverse).toConst() as Vec3
      const direction = this.view.toMapped(rayView).normalize().toConst() as Vec3
      const pixel = pixelAngle(direction)
      const added = vec3(0).toVar()
      If(isBackgroundDepth(depth), () => {
        const { uniforms } = this.view.air
        const { volume, viewpoint } = this.view
        const cosView = direction.dot(this.view.up).clamp(-1, 1).toConst() as Float
        const cosViewLight = direction.dot(this.view.lightDirection).clamp(-1, 1).toConst() as Float
        const { hitsGround, meetsAir } = rayTargets(viewpoint, cosView)
        // `airlight` 0: overlaid layers are never masked by the sky here.
        const airlight = vec4(0) as Vec4
        const volumeRay = viewRay(viewpoint, cosView, hitsGround)
        const angles = { direction, cosViewLight, meetsAir, ...volumeRay }
        const ray = { view: this.view, ...angles, pixel, airlight }
        If(hitsGround.not(), () => {
          const { layers } = this.atmosphere
          const media = withMedia(layers, ray, { depth: vec4(0), radiance: vec4(0) })
          const through = skyTransmittance(volume, viewpoint, volumeRay).mul(
            media.depth.negate().exp()
          )
          const light = linearSRGB(uniforms, this.#light(ray).mul(through))
          const seen = this.transmittanceNode as Float | null
          added.assign(seen === null ? light : light.mul(seen))
        })
      })
      return vec4(color.rgb.add(added), color.a)
    })()
  }

  /** Radiance of the stars that no nearer layer hides [1/sr]. */
  #light(ray: SkyRay): Vec4 {
    // The difference of two skies, with and without stars, holds what nearer layers leave of them.
    let [withStars, without] = [vec4(0) as Vec4, vec4(0) as Vec4]
    for (const layer of this.atmosphere.layers) {
      if (isOverlay(layer)) {
        withStars = withStars.add(layer.light(ray)).toConst()
      } else if (layer.isAdditive !== true && layer.background !== undefined) {
        ;[withStars, without] = [layer.background(ray, withStars), layer.background(ray, without)]
      }
    }
    return vec4(withStars.sub(without).max(0))
  }
}

/** Stars drawn after post-processing: see {@link StarsOverlayNode}. */
export const starsOverlay = (
  color: Node,
  depth: Node,
  camera: Camera,
  atmosphere: Atmosphere,
  options: StarsOverlayOptions = {}
): StarsOverlayNode => new StarsOverlayNode(color, depth, camera, atmosphere, options)

import type { Texture } from 'three'
import { normalWorld, pmremTexture, vec3 } from 'three/tsl'
import { Node } from 'three/webgpu'
import type { NodeBuilder } from 'three/webgpu'
import { checkBoolean, checkOptions, fail } from '@welkin/geo'
import { getOrMake } from '../view/getOrMake'

/** Options of {@link ImageEnvironmentNode} and `SkyEnvironmentNode`. */
export interface EnvironmentOptions {
  /**
   * Lights matte surfaces too, besides being mirrored. By default it does, unless a
   * `SkyLightProbe` lights the scene: their light must not count twice.
   */
  diffuse?: boolean
}

/**
 * A picture of a sky as what materials mirror, in place of an atmosphere's.
 *
 * ```ts
 * scene.environmentNode = imageEnvironment(await new HDRLoader().loadAsync('sky.hdr'))
 * ```
 */
export class ImageEnvironmentNode extends Node<'vec3'> {
  static get type(): string {
    return 'ImageEnvironmentNode'
  }

  /** Equirectangular, a cube, or filtered already. Shared, not owned. */
  readonly image: Texture
  /** See {@link EnvironmentOptions}; null for what suits the scene's lights. */
  readonly diffuse: boolean | null

  /** @throws If it is no texture, or an option is of the wrong kind. */
  constructor(image: Texture, options: EnvironmentOptions = {}) {
    super('vec3')
    if (!image?.isTexture) fail('ImageEnvironmentNode', 'image must be a Texture', image)
    const { diffuse } = checkOptions('ImageEnvironmentNode', options, 'diffuse')
    if (diffuse !== undefined) checkBoolean('ImageEnvironmentNode', 'diffuse', diffuse)
    this.image = image
    this.diffuse = diffuse ?? null
  }

  override setup(builder: NodeBuilder): Node {
    const map = getOrMake(maps, this.image, () => pmremTexture(this.image))
    return mirrored(builder, map, this.diffuse)
  }
}

const maps = new WeakMap<Texture, Node>()

/** Look-up of a material in a map: by roughness what it mirrors, or light from all around. */
export function mirrored(builder: NodeBuilder, map: Node, diffuse: boolean | null): Node {
  const { context, lightsNode } = builder as unknown as {
    context: { getUV?: (node: Node, builder: NodeBuilder) => unknown }
    lightsNode: { getLights?: () => object[] } | null
  }
  // For light on matte surfaces three looks the map up by the normal, not by the mirrored ray.
  if (context.getUV?.(map, builder) !== normalWorld) return map
  const lights = lightsNode?.getLights?.() ?? []
  const hasProbe = lights.some(light => 'isLightProbe' in light && 'atmosphere' in light)
  return (diffuse ?? !hasProbe) ? map : vec3(0)
}

/** A picture of a sky as what materials mirror: see {@link ImageEnvironmentNode}. */
export const imageEnvironment = (
  image: Texture,
  options?: EnvironmentOptions
): ImageEnvironmentNode => new ImageEnvironmentNode(image, options)

import type { Material, Texture } from 'three'
import { Node, NodeUpdateType, TextureNode } from 'three/webgpu'
import type { NodeBuilder, Renderer } from 'three/webgpu'
import { fail } from '@welkin/geo'

const _features = new WeakMap<Texture, string>()
const _limited = new WeakSet<NodeBuilder>()

/** Names the feature that a user's texture was given to in errors about too many textures. */
export function nameTexture(texture: Texture, feature: string): void {
  _features.set(texture, feature)
}

/** Textures that a fragment shader may sample. */
function mostTextures({ backend }: Renderer): number {
  const { device, gl } = backend as { device?: GPUDevice; gl?: WebGL2RenderingContext }
  return (
    device?.limits.maxSampledTexturesPerShaderStage ??
    (gl!.getParameter(gl!.MAX_TEXTURE_IMAGE_UNITS) as number)
  )
}

/** @throws If the fragment shader samples more textures than may be: names what samples them, the most first. */
function checkTextures({ uniforms, material, renderer }: BuiltShader): void {
  const textures = uniforms.fragment
    .map(({ node }) => node.value as Texture | null)
    .filter(value => value?.isTexture === true) as Texture[]
  const most = mostTextures(renderer)
  if (textures.length <= most) return
  const maps = Object.values(material)
  const counts: Record<string, number> = {}
  for (const texture of textures) {
    const own = maps.includes(texture) ? 'maps of the material' : texture.name || 'unnamed'
    const feature = _features.get(texture) ?? /^Welkin\.(\w+)/.exec(own)?.[1] ?? own
    counts[feature] = (counts[feature] ?? 0) + 1
  }
  const list = Object.entries(counts)
    .toSorted(([, a], [, b]) => b - a)
    .map(([feature, count]) => `${feature} ${count}`)
  fail(
    'Atmosphere',
    `${material.name || material.type} must sample at most ${most} textures, leave out some of: ${list.join(', ')}`,
    textures.length
  )
}

/** A NodeBuilder with what its types lack. */
type BuiltShader = NodeBuilder & {
  uniforms: { fragment: { node: { value: unknown } }[] }
  material: Material
  addSequentialNode(node: Node): void
}

/** Node that throws as an object is drawn, before three makes a pipeline of its shader, which would draw black. */
function textureLimit(builder: BuiltShader): Node {
  let unchecked: BuiltShader | null = builder
  return Object.assign(new Node(), {
    updateBeforeType: NodeUpdateType.OBJECT,
    updateBefore: () => {
      if (unchecked !== null) checkTextures(unchecked)
      unchecked = null
    }
  })
}

/** Texture that every shader of an atmosphere samples: has drawing throw where a shader samples too many. */
export class AtlasTexture extends TextureNode {
  override setup(builder: NodeBuilder): undefined {
    if (!_limited.has(builder)) {
      _limited.add(builder)
      // Its turn comes when the shader is complete: that three catches what is thrown while it builds one.
      const built = builder as BuiltShader
      built.addSequentialNode(textureLimit(built))
    }
    super.setup(builder)
  }
}

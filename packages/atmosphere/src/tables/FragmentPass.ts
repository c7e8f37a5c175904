import { HalfFloatType, LinearFilter, NoBlending, RenderTarget } from 'three'
import type { TextureFilter, NearestFilter } from 'three'
import { Fn, outputStruct, property, vec4 } from 'three/tsl'
import { NodeMaterial, QuadMesh, RendererUtils } from 'three/webgpu'
import type { Node, Renderer } from 'three/webgpu'
import type { Vec4 } from '../tsl-types'

/** A half-float render target for a table: no depth buffer, no mipmaps. */
export function tableTarget(
  name: string,
  width: number,
  height: number,
  count = 1,
  filter: TextureFilter = LinearFilter
): RenderTarget {
  const target = new RenderTarget(width, height, {
    count,
    type: HalfFloatType,
    depthBuffer: false,
    minFilter: filter as typeof NearestFilter,
    magFilter: filter as typeof NearestFilter
  })
  target.textures.forEach((texture, i) => {
    texture.name = `${name}.${i}`
  })
  return target
}

/** A shader with several outputs: `color` assigns the properties that `output` is a struct of. */
export interface Outputs {
  /** Colour of the material: building it assigns the outputs. */
  color: Vec4
  /** Struct of the outputs. */
  output: Node
}

/**
 * A shader with several outputs, for a target with as many textures.
 *
 * @param assign - Its body, which assigns all of them.
 */
export function outputs<T extends Vec4[]>(
  count: T['length'],
  assign: (outputs: T) => void
): Outputs {
  const all = Array.from({ length: count }, () => property('vec4') as unknown as Vec4)
  const body = Fn(() => {
    assign(all as T)
    return vec4(0)
  })
  return { color: body(), output: outputStruct(...all) }
}

/** A fragment shader that fills a render target. */
export class FragmentPass {
  readonly material: NodeMaterial
  readonly #quad: QuadMesh

  /**
   * @param name - Name of the pass in a graphics debugger.
   * @param output - Value of a texel, or several of them by {@link outputs}.
   */
  constructor(name: string, output: Vec4 | Outputs) {
    this.material = Object.assign(new NodeMaterial(), {
      name,
      // Nothing is blended; but three's ambient occlusion is that of opaque materials, whatever they draw.
      transparent: true,
      blending: NoBlending,
      depthTest: false,
      depthWrite: false,
      toneMapped: false,
      fog: false
    })
    if ('color' in output) {
      this.material.colorNode = output.color
      this.material.outputNode = output.output as never
    } else {
      this.material.fragmentNode = output
    }
    this.#quad = new QuadMesh(this.material)
    this.#quad.name = name
  }

  /**
   * Draws into the target; the renderer is left as it was. Texels that the shader discards keep.
   *
   * @param slice - Slice of a 3-D target.
   * @param level - Level of detail of the target.
   */
  render(renderer: Renderer, target: RenderTarget, slice = 0, level = 0): void {
    const state = RendererUtils.resetRendererState(renderer, {} as never)
    renderer.autoClear = false
    renderer.setRenderTarget(target, slice, level)
    this.#quad.render(renderer)
    RendererUtils.restoreRendererState(renderer, state)
  }

  /** Frees the material's pipeline. */
  dispose(): void {
    this.material.dispose()
  }
}

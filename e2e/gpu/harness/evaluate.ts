import { DataTexture, FloatType, NearestFilter, RenderTarget, RGBAFormat } from 'three'
import { Fn, int, ivec2, screenCoordinate, textureLoad, vec4 } from 'three/tsl'
import { NodeMaterial, QuadMesh, type Node, type WebGPURenderer } from 'three/webgpu'
import { readPicture } from './picture'

/** Rows of this many texels: small, and wide enough that padding and row order are exercised. */
const columns = 64

/**
 * Runs a shader function once per row of inputs and reads its results back.
 *
 * @param inputs - One array of up to 4 numbers per call; the shader sees them as a vec4.
 * @param body - Builds the function; answers with a float, vec2, vec3 or vec4 node.
 * @returns Four numbers per input (missing components as three's `vec4()` fills them).
 */
export async function evaluateOnGpu(
  renderer: WebGPURenderer,
  inputs: readonly (readonly number[])[],
  body: (input: Node<'vec4'>) => Node
): Promise<Float32Array> {
  const rows = Math.ceil(inputs.length / columns)
  const texels = new Float32Array(4 * columns * rows)
  inputs.forEach((input, i) => texels.set(input, 4 * i))
  const source = new DataTexture(texels, columns, rows, RGBAFormat, FloatType)
  source.minFilter = source.magFilter = NearestFilter
  source.needsUpdate = true

  const target = new RenderTarget(columns, rows, {
    type: FloatType,
    minFilter: NearestFilter,
    magFilter: NearestFilter,
    depthBuffer: false
  })
  const material = new NodeMaterial()
  material.fragmentNode = Fn(() => {
    const pixel = ivec2(int(screenCoordinate.x), int(screenCoordinate.y))
    return vec4(body(textureLoad(source, pixel)) as Node<'vec4'>)
  })()
  const quad = new QuadMesh(material)
  const previous = renderer.getRenderTarget()
  renderer.setRenderTarget(target)
  quad.render(renderer)
  renderer.setRenderTarget(previous)
  const { data } = await readPicture(renderer, target)
  source.dispose()
  target.dispose()
  material.dispose()
  return data.slice(0, 4 * inputs.length)
}

import type { WebGPURenderer } from 'three/webgpu'
import { shaderStats, type ShaderStats } from '../../harness/shader-stats'

/** A fragment shader that a renderer has made. */
export interface FragmentShader extends ShaderStats {
  /** Name of the material that it was first made for; often empty. */
  readonly name: string
  readonly source: string
}

/** Shader as three hands it to its backend, for either graphics API. */
interface Program {
  readonly stage: string
  readonly code: string
  readonly name: string
}

/** Lists the fragment shaders that a renderer makes from now on, whichever its graphics API. */
export function watchFragmentShaders(renderer: WebGPURenderer): readonly FragmentShader[] {
  const backend = renderer.backend as unknown as { createProgram(program: Program): void }
  const createProgram = backend.createProgram.bind(backend)
  const shaders: FragmentShader[] = []
  backend.createProgram = program => {
    createProgram(program)
    const { stage, code, name } = program
    if (stage === 'fragment') shaders.push({ name, source: code, ...shaderStats(code) })
  }
  return shaders
}

import type { WebGPURenderer } from 'three/webgpu'
import { shaderStats, type ShaderStats } from '../../harness/shader-stats'

/** A shader that a renderer has made, of one stage. */
export interface Shader extends ShaderStats {
  readonly stage: 'vertex' | 'fragment' | 'compute'
  /** Name of the material that it was first made for; often empty. */
  readonly name: string
  readonly source: string
}

/** Shader as three hands it to its backend, for either graphics API. */
interface Program {
  readonly stage: Shader['stage']
  readonly code: string
  readonly name: string
}

/** Lists the shaders of all stages that a renderer makes from now on, whichever its graphics API. */
export function watchShaders(renderer: WebGPURenderer): readonly Shader[] {
  const backend = renderer.backend as unknown as { createProgram(program: Program): void }
  const createProgram = backend.createProgram.bind(backend)
  const shaders: Shader[] = []
  backend.createProgram = program => {
    createProgram(program)
    const { stage, code, name } = program
    shaders.push({ stage, name, source: code, ...shaderStats(code) })
  }
  return shaders
}

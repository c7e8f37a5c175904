import type { WebGPURenderer } from 'three/webgpu'
import { shaderStats, type ShaderStats } from '../harness/shader-stats'

/** A pipeline that a renderer made for a material. */
export interface BuiltPipeline {
  /** Name of the material. */
  name: string
  vertex: ShaderStats
  fragment: ShaderStats
  /** Source of the fragment shader. */
  source: string
  /** Time from nothing to a compiled pipeline: generating the shader, and compiling it; wall-clock [ms]. */
  ms: number
}

interface RenderObject {
  material: { name: string; type: string }
  getNodeBuilderState(): { vertexShader: string; fragmentShader: string }
}

/** Internals of three: where shaders are generated, and where pipelines are compiled. */
interface Internals {
  _nodes: { getForRender(object: RenderObject, ...rest: unknown[]): unknown }
  _pipelines: { getForRender(object: RenderObject, ...rest: unknown[]): unknown }
  backend: { createRenderPipeline(object: RenderObject, ...rest: unknown[]): void }
}

/** Lists the pipelines that a renderer makes from now on, as it makes them. */
export function traceShaders(renderer: WebGPURenderer): readonly BuiltPipeline[] {
  const { _nodes: nodes, _pipelines: pipelines, backend } = renderer as unknown as Internals
  const built: BuiltPipeline[] = []
  const generation = new Map<RenderObject, number>()
  let isCompiling = false
  let isNew = false

  const generate = nodes.getForRender.bind(nodes)
  nodes.getForRender = (object, ...rest) => {
    const start = performance.now()
    const state = generate(object, ...rest)
    // Inside of the other its time is counted there.
    if (!isCompiling) {
      generation.set(object, (generation.get(object) ?? 0) + performance.now() - start)
    }
    return state
  }
  const create = backend.createRenderPipeline.bind(backend)
  backend.createRenderPipeline = (...args) => {
    isNew = true
    create(...args)
  }
  const compile = pipelines.getForRender.bind(pipelines)
  pipelines.getForRender = (object, ...rest) => {
    isNew = false
    isCompiling = true
    const start = performance.now()
    const pipeline = compile(object, ...rest)
    const ms = performance.now() - start
    isCompiling = false
    if (isNew) {
      const { vertexShader, fragmentShader } = object.getNodeBuilderState()
      built.push({
        name: object.material.name || object.material.type,
        vertex: shaderStats(vertexShader),
        fragment: shaderStats(fragmentShader),
        source: fragmentShader,
        ms: ms + (generation.get(object) ?? 0)
      })
    }
    return pipeline
  }
  return built
}

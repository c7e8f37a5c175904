import type { ShaderStats } from '../harness/shader-stats'
import { finished, nextFrame, release, type HeadlessDevice } from '../headless/device'
import { recordingRenderer } from '../headless/recordingContext'
import { traceShaders, type BuiltPipeline } from '../headless/traceShaders'
import { shaderScenes } from './shader-scenes'

type Stages = Record<'vertex' | 'fragment', ShaderStats>

/** Shaders of a material or pass. */
export interface ShaderCost {
  scene: string
  name: string
  wgsl: Stages
  glsl: Stages
  /** Time from nothing to a compiled pipeline of WebGPU; wall-clock [ms]. */
  ms: number
}

/** Frames until all passes have drawn: clouds march, shadows and environment are drawn in turns. */
const FRAMES = 40
const SIZE = [16, 9] as const

/** One of each: passes that differ in their uniforms' names alone are the same. */
function distinct(pipelines: readonly BuiltPipeline[]): BuiltPipeline[] {
  const seen = new Map<string, BuiltPipeline>()
  for (const pipeline of pipelines) {
    const { name, vertex, fragment } = pipeline
    const key = JSON.stringify([name, vertex, fragment])
    if (!seen.has(key)) seen.set(key, pipeline)
  }
  return [...seen.values()]
}

const isSame = (a: ShaderCost, b: ShaderCost): boolean =>
  a.name === b.name && JSON.stringify(a.wgsl) === JSON.stringify(b.wgsl)

/** Shaders of a scene in WGSL and GLSL, and how long each takes to build. */
async function measureScene(device: HeadlessDevice, scene: string): Promise<ShaderCost[]> {
  const renderer = await device.renderer(...SIZE)
  const wgsl = traceShaders(renderer)
  const recorder = await recordingRenderer(...SIZE)
  const glsl = traceShaders(recorder)
  for (const each of [renderer, recorder]) {
    const draw = shaderScenes[scene](each)
    for (let frame = 0; frame < FRAMES; frame++) {
      nextFrame()
      draw()
      await finished(renderer)
    }
  }
  const inGLSL = distinct(glsl)
  const costs = distinct(wgsl).map(({ name, vertex, fragment, ms }) => {
    // Of several by one name, both lists have them in one order.
    const place = inGLSL.findIndex(other => other.name === name)
    if (place < 0) throw new Error(`bench: no GLSL was generated for ${name} of ${scene}`)
    const [other] = inGLSL.splice(place, 1)
    const stages = { vertex: other.vertex, fragment: other.fragment }
    return { scene, name, wgsl: { vertex, fragment }, glsl: stages, ms }
  })
  release(renderer)
  void recorder.dispose()
  return costs
}

/** Shaders of every scene. One counts in the scene in which it comes first, which `log` is told at once. */
export async function measureShaders(
  device: HeadlessDevice,
  log: (line: string) => void
): Promise<ShaderCost[]> {
  const costs: ShaderCost[] = []
  for (const scene of Object.keys(shaderScenes)) {
    for (const cost of await measureScene(device, scene)) {
      if (costs.some(known => isSame(known, cost))) continue
      costs.push(cost)
      log(shaderLine(cost))
    }
  }
  return costs
}

/** A line of a report. */
function shaderLine({ scene, name, wgsl, glsl, ms }: ShaderCost): string {
  const lines = ({ vertex, fragment }: Stages): string =>
    `${vertex.lines} + ${fragment.lines}`.padEnd(10)
  const textures = ({ vertex, fragment }: Stages): string =>
    `${vertex.textures} + ${fragment.textures}`.padEnd(7)
  return (
    `${scene.padEnd(24)} ${name.padEnd(36)} WGSL ${lines(wgsl)} GLSL ${lines(glsl)} lines` +
    `   textures ${textures(wgsl)} (GLSL ${textures(glsl)})   ${ms.toFixed(0).padStart(5)} ms`
  )
}

import type { WebGPURenderer } from 'three/webgpu'

/**
 * Waits for the next frame of the page. three's passes draw once in a frame, however often the
 * pipeline is rendered.
 */
export async function nextFrame(): Promise<void> {
  await new Promise(resolve => requestAnimationFrame(resolve))
}

type Method = (this: object, ...args: unknown[]) => unknown

/** Graphics device of a renderer: a `GPUDevice` or a `WebGL2RenderingContext`. */
function graphicsOf(renderer: WebGPURenderer): object {
  const { device, gl } = renderer.backend as { device?: object; gl?: object }
  const graphics = device ?? gl
  if (graphics === undefined) throw new Error('graphicsOf: the renderer is not initialised')
  return graphics
}

/** Waits until the GPU has done what it was given. On WebGL no framebuffer stays bound for reading. */
export async function finishWork(renderer: WebGPURenderer): Promise<void> {
  const graphics = graphicsOf(renderer)
  if ('queue' in graphics) await (graphics as GPUDevice).queue.onSubmittedWorkDone()
  else {
    // Chromium's finish() does not wait; a read-back does.
    const gl = graphics as WebGL2RenderingContext
    gl.bindFramebuffer(gl.READ_FRAMEBUFFER, null)
    gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4))
  }
}

/** Has a function see the results of a method's calls from now on. */
function watch(
  object: object,
  name: string,
  see: (result: unknown, args: unknown[]) => void
): void {
  const methods = object as Record<string, Method>
  const original = methods[name]
  methods[name] = function (...args) {
    const result = original.apply(this, args)
    see(result, args)
    return result
  }
}

const compilations = {
  webgpu: [
    'createShaderModule',
    'createRenderPipeline',
    'createRenderPipelineAsync',
    'createComputePipeline',
    'createComputePipelineAsync'
  ],
  webgl: ['compileShader', 'linkProgram']
}

/** Counts the shaders and pipelines that a renderer makes from now on, by the API's own calls. */
export function countCompilations(renderer: WebGPURenderer): Record<string, number> {
  const graphics = graphicsOf(renderer)
  const names = 'queue' in graphics ? compilations.webgpu : compilations.webgl
  const counts = Object.fromEntries(names.map(name => [name, 0]))
  for (const name of names) watch(graphics, name, () => counts[name]++)
  return counts
}

// Not framebuffers: three r187 leaves those of disposed targets to the garbage collector.
const glObjects = ['Texture', 'Buffer', 'Renderbuffer', 'VertexArray', 'Program', 'Shader']

/** Counts the objects that a renderer has on the GPU, of those made from now on. */
export function countObjects(renderer: WebGPURenderer): Record<string, number> {
  const graphics = graphicsOf(renderer)
  const alive: Record<string, Set<unknown>> = {}
  const counts: Record<string, number> = {}
  const change = (kind: string, act: (set: Set<unknown>) => void): void => {
    const set = (alive[kind] ??= new Set())
    act(set)
    counts[kind] = set.size
  }
  if ('queue' in graphics) {
    for (const kind of ['Texture', 'Buffer']) {
      watch(graphics, `create${kind}`, result => {
        change(kind, set => set.add(result))
        watch(result as object, 'destroy', () => change(kind, set => set.delete(result)))
      })
    }
  } else {
    for (const kind of glObjects) {
      watch(graphics, `create${kind}`, result => change(kind, set => set.add(result)))
      watch(graphics, `delete${kind}`, (_, [object]) => change(kind, set => set.delete(object)))
    }
  }
  return counts
}

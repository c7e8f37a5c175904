import { WebGPURenderer } from 'three/webgpu'

/** Sizes that three asks WebGL2 for: those that every implementation has. */
const LIMITS: Record<string, unknown> = {
  MAX_TEXTURE_IMAGE_UNITS: 16,
  MAX_COMBINED_TEXTURE_IMAGE_UNITS: 32,
  MAX_TEXTURE_SIZE: 4096,
  MAX_UNIFORM_BLOCK_SIZE: 16_384,
  MAX_UNIFORM_BUFFER_BINDINGS: 24,
  MAX_SAMPLES: 4,
  MAX_DRAW_BUFFERS: 8,
  VERSION: 'WebGL 2.0',
  SHADING_LANGUAGE_VERSION: 'WebGL GLSL ES 3.00'
}

/**
 * A WebGL2 context that takes every call, compiles what it is given and draws nothing: enough for three to
 * generate all shaders of a scene as GLSL in Node.
 */
function recordingContext(canvas: HTMLCanvasElement): WebGL2RenderingContext {
  const names: string[] = []
  /** A constant is the place of its name in this list, above 0. */
  const constant = (name: string): number => {
    if (!names.includes(name)) names.push(name)
    return names.indexOf(name) + 1
  }
  const answers: Record<string, (...args: never[]) => unknown> = {
    getContextAttributes: () => ({}),
    getSupportedExtensions: () => ['EXT_color_buffer_float', 'OES_texture_float_linear'],
    getExtension: () => ({}),
    getParameter: (name: number) =>
      LIMITS[names[name - 1]] ?? (/BOX|VIEWPORT/.test(names[name - 1]) ? [0, 0, 1, 1] : 0),
    getShaderParameter: () => true,
    getProgramParameter: (_: unknown, name: number) => (/STATUS/.test(names[name - 1]) ? true : 0),
    getShaderInfoLog: () => '',
    getProgramInfoLog: () => '',
    getError: () => 0,
    getUniformBlockIndex: () => 0,
    getAttribLocation: () => 0,
    checkFramebufferStatus: () => constant('FRAMEBUFFER_COMPLETE'),
    clientWaitSync: () => constant('CONDITION_SATISFIED'),
    isContextLost: () => false
  }
  return new Proxy({} as WebGL2RenderingContext, {
    get: (_, name: string) => {
      if (name === 'canvas') return canvas
      if (name === 'drawingBufferWidth') return canvas.width
      if (name === 'drawingBufferHeight') return canvas.height
      if (/^[A-Z]/.test(name)) return constant(name)
      if (name in answers) return answers[name]
      return /^(create|fence|getUniformLocation)/.test(name) ? () => ({}) : () => undefined
    }
  })
}

/** A renderer that generates GLSL and draws nothing; after `HeadlessDevice.open`. */
export async function recordingRenderer(width: number, height: number): Promise<WebGPURenderer> {
  const canvas = {
    width,
    height,
    style: {},
    addEventListener: () => undefined,
    removeEventListener: () => undefined,
    setAttribute: () => undefined,
    getContext: () => recordingContext(canvas as unknown as HTMLCanvasElement)
  }
  // three asks textures of WebGL2 whether they hold one.
  Object.assign(globalThis, { ImageBitmap: Object })
  const renderer = new WebGPURenderer({
    canvas: canvas as unknown as HTMLCanvasElement,
    antialias: false,
    forceWebGL: true
  })
  await renderer.init()
  renderer.setPixelRatio(1)
  renderer.setSize(width, height, false)
  return renderer
}

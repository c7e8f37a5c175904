/** Size of a generated shader, and textures that it binds. */
export interface ShaderStats {
  /** Lines that are not empty. */
  readonly lines: number
  /** Textures that it binds to be sampled or loaded from; storage textures are not among them. */
  readonly textures: number
}

/** A texture of WGSL, but no storage texture, as three declares it: `var nodeUniform3 : texture_2d<f32>;`. */
const WGSL_TEXTURE = /^\s*@binding\(.*\bvar\s+\w+\s*:\s*texture_(?!storage)/gm

/** A texture of GLSL: `uniform sampler2D nodeUniform3;`, with its precision or without. */
const GLSL_TEXTURE = /^\s*uniform\s+(?:(?:lowp|mediump|highp)\s+)?[iu]?sampler\w+\s+\w+/gm

/**
 * Counts the lines and the sampled textures of a stage's source.
 *
 * @param source - WGSL or GLSL, as a renderer hands it to the graphics API.
 */
export function shaderStats(source: string): ShaderStats {
  const count = (pattern: RegExp): number => source.match(pattern)?.length ?? 0
  return {
    lines: count(/^.*\S.*$/gm),
    textures: count(WGSL_TEXTURE) + count(GLSL_TEXTURE)
  }
}

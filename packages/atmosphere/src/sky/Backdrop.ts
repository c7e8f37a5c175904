import { Color, type Scene } from 'three'
import type { Node, PassNode, Renderer } from 'three/webgpu'
import { number, vector4 } from '../uniforms'

const _color = new Color()

/** The pass that a node is the colour or depth of, or null. */
export function passOf(node: Node): PassNode | null {
  const { isPassNode, passNode } = node as Node & { isPassNode?: boolean; passNode?: PassNode }
  if (isPassNode === true) return node as PassNode
  // Effects have textures of this kind too, of which they are the `passNode`.
  return (passNode as { isPassNode?: boolean } | undefined)?.isPassNode === true ? passNode! : null
}

/** Colour of a pass where nothing was drawn, so that the sky can be put in its place. */
export class Backdrop {
  /** Linear colour as it is in the pass's texture, and alpha. */
  readonly color = vector4()
  /** 1 where {@link color} is the pass's, 0 where nothing is known of it but that its alpha may be 1. */
  readonly isKnown = number()

  /** Follows the renderer's clear colour and the scene's background. */
  update(renderer: Renderer, pass: PassNode | null): void {
    const scene = pass?.scene as Partial<Scene> | undefined
    const background = scene?.background ?? null
    const isColor = background instanceof Color
    const isKnown = pass !== null && !scene?.backgroundNode && (isColor || background === null)
    this.isKnown.value = isKnown ? 1 : 0
    let alpha = 0
    if (!isKnown) _color.set(0)
    else if (isColor) {
      _color.copy(background)
      alpha = 1
    } else {
      alpha = renderer.getClearAlpha()
      renderer.getClearColor(_color)
      // As three's renderer does before it clears.
      const { alpha: isTransparent, backend } = renderer as Renderer & { alpha: boolean }
      if (isTransparent || !('isWebGPUBackend' in backend)) _color.multiplyScalar(alpha)
    }
    this.color.value.set(_color.r, _color.g, _color.b, alpha)
  }
}

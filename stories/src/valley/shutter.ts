import { float, Fn, If, int, Loop, screenSize, uv, vec2, vec4 } from 'three/tsl'
import type { Node, TextureNode } from 'three/webgpu'

/** Samples where much moves: elsewhere there is one for two pixels. Fewer: fast turns are many pictures in one. */
const MOST_SAMPLES = 12

/**
 * A picture as a shutter that is open all of a frame takes it, half of it before the moment of the picture and half after; where
 * little moves, few samples do.
 *
 * @param sharp - The picture.
 * @param motion - Velocities, as three's TRAA takes them.
 */
export const shutter = (sharp: TextureNode, motion: Node): Node<'vec4'> =>
  Fn(() => {
    const way = (motion as Node<'vec4'>).xy.mul(vec2(0.5, -0.5)).toConst()
    const pixels = way.mul(screenSize).length()
    const count = int(pixels.mul(0.5).add(1.5).min(MOST_SAMPLES)).toConst()
    const at = (place: Node<'vec2'>): Node<'vec4'> => sharp.sample(place).level(float(0))
    const light = vec4(0).toVar()
    If(count.greaterThan(1), () => {
      Loop(count as unknown as number, ({ i }: { i: Node<'int'> }) => {
        const moment = float(i).add(0.5).div(float(count)).sub(0.5)
        light.addAssign(at(uv().add(way.mul(moment))))
      })
      light.divAssign(float(count))
    }).Else(() => {
      light.assign(at(uv()))
    })
    return light
  })()

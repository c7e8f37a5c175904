// What @types/three 0.187 lacks or gets wrong, in one place.
import {
  floatBitsToInt,
  intBitsToFloat,
  Loop as threeLoop,
  renderGroup,
  uniformArray as threeUniformArray
} from 'three/tsl'
import type { Vector4 } from 'three'
import type { Node } from 'three/webgpu'

export type Float = Node<'float'>
export type Int = Node<'int'>
export type Bool = Node<'bool'>
export type Vec2 = Node<'vec2'>
export type Vec3 = Node<'vec3'>
export type Vec4 = Node<'vec4'>
export type Mat3 = Node<'mat3'>
export type Mat4 = Node<'mat4'>

/** A variable of a shader. */
export type Variable<T> = T & { assign: (n: T | number | boolean) => void }

/** `Loop` with the counter's name, so that nested loops do not shadow each other. */
export const loop = (
  name: string,
  end: Int | number,
  body: (index: Int) => void,
  start: Int | number = 0
): void => {
  const nodes = threeLoop as unknown as (
    range: { start: Int | number; end: Int | number; type: string; name: string },
    body: (inputs: Record<string, Int>) => void
  ) => void
  nodes({ start, end, type: 'int', name }, inputs => body(inputs[name]))
}

/** Layout of a `Fn`: a name, what it returns, and the types of its inputs by name. */
export const layout = (name: string, type: string, inputs: Record<string, string>): never =>
  ({
    name,
    type,
    inputs: Object.entries(inputs).map(([input, kind]) => ({ name: input, type: kind }))
  }) as never

/**
 * `uniformArray` of four-vectors, whose elements are typed. In the render group: what is an object's own
 * does not reach materials that three does not refresh.
 */
export interface Vec4Array extends Node {
  array: Vector4[]
  element(index: Int): Vec4
}
export const vec4Array = (values: Vector4[]): Vec4Array =>
  threeUniformArray(values, 'vec4').setGroup(renderGroup) as unknown as Vec4Array

/** The bits of four floats. */
export interface Bits extends Node {
  add(n: Int): Bits
  bitAnd(n: Int): Bits
}
export const toBits = (value: Vec4): Bits => floatBitsToInt(value) as unknown as Bits
export const fromBits = (bits: Bits): Vec4 => intBitsToFloat(bits) as unknown as Vec4

/** A texture node that is read at an explicit level, wherever the control flow is. */
export interface LevelTexture<UV> extends Node {
  sample(uv: UV): { level(level: Float | number): Vec4 }
}

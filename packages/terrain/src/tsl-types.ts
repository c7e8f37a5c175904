// What @types/three 0.187 lacks or gets wrong, in one place.
import { Loop as threeLoop } from 'three/tsl'
import type { Node } from 'three/webgpu'

export type Float = Node<'float'>
export type Int = Node<'int'>
export type UInt = Node<'uint'>
export type Vec2 = Node<'vec2'>
export type Vec3 = Node<'vec3'>
export type Vec4 = Node<'vec4'>
export type UVec3 = Node<'uvec3'>
export type UVec4 = Node<'uvec4'>

/** A variable of a shader. */
export type Variable<T> = T & {
  assign(value: T): void
  addAssign(value: T): void
  mulAssign(value: T): void
}

/** `Loop` with the counter's name, so that nested loops do not shadow each other. */
export const loop = (name: string, end: Int | number, body: (index: Int) => void): void => {
  const nodes = threeLoop as unknown as (
    range: { start: number; end: Int | number; type: string; name: string },
    body: (inputs: Record<string, Int>) => void
  ) => void
  nodes({ start: 0, end, type: 'int', name }, inputs => body(inputs[name]))
}

/** Layout of a `Fn`: a name, what it returns, and the types of its inputs by name. */
export const layout = (name: string, type: string, inputs: Record<string, string>): never =>
  ({
    name,
    type,
    inputs: Object.entries(inputs).map(([input, kind]) => ({ name: input, type: kind }))
  }) as never

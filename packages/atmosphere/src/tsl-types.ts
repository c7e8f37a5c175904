// What @types/three 0.187 lacks or gets wrong, in one place.
import { Loop as threeLoop, uniformArray as threeUniformArray } from 'three/tsl'
import type { Vector4 } from 'three'
import type { Node, TextureNode } from 'three/webgpu'

export type Float = Node<'float'>
export type Int = Node<'int'>
export type Bool = Node<'bool'>
export type Vec2 = Node<'vec2'>
export type Vec3 = Node<'vec3'>
export type Vec4 = Node<'vec4'>
export type Mat3 = Node<'mat3'>

/** A matrix whose columns can be taken. */
export type Mat4 = Node<'mat4'> & {
  element(column: number): Vec4 & { element(row: number): Float }
}

/** `Loop` with the counter's name, so that nested loops do not shadow each other. */
export const loop = (name: string, end: Int | number, body: (index: Int) => void): void => {
  const nodes = threeLoop as unknown as (
    range: { start: number; end: Int | number; type: string; name: string },
    body: (inputs: Record<string, Int>) => void
  ) => void
  nodes({ start: 0, end, type: 'int', name }, inputs => body(inputs[name]))
}

/** `uniformArray` of four-vectors, whose elements are typed. */
export interface Vec4Array extends Node {
  array: Vector4[]
  element(index: Int): Vec4
}
export const vec4Array = (values: Vector4[]): Vec4Array =>
  threeUniformArray(values, 'vec4') as unknown as Vec4Array

/** Reads a texture bilinearly, at its only level, wherever the control flow is. */
export const sampleLevel0 = (source: TextureNode, uv: Vec2): Vec4 =>
  (source as unknown as { sample(uv: Vec2): { level(n: number): Vec4 } }).sample(uv).level(0)

/** Red of the four texels about a corner, at (0, 1), (1, 1), (1, 0) and (0, 0) of u and v. */
export const gatherRed = (source: TextureNode, corner: Vec2): Vec4 =>
  (source as unknown as { sample(uv: Vec2): { gather(channel: number): Vec4 } })
    .sample(corner)
    .gather(0)
    .toConst()

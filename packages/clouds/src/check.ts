import { checkRange } from '@welkin/atmosphere'
import { checkChoice, fail } from '@welkin/geo'
import type { DepthTexture } from 'three'
import type { Node, TextureNode } from 'three/webgpu'

/** @throws If a value is not a number from the least to the greatest of its range. */
export function checkRanges<K extends string>(
  where: string,
  values: Readonly<Record<NoInfer<K>, number>>,
  ranges: Readonly<Record<K, readonly [number, number]>>
): void {
  for (const name in ranges) {
    checkRange(where, name, values[name], ...(ranges[name] as [number, number]))
  }
}

/** Value that a name stands for. @throws If it is none of the names. */
export function named<T extends object>(
  where: string,
  what: string,
  values: T,
  name: unknown
): T[keyof T] {
  checkChoice<unknown>(where, what, name, Object.keys(values))
  return values[name as keyof T]
}

/** @throws If they are no clouds. */
export function checkClouds(where: string, value: { readonly shadows: unknown }): void {
  if (value?.shadows === undefined) fail(where, 'clouds must be a CloudsNode', value)
}

/** @throws If layers have precipitation, and a `CloudsNode` nothing that shows it. */
export function checkPrecipitation(
  layers: Iterable<{ readonly precipitation: { readonly rate: number } | null }>,
  medium: object | undefined
): void {
  if (medium === undefined && [...layers].some(layer => layer.precipitation?.rate)) {
    fail('CloudsNode', 'precipitation must be precipitationShafts(): it rains')
  }
}

/** @throws If it is not the depth of a texture, or one depth for all pixels. */
export function checkDepth(where: string, node: Node): void {
  const value = (node as TextureNode | null)?.value as DepthTexture | number | undefined
  if (typeof value === 'number' || value?.isDepthTexture === true) return
  fail(where, "depthNode must be a depth texture's node", node)
}

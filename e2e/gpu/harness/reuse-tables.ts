import {
  DataTexture,
  DataUtils,
  HalfFloatType,
  NearestFilter,
  RGBAFormat,
  type RenderTarget
} from 'three'
import { ivec2, textureLoad, uv, vec2 } from 'three/tsl'
import type { Renderer } from 'three/webgpu'
import { AtmosphereTables } from '../../../packages/atmosphere/src/tables/AtmosphereTables'
import { FragmentPass } from '../../../packages/atmosphere/src/tables/FragmentPass'
import type { TableRegion } from '../../../packages/atmosphere/src/tables/TableAtlas'

/** Of a bake, in frames of one step: the library's count. */
const BAKE_STEPS = 20

let isReusing = false
const _readings = new Set<Promise<void>>()
const _prepared = new WeakSet<AtmosphereTables>()

/** What a table of diffuse light is made from: all but the colours, of which it knows none. */
function keyOf(renderer: Renderer, { uniforms }: AtmosphereTables): string {
  const backend = 'isWebGPUBackend' in renderer.backend ? 'webgpu' : 'webgl'
  const numbers = Object.entries(uniforms).flatMap(([name, node]) =>
    Array.isArray(node) ? [] : [[name, node.value]]
  )
  return JSON.stringify([backend, ...numbers])
}

/** RGBA texels of a read-back target, top row first. */
export async function readTexels<T extends Uint8Array | Uint16Array>(
  renderer: Renderer,
  target: RenderTarget
): Promise<T> {
  const { width, height } = target
  const texels = (await renderer.readRenderTargetPixelsAsync(target, 0, 0, width, height)) as T
  if ('isWebGPUBackend' in renderer.backend) return texels
  const flipped = texels.slice() as T
  const stride = 4 * width
  for (let y = 0; y < height; y++) {
    flipped.set(texels.subarray(y * stride, (y + 1) * stride), (height - 1 - y) * stride)
  }
  return flipped
}

async function keep(renderer: Renderer, region: TableRegion, key: string): Promise<void> {
  const halves = Array.from(await region.read(renderer), half => DataUtils.toHalfFloat(half))
  localStorage.setItem(key, halves.map(half => String.fromCharCode(half)).join(''))
}

function restore(renderer: Renderer, region: TableRegion, kept: string): void {
  const { width, height } = region
  const halves = Uint16Array.from({ length: kept.length }, (_, i) => kept.charCodeAt(i))
  const source = new DataTexture(halves, width, height, RGBAFormat, HalfFloatType)
  source.minFilter = source.magFilter = NearestFilter
  source.needsUpdate = true
  const texel = ivec2(uv().mul(vec2(width, height)).floor())
  const copy = new FragmentPass('Reuse.DiffuseLight', textureLoad(source, texel))
  region.render(renderer, copy)
  copy.dispose()
  source.dispose()
}

function prepare(tables: AtmosphereTables): void {
  if (_prepared.has(tables)) return
  _prepared.add(tables)
  const { diffuseLight } = tables
  const bake = diffuseLight.bake.bind(diffuseLight)
  diffuseLight.bake = function* (renderer) {
    const key = keyOf(renderer, tables)
    const kept = isReusing ? localStorage.getItem(key) : null
    if (kept === null) {
      yield* bake(renderer)
      if (!isReusing) return
      waitFor(keep(renderer, diffuseLight.region, key))
      return
    }
    for (let step = 0; step < BAKE_STEPS; step++) yield
    restore(renderer, diffuseLight.region, kept)
  }
}

/** Whether tables are reused now. */
export const isReusingTables = (): boolean => isReusing

/** Has {@link keepTables} wait. What a test disposes of before it can be read is not kept. */
export function waitFor(work: Promise<void>): void {
  const reading = work.catch(() => undefined)
  _readings.add(reading)
  void reading.then(() => _readings.delete(reading))
}

/** Resolves when tables baked so far can be reused. */
export async function keepTables(): Promise<void> {
  await Promise.all(_readings)
}

/**
 * From now on, has atmospheres take tables of diffuse light that this or another page of the browser's
 * run of tests has baked, of the same parameters on the same backend: bit for bit what they would bake, for
 * a hundredth of the time. A software renderer takes seconds for a bake, longer than for most tests.
 *
 * @param reuse - False: from now on, each bakes its own.
 */
export function reuseTables(reuse: boolean): void {
  isReusing = reuse
}

type Update = (this: AtmosphereTables, ...args: Parameters<AtmosphereTables['update']>) => void

const prototype = AtmosphereTables.prototype as { update: Update }
const { update } = prototype
prototype.update = function (...args) {
  prepare(this)
  update.apply(this, args)
}

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
import type { AtmosphereUniforms } from '../../../packages/atmosphere/src/air/AtmosphereUniforms'
import { DiffuseLightTable as BakedTable } from '../../../packages/atmosphere/src/diffuseLight/DiffuseLightTable'
import { TransmittanceTable as BakedTransmittance } from '../../../packages/atmosphere/src/transmittance/TransmittanceTable'
import { FragmentPass } from '../../../packages/atmosphere/src/tables/FragmentPass'
import { keepTexels, keptTexels, type Texels } from './kept-texels'
import type { Table, TableRegion } from '../../../packages/atmosphere/src/tables/TableAtlas'

/** Steps of a bake, as many as the library's has. */
const BAKE_STEPS = 20

let isTaking = false
let isKeeping = false
const _readings = new Set<Promise<void>>()

/** Key of a table: its name and all that it is made from, but not the colours, of which it knows none. */
function keyOf(table: string, renderer: Renderer, uniforms: AtmosphereUniforms): string {
  const backend = 'isWebGPUBackend' in renderer.backend ? 'webgpu' : 'webgl'
  const numbers = Object.entries(uniforms).flatMap(([name, node]) =>
    Array.isArray(node) ? [] : [[name, node.value]]
  )
  return JSON.stringify([table, backend, ...numbers])
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
  const values = await region.read(renderer)
  if (!values.every(value => Number.isFinite(value))) return
  const halves = Uint16Array.from(values, half => DataUtils.toHalfFloat(half))
  await keepTexels(key, [new Uint8Array(halves.buffer)])
}

function restore(renderer: Renderer, region: TableRegion, kept: Texels, name: string): void {
  const { width, height } = region
  const source = new DataTexture(
    new Uint16Array(kept.buffer),
    width,
    height,
    RGBAFormat,
    HalfFloatType
  )
  source.minFilter = source.magFilter = NearestFilter
  source.needsUpdate = true
  const texel = ivec2(uv().mul(vec2(width, height)).floor())
  const copy = new FragmentPass(name, textureLoad(source, texel))
  region.render(renderer, copy)
  copy.dispose()
  source.dispose()
}

/** The table of optical depth to the sun, reused just as that of diffuse light is. */
export class TransmittanceTable extends BakedTransmittance {
  readonly #uniforms: AtmosphereUniforms

  constructor(uniforms: AtmosphereUniforms, region: TableRegion) {
    super(uniforms, region)
    this.#uniforms = uniforms
  }

  override bake(renderer: Renderer): void {
    const key = keyOf('transmittance', renderer, this.#uniforms)
    const kept = takeTexels(key)
    if (kept) {
      // By the name of the library's own pass, which tests count.
      restore(renderer, this.region, kept, 'Welkin.Transmittance')
      return
    }
    super.bake(renderer)
    if (isKeeping) waitFor(keep(renderer, this.region, key))
  }
}

/**
 * The table of diffuse light as pages of tests have it instead of the library's: see {@link reuseTables}, and
 * `replaceModules.ts`, which puts it there.
 */
export class DiffuseLightTable extends BakedTable {
  readonly #uniforms: AtmosphereUniforms

  constructor(uniforms: AtmosphereUniforms, region: TableRegion, transmittance: Table) {
    super(uniforms, region, transmittance)
    this.#uniforms = uniforms
  }

  override *bake(renderer: Renderer): Generator<void, void, void> {
    const key = keyOf('diffuse light', renderer, this.#uniforms)
    const kept = takeTexels(key)
    if (!kept) {
      yield* super.bake(renderer)
      if (isKeeping) waitFor(keep(renderer, this.region, key))
      return
    }
    for (let step = 0; step < BAKE_STEPS; step++) yield
    restore(renderer, this.region, kept, 'Reuse.DiffuseLight')
  }
}

/** True if what is baked now is kept. */
export const isKeepingTexels = (): boolean => isKeeping

/** Bytes kept by a name, if they may be reused now. */
export const takeTexels = (key: string): Texels | undefined =>
  isTaking ? keptTexels(key) : undefined

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
 * Has atmospheres, from now on, take tables of diffuse light and of optical depth that any page of tests has baked, of the same
 * parameters on the same backend: bit for bit what they would bake, for a hundredth of the time. A software renderer takes
 * seconds for a bake, longer than for most tests.
 *
 * @param reuse - False: from now on, each bakes its own.
 * @param take - False: each bakes its own, which is kept.
 */
export function reuseTables(reuse: boolean, take = reuse): void {
  isKeeping = reuse
  isTaking = take
}

import { DataTexture, NearestFilter, RenderTarget, type RenderTarget3D } from 'three'
import {
  int,
  ivec2,
  ivec3,
  screenCoordinate,
  texture3DLoad,
  textureLoad,
  uniform,
  vec4
} from 'three/tsl'
import type { Node, Renderer } from 'three/webgpu'
import { FragmentPass } from '../../../packages/atmosphere/src/tables/FragmentPass'
import { CloudNoise } from '../../../packages/clouds/src/noise/CloudNoise'
import { isReusingTables, readTexels, waitFor } from './reuse-tables'

/** Slices of a volume lie side by side in as many columns. */
const COLUMNS = 8

const STORE = 'noise'

type Slice = (target: RenderTarget3D, slice: number) => void

const _kept = new Map<string, Uint8Array>()
const _copies = new WeakMap<RenderTarget, Slice>()
const _prepared = new WeakSet<CloudNoise>()

const pixel = (): Node<'ivec2'> => ivec2(int(screenCoordinate.x), int(screenCoordinate.y))

/** Keeps the finest level of a volume, for this page and those to come. */
async function keep(renderer: Renderer, volume: RenderTarget3D, key: string): Promise<void> {
  const { width: size, texture } = volume
  const options = {
    depthBuffer: false,
    minFilter: NearestFilter,
    magFilter: NearestFilter
  } as const
  const atlas = new RenderTarget(size * COLUMNS, size ** 2 / COLUMNS, options)
  const { x, y } = pixel().toConst()
  const slice = y.div(size).mul(COLUMNS).add(x.div(size))
  const place = ivec3(x.mod(int(size)), y.mod(int(size)), slice)
  const copy = new FragmentPass('Reuse.keep', vec4(texture3DLoad(texture, place)))
  copy.render(renderer, atlas)
  const reading = readTexels<Uint8Array<ArrayBuffer>>(renderer, atlas)
  copy.dispose()
  const texels = await reading
  atlas.dispose()
  _kept.set(key, texels)
  await (await caches.open(STORE)).put(`/${key}`, new Response(texels))
}

/** Fetches what other pages have kept. */
export async function loadNoise(): Promise<void> {
  const store = await caches.open(STORE)
  for (const { url } of await store.keys()) {
    const response = await store.match(url)
    const texels = await response?.arrayBuffer()
    if (texels) _kept.set(new URL(url).pathname.slice(1), new Uint8Array(texels))
  }
}

/** Has the finest level's slices copied, for as long as it is not told to stop. */
function startCopying(renderer: Renderer, volume: RenderTarget3D, kept: Uint8Array): () => void {
  const size = volume.width
  const source = new DataTexture(kept, size * COLUMNS, size ** 2 / COLUMNS)
  source.minFilter = source.magFilter = NearestFilter
  source.needsUpdate = true
  const corner = [uniform(0, 'int'), uniform(0, 'int')]
  const place = pixel().add(ivec2(corner[0], corner[1]))
  const copy = new FragmentPass('Reuse.noise', textureLoad(source, place))
  _copies.set(volume, (target, slice) => {
    corner[0].value = size * (slice % COLUMNS)
    corner[1].value = size * Math.floor(slice / COLUMNS)
    copy.render(renderer, target, slice)
  })
  return () => {
    _copies.delete(volume)
    copy.dispose()
    source.dispose()
  }
}

function prepare(noise: CloudNoise): void {
  if (_prepared.has(noise)) return
  _prepared.add(noise)
  for (const name of ['weather', 'shape'] as const) {
    const { [name]: volume } = noise
    const bake = volume.bake.bind(volume)
    volume.bake = function* (renderer) {
      const key = 'isWebGPUBackend' in renderer.backend ? `${name}.webgpu` : `${name}.webgl`
      const kept = isReusingTables() ? _kept.get(key) : undefined
      const stop = kept && startCopying(renderer, volume.target, kept)
      try {
        yield* bake(renderer)
      } finally {
        stop?.()
      }
      if (isReusingTables() && !kept) waitFor(keep(renderer, volume.target, key))
    }
  }
}

interface Pass {
  render: (this: FragmentPass, ...args: Parameters<FragmentPass['render']>) => void
}

interface Noise {
  update: (this: CloudNoise, ...args: Parameters<CloudNoise['update']>) => boolean
}

const pass = FragmentPass.prototype as Pass
const { render } = pass
pass.render = function (renderer, target, slice = 0, level = 0) {
  const isFinest = this.material.name === target.texture.name && level === 0
  const copy = isFinest ? _copies.get(target) : undefined
  if (copy) copy(target as RenderTarget3D, slice)
  else render.call(this, renderer, target, slice, level)
}

/** Clouds' noise is reused just as tables are, once {@link loadNoise} has been called. */
const noisePrototype = CloudNoise.prototype as Noise
const { update } = noisePrototype
noisePrototype.update = function (...args) {
  prepare(this)
  return update.apply(this, args)
}

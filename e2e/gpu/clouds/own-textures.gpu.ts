import { Atmosphere } from '@welkin/atmosphere'
import {
  CloudField,
  CloudLayers,
  CloudNoise,
  cloudWorldMap,
  noiseVolume,
  type MapBounds
} from '@welkin/clouds'
import {
  ClampToEdgeWrapping,
  Data3DTexture,
  DataTexture,
  LinearFilter,
  RedFormat,
  RepeatWrapping,
  Vector3,
  type Wrapping
} from 'three'
import { cos, float, int, sin, texture3D, vec3, vec4 } from 'three/tsl'
import type { Float, LevelTexture, Vec3 } from '../../../packages/clouds/src/tsl-types'
import { random } from '../harness/atmosphere'
import { evaluateOnGpu } from '../harness/evaluate'
import { expectClose } from '../harness/expect'
import { gpuTest } from '../harness/gpu-test'

const degrees = Math.PI / 180
const AXIAL_RATIO = 1.003364
const COVERAGE = 0.35

/** Smooth shares of four layers, of a place in a map from 0 to 1 between its edges. */
const shares = (u: number, v: number): number[] =>
  [0, 1, 2, 3].map(
    layer =>
      0.5 + 0.4 * Math.sin(2 * Math.PI * (u + layer / 4)) * Math.cos(2 * Math.PI * (v - layer / 3))
  )

function mapOf(wrap: Wrapping): DataTexture {
  const [width, height] = [128, 64]
  const bytes = new Uint8Array(4 * width * height)
  for (let y = 0; y < height; y++) {
    for (let x = 0; x < width; x++) {
      const texel = shares((x + 0.5) / width, (y + 0.5) / height)
      bytes.set(
        texel.map(share => Math.round(255 * share)),
        4 * (y * width + x)
      )
    }
  }
  const map = new DataTexture(bytes, width, height)
  map.minFilter = map.magFilter = LinearFilter
  map.wrapS = map.wrapT = wrap
  map.needsUpdate = true
  return map
}

const clamp = (x: number): number => Math.min(Math.max(x, 0), 1)

/** Coverage of a layer with a map of such bounds, at a geodetic place [rad]. */
function expectedAt(
  { west, south, east, north }: MapBounds,
  isPlaced: boolean,
  layer: number,
  longitude: number,
  latitude: number
): number {
  const turns = (longitude / degrees - west) / 360
  const width = (((east - west) % 360) + 360) % 360
  const u = ((turns - Math.floor(turns)) * 360) / width
  const v = (latitude / degrees - south) / (north - south)
  const share = shares(u, v)[layer]
  const odds = (share / (1 - share)) * (COVERAGE / (1 - COVERAGE))
  const mapped = odds / (1 + odds)
  if (!isPlaced) return mapped
  // Half a texel at the edges is cut off, where the map has next to no weight.
  const within = clamp(Math.min(u, 1 - u) / 0.05) * clamp(Math.min(v, 1 - v) / 0.05)
  return COVERAGE + (mapped - COVERAGE) * within
}

gpuTest(
  'a placed map covers its bounds and nothing else, a repeated one all, each layer by its channel',
  async t => {
    const renderer = await t.createRenderer()
    const next = random(11)
    const bounds = { west: 170, south: 30, east: -150, north: 55 }
    const later = { west: -160, south: 20, east: -120, north: 45 }
    // Longitudes from 150° to 270°, across the antimeridian.
    const rows = Array.from({ length: 256 }, (_, i) =>
      [(150 + 120 * next()) * degrees, (5 + 65 * next()) * degrees, i % 4].map(Math.fround)
    )
    for (const wrap of [ClampToEdgeWrapping, RepeatWrapping] as const) {
      const texture = mapOf(wrap)
      const map = cloudWorldMap(texture, { bounds, perLayer: true })
      for (const current of [bounds, later]) {
        map.bounds = current
        const found = await evaluateOnGpu(renderer, rows, ({ x, y, z }) => {
          const up = vec3(cos(y).mul(cos(x)), cos(y).mul(sin(x)), sin(y)) as Vec3
          const planet = { radius: float(6.36e6) as Float, axialRatio: AXIAL_RATIO }
          const layer = { index: int(z), coverage: float(COVERAGE) as Float }
          return map.coverageAt(planet, layer, up, float(1), vec3(0))
        })
        const expected = rows.map(([longitude, latitude, layer]) => {
          const geodetic = Math.atan2(Math.sin(latitude) * AXIAL_RATIO, Math.cos(latitude))
          return expectedAt(current, wrap === ClampToEdgeWrapping, layer, longitude, geodetic)
        })
        const covers = rows.map((_, i) => found[4 * i])
        expectClose(new Float32Array(covers), expected, { relative: 0, absolute: 0.01 })
      }
      texture.dispose()
    }
  }
)

gpuTest(
  'clouds take noise of one’s own, also by the next renderer, with levels of detail',
  async t => {
    const [first, second] = [await t.createRenderer(), await t.createRenderer()]
    const size = 32
    const wave = ({ x, y, z }: Vector3, channel: number): number =>
      0.5 + 0.3 * Math.sin(2 * Math.PI * (x + channel / 4)) * Math.cos(2 * Math.PI * (y - z))
    const volume = (channels: number): Data3DTexture => {
      const bytes = new Uint8Array(channels * size ** 3)
      for (let i = 0; i < size ** 3; i++) {
        const place = new Vector3(i % size, Math.floor(i / size) % size, Math.floor(i / size ** 2))
        place.addScalar(0.5).divideScalar(size)
        for (let c = 0; c < channels; c++)
          bytes[channels * i + c] = Math.round(255 * wave(place, c))
      }
      const texture = new Data3DTexture(bytes, size, size, size)
      if (channels === 1) texture.format = RedFormat
      texture.minFilter = texture.magFilter = LinearFilter
      texture.wrapS = texture.wrapT = texture.wrapR = RepeatWrapping
      texture.needsUpdate = true
      return texture
    }
    const own = { weather: volume(4), shape: volume(4), detail: volume(1) }
    const noise = new CloudNoise({
      weather: noiseVolume(own.weather),
      shape: noiseVolume(own.shape),
      detail: noiseVolume(own.detail)
    })
    // As clouds of either renderer do, which share the noise.
    const field = new CloudField(new Atmosphere(), new CloudLayers(), undefined, { noise })
    const next = random(5)
    const places = Array.from({ length: 128 }, () => [next(), next(), next()].map(Math.fround))
    for (const renderer of [first, second]) {
      field.bake(renderer)
      for (const name of ['weather', 'shape', 'detail'] as const) {
        const node = texture3D(noise[name].target.texture) as unknown as LevelTexture<Vec3>
        const at = (level: number): Promise<Float32Array> =>
          evaluateOnGpu(renderer, places, p => {
            const texel = node.sample(p.xyz).level(level)
            return name === 'detail' ? vec4(texel.x, 0, 0, 0) : texel
          })
        const channels = name === 'detail' ? 1 : 4
        const expected = places.flatMap(([x, y, z]) =>
          [0, 1, 2, 3].map(c => (c < channels ? wave(new Vector3(x, y, z), c) : 0))
        )
        expectClose(await at(0), expected, { relative: 0, absolute: 0.012 })
        const means = places.flatMap(() => [0, 1, 2, 3].map(c => (c < channels ? 0.5 : 0)))
        expectClose(await at(7), means, { relative: 0, absolute: 0.01 })
      }
      await renderer.dispose()
    }
    noise.dispose()
    for (const texture of Object.values(own)) texture.dispose()
  }
)

import { Atmosphere } from '@welkin/atmosphere'
import { CloudField, CloudLayers, cloudPreset } from '@welkin/clouds'
import {
  DataTexture,
  LinearFilter,
  LinearMipmapLinearFilter,
  PerspectiveCamera,
  RepeatWrapping,
  Vector3
} from 'three'
import { float, Loop, texture3D, vec3, vec4 } from 'three/tsl'
import type { Node, NodeFrame, WebGPURenderer } from 'three/webgpu'
import {
  cloudExtinction as extinctionTwin,
  type CloudState
} from '../../packages/clouds/test/twins/density'
import { NoiseTextures } from '../../packages/clouds/test/twins/noiseTextures'
import { NOISE_SIZE, type NoiseName } from '../../packages/clouds/src/noise/noiseSizes'
import { cloudColumn } from '../../packages/clouds/src/density/tsl/columns'
import {
  clearanceAt,
  cloudBound,
  cloudExtinction
} from '../../packages/clouds/src/density/tsl/density'
import { random } from './harness/atmosphere'
import { CloudColumns, highestPeak, PlanetColumns } from './harness/cloud-columns'
import type { GpuContext } from './harness/context'
import { evaluateOnGpu } from './harness/evaluate'
import { expectClose, expectFinite, expectTrue } from './harness/expect'
import { gpuTest } from './harness/gpu-test'
import { reuseTables } from './harness/reuse-tables'

const twin = new NoiseTextures()
const mean = (values: ArrayLike<number>): number =>
  Array.from(values).reduce((a, b) => a + b, 0) / values.length
const names = Object.keys(NOISE_SIZE) as NoiseName[]

type Place = { longitude: number; latitude: number; height?: number }

interface Scene {
  renderer: WebGPURenderer
  field: CloudField
  /** The camera from the planet's centre, in the mapped space. */
  eye: Vector3
  update: (seconds?: number) => void
  extinction: (offset: Node<'vec3'>, distance: Node<'float'>, detail: boolean) => Node<'float'>
  state: () => CloudState
  dispose: () => void
}

/** Baked clouds, seen from a place. */
async function cloudScene(
  t: GpuContext,
  layers: CloudLayers,
  place: Place,
  map: DataTexture | null = null
): Promise<Scene> {
  const renderer = await t.createRenderer()
  const atmosphere = new Atmosphere().place(place)
  const camera = new PerspectiveCamera()
  camera.updateMatrixWorld()
  const field = new CloudField(atmosphere, layers, undefined, { worldMap: map })
  const eye = new Vector3()
  const update = (seconds = 0): void => {
    const view = atmosphere.update(renderer, camera)
    field.view.update({ renderer, camera } as unknown as NodeFrame)
    field.update(view, seconds)
    eye.copy(view.up).multiplyScalar(atmosphere.parameters.bottomRadius + view.height)
  }
  update()
  expectTrue(field.values[0].z === 0, 'clouds before their noise is drawn')
  field.bake(renderer)
  update()
  expectTrue(field.values[0].z > 0, 'no clouds when their noise is drawn')
  return {
    renderer,
    field,
    eye,
    update,
    extinction(offset, distance, detail) {
      const { altitude, up } = field.view.place(offset)
      return cloudExtinction(field, { offset, altitude, up, distance }, detail)
    },
    state: () => ({
      layers: [...layers].map(layer => layer.parameters),
      turns: field.turns,
      bottomRadius: atmosphere.parameters.bottomRadius,
      pixelAngle: field.pixelAngle.value,
      axialRatio: field.axialRatio,
      ...(map === null ? {} : { worldMap: coverOf(map), worldMapWidth: field.worldMapWidth })
    }),
    dispose() {
      field.dispose()
      atmosphere.dispose()
    }
  }
}

/** A cover that is smooth on the sphere, as an equirectangular picture. */
function worldMap(): DataTexture {
  const [width, height] = [512, 256]
  const bytes = new Uint8Array(4 * width * height)
  for (let y = 0; y < height; y++) {
    for (let x = 0; x < width; x++) {
      const longitude = ((x + 0.5) / width - 0.5) * 2 * Math.PI
      const latitude = ((y + 0.5) / height - 0.5) * Math.PI
      const across = Math.cos(latitude)
      const wave = Math.sin(3 * across * Math.cos(longitude) + 2 * across * Math.sin(longitude) + 1)
      bytes[4 * (y * width + x)] = 255 * (0.5 + 0.4 * wave)
    }
  }
  const map = new DataTexture(bytes, width, height)
  map.minFilter = LinearMipmapLinearFilter
  map.magFilter = LinearFilter
  map.generateMipmaps = true
  map.wrapS = RepeatWrapping
  map.needsUpdate = true
  return map
}

/** What the GPU reads of a map's finest level, by longitude and latitude [rad]. */
function coverOf(map: DataTexture): (longitude: number, latitude: number) => number {
  const { data, width, height } = map.image
  const texel = (x: number, y: number): number => {
    const row = Math.min(Math.max(y, 0), height - 1)
    return Number(data?.[4 * (row * width + ((x + width) % width))]) / 255
  }
  return (longitude, latitude) => {
    const x = (longitude / (2 * Math.PI) + 0.5) * width - 0.5
    const y = (latitude / Math.PI + 0.5) * height - 0.5
    const [i, j] = [Math.floor(x), Math.floor(y)]
    const row = (k: number): number => texel(i, k) + (texel(i + 1, k) - texel(i, k)) * (x - i)
    return row(j) + (row(j + 1) - row(j)) * (y - j)
  }
}

/** Offsets from an eye to points at random altitudes, up to a horizontal distance away. */
function offsets(
  eye: Vector3,
  count: number,
  reach: number,
  seed: number,
  altitude = (share: number): number => 12_000 * share ** 2
): number[][] {
  const draw = random(seed)
  const up = eye.clone().normalize()
  const side = new Vector3(up.y, up.z, up.x).cross(up).normalize()
  const other = side.clone().cross(up)
  const ground = eye.length()
  return Array.from({ length: count }, () => {
    const angle = 2 * Math.PI * draw()
    const away = reach * Math.sqrt(draw())
    const point = eye
      .clone()
      .addScaledVector(side, away * Math.cos(angle))
      .addScaledVector(other, away * Math.sin(angle))
      .setLength(ground + altitude(draw()))
      .sub(eye)
    return [...point.toArray(), point.length()].map(Math.fround)
  })
}

gpuTest('bakes the noise that float64 computes, levels of detail and all', async t => {
  reuseTables(false)
  const renderer = await t.createRenderer()
  const field = new CloudField(new Atmosphere(), new CloudLayers())
  let frames = 0
  do {
    expectTrue(!field.noise.isReady && frames < 40, `not drawn after ${frames} frames`)
    frames++
  } while (!field.bake(renderer, 24))
  t.note(`${frames} frames of 24 slices, ${field.noise.bytes} bytes`)
  expectTrue(frames > 20, `drawn in ${frames} frames`)
  expectTrue(field.noise.bytes <= 20e6, `${field.noise.bytes} bytes of noise`)
  const draw = random(1)
  for (const name of names) {
    const source = texture3D(field.noise[name].target.texture)
    for (const level of [0, 1, 2.5]) {
      // Beyond the period, too: it repeats.
      const inputs = Array.from({ length: level === 0 ? 60 : 6 }, () =>
        [4, 4, 4].map(range => Math.fround(range * draw() - 1))
      )
      const results = await evaluateOnGpu(renderer, inputs, input =>
        vec4(
          (source.sample(input.xyz) as unknown as { level: (n: Node) => Node<'vec4'> }).level(
            float(level)
          )
        )
      )
      inputs.forEach(([x, y, z], i) => {
        const expected = twin.sample(name, [x, y, z], level)
        const got = results.subarray(4 * i, 4 * i + expected.length)
        expectClose(got, expected, { absolute: 0.012 }, `${name} level ${level}`)
      })
    }
  }
  field.dispose()
})

/** Altitudes in one of the layers each, by a number in [0, 1). */
const altitudeIn =
  (layers: CloudLayers) =>
  (share: number): number => {
    const place = layers.length * share
    const { baseAltitude, topAltitude } = layers.at(Math.floor(place)).parameters
    return baseAltitude + (topAltitude - baseAltitude) * (place % 1)
  }

const places: [string, Place][] = [
  ['in Europe', { longitude: 20, latitude: 45 }],
  ['at the date line', { longitude: 180, latitude: -17 }],
  ['at the pole', { longitude: 0, latitude: 90 }]
]

for (const [where, place] of places) {
  gpuTest(`puts clouds where float64 does ${where}`, async t => {
    const layers = cloudPreset('mixed')
    for (const layer of layers) layer.set({ coverage: 0.7 })
    const scene = await cloudScene(t, layers, place)
    scene.update(7200)
    let cloudy = 0
    for (const detail of [false, true]) {
      const inputs = offsets(scene.eye, 60, 20_000, 7, altitudeIn(layers))
      const results = await evaluateOnGpu(scene.renderer, inputs, input =>
        scene.extinction(input.xyz, input.w, detail)
      )
      const state = scene.state()
      const differences = inputs.map(([x, y, z, distance], i) => {
        const position = scene.eye.clone().add(new Vector3(x, y, z))
        const expected = extinctionTwin(state, twin, position, distance, detail)
        if (expected > 0) cloudy++
        return Math.abs(results[4 * i] - expected) / 0.05
      })
      const worst = differences.toSorted((a, b) => b - a)
      t.note(
        `detail ${detail}: worst ${worst
          .slice(0, 3)
          .map(x => x.toFixed(4))
          .join(' ')}`
      )
      // A byte of the noise is 0.03 of the density at a sharp edge.
      expectTrue(worst[0] < 0.04, `worst difference ${worst[0]} of full density`)
    }
    expectTrue(cloudy > 30, `${cloudy} cloudy points`)
    scene.dispose()
  })
}

/** Without shape, whose coarse levels take float64 minutes. */
class ShapelessTwin extends NoiseTextures {
  override sample(name: NoiseName, p: readonly [number, number, number], level: number): number[] {
    return name === 'shape' ? [0.5, 0.5] : twin.sample(name, p, level)
  }
}

gpuTest('puts clouds where float64 does, of a world map and where they blur', async t => {
  const layers = cloudPreset('mixed')
  for (const layer of layers) layer.set({ coverage: 0.5, shapeAmount: 0 })
  const map = worldMap()
  const scene = await cloudScene(t, layers, { longitude: 100, latitude: -30 }, map)
  const shapeless = new ShapelessTwin()
  // Their footprints are up to 1.2 km.
  scene.field.pixelAngle.value = 0.12
  const inputs = offsets(scene.eye, 15, 2000, 7, altitudeIn(layers))
  const results = await evaluateOnGpu(scene.renderer, inputs, input =>
    scene.extinction(input.xyz, input.w, false)
  )
  const state = scene.state()
  let cloudy = 0
  const differences = inputs.map(([x, y, z, distance], i) => {
    const position = scene.eye.clone().add(new Vector3(x, y, z))
    const expected = extinctionTwin(state, shapeless, position, distance, false)
    if (expected > 0) cloudy++
    return Math.abs(results[4 * i] - expected) / 0.05
  })
  t.note(`worst ${Math.max(...differences).toExponential(1)}`)
  expectTrue(cloudy > 10, `${cloudy} cloudy points`)
  expectTrue(Math.max(...differences) < 0.002, `worst difference ${Math.max(...differences)}`)
  scene.dispose()
  map.dispose()
})

gpuTest('bounds the density from above, in every preset', async t => {
  for (const name of ['fairWeather', 'stratocumulus', 'cumulonimbus', 'cirrus'] as const) {
    const scene = await cloudScene(t, cloudPreset(name), { longitude: 20, latitude: 45 })
    const inputs = offsets(scene.eye, 4096, 300_000, 3)
    const results = await evaluateOnGpu(scene.renderer, inputs, input => {
      const offset = input.xyz.toConst() as unknown as Node<'vec3'>
      const { altitude, up } = scene.field.view.place(offset)
      const sample = { offset, altitude, up, distance: input.w }
      const column = cloudColumn(scene.field, sample)
      return vec4(
        cloudBound(scene.field, sample),
        cloudExtinction(scene.field, sample, true),
        column,
        1
      )
    })
    let [clear, empty] = [0, 0]
    inputs.forEach((_, i) => {
      const [bound, extinction, column] = results.subarray(4 * i, 4 * i + 3)
      expectTrue(bound > 0 || extinction === 0, `${name}: ${extinction} where the bound is 0`)
      expectTrue(column >= 0 && column < 1000, `${name}: column of ${column}`)
      if (bound === 0) clear++
      if (extinction === 0) empty++
    })
    t.note(`${name}: bound finds ${clear} of ${empty} empty places`)
    scene.dispose()
  }
})

gpuTest('has clear air as far as it says', async t => {
  for (const name of ['fairWeather', 'stratocumulus', 'cumulonimbus'] as const) {
    const scene = await cloudScene(t, cloudPreset(name), { longitude: 20, latitude: 45 })
    const { field } = scene
    const inputs = offsets(scene.eye, 2048, 30_000, 5, share => 3000 * share)
    const results = await evaluateOnGpu(scene.renderer, inputs, input => {
      const offset = input.xyz.toConst() as unknown as Node<'vec3'>
      const here = { offset, ...field.view.place(offset), distance: input.w }
      const clearance = clearanceAt(field, here).toConst()
      const most = float(0).toVar()
      const count = 24
      Loop(count, ({ i }) => {
        // Spread over the ball.
        const index = float(i)
        const z = index
          .add(0.5)
          .mul(2 / count)
          .oneMinus()
          .toConst()
        const across = z.mul(z).oneMinus().sqrt()
        const angle = index.mul(2.399963)
        const towards = vec3(across.mul(angle.cos()), across.mul(angle.sin()), z)
        const radius = clearance.min(1e4).mul(index.mul(0.618034).fract().sqrt())
        const there = offset.add(towards.mul(radius)).toConst() as unknown as Node<'vec3'>
        most.assign(most.max(scene.extinction(there, input.w, true)))
      })
      return vec4(clearance, most, scene.extinction(offset, input.w, true), 1)
    })
    let clear = 0
    inputs.forEach((_, i) => {
      const [clearance, most, extinction] = results.subarray(4 * i, 4 * i + 3)
      expectTrue(clearance >= 0, `${name}: a clearance of ${clearance}`)
      expectTrue(
        clearance === 0 || most === 0,
        `${name}: ${most} within ${clearance} m of clear air`
      )
      if (clearance > 100 && extinction === 0) clear++
    })
    t.note(`${name}: ${clear} of ${inputs.length} places have 100 m of clear air`)
    expectTrue(clear > inputs.length / 10, `${name}: only ${clear} places have clear air`)
    scene.dispose()
  }
})

gpuTest('follows a layer without compiling', async t => {
  const layers = new CloudLayers()
  const scene = await cloudScene(t, layers, { longitude: 20, latitude: 45 })
  const columns = new CloudColumns(scene.field, 64, 20_000, 8)
  const before = mean((await columns.draw(scene.renderer)).depth)
  layers.at(0).set({ coverage: 0.9 })
  scene.update()
  const after = mean((await columns.draw(scene.renderer)).depth)
  expectTrue(after > 2 * before, `mean depth ${before} then ${after}`)
  expectTrue(columns.builds === 1, `${columns.builds} builds of the shader`)
  columns.dispose()
  scene.dispose()
})

gpuTest('covers the share of the sky that a layer asks for, all over the planet', async t => {
  const layers = cloudPreset('fairWeather')
  const { renderer, field, eye, update, dispose } = await cloudScene(t, layers, {
    longitude: 20,
    latitude: 45
  })
  const { baseAltitude, topAltitude } = layers.at(0).parameters
  const count = 4096
  // A spiral of even density.
  const inputs = Array.from({ length: count }, (_, i) => {
    const z = (2 * i + 1) / count - 1
    const [across, angle] = [Math.sqrt(1 - z * z), 2.399963 * i]
    const place = new Vector3(across * Math.cos(angle), across * Math.sin(angle), z)
    return [...place.multiplyScalar(field.radius.value).sub(eye).toArray(), 2000].map(Math.fround)
  })
  const steps = 12
  const misses: string[] = []
  for (const [coverage, weatherWeights] of [
    [0, [1, 0, 0, 0]],
    [0.2, [1, 0, 0, 0]],
    [0.5, [1, 0, 0, 0]],
    [0.8, [1, 0, 0, 0]],
    [1, [1, 0, 0, 0]],
    [0.5, [0, 1, 0, 0]]
  ] as [number, [number, number, number, number]][]) {
    layers.at(0).set({ coverage, weatherWeights })
    update()
    const depths = await evaluateOnGpu(renderer, inputs, input => {
      const ground = input.xyz
      const zenith = field.view.place(ground).up.toConst()
      const depth = float(0).toVar()
      Loop(steps, ({ i }) => {
        const height = float(i as never)
          .add(0.5)
          .div(steps)
          .mul(topAltitude - baseAltitude)
          .add(baseAltitude)
        const offset = ground.add(zenith.mul(height)).toConst() as Node<'vec3'>
        const sample = { offset, ...field.view.place(offset), distance: float(2000) }
        const extinction = cloudExtinction(field, sample, false)
        depth.addAssign(extinction.mul((topAltitude - baseAltitude) / steps))
      })
      return depth
    })
    const covered = inputs.filter((_, i) => depths[4 * i] > 0.7).length / count
    t.note(`${coverage} covers ${covered.toFixed(3)}`)
    if (Math.abs(covered - coverage) > 0.04) misses.push(`${coverage} covers ${covered}`)
  }
  expectTrue(misses.length === 0, misses.join(', '))
  dispose()
})

gpuTest('keeps the clouds of an area from 2 km to the whole globe', async t => {
  const layers = cloudPreset('fairWeather')
  const scene = await cloudScene(t, layers, { longitude: 20, latitude: 45 })
  const columns = new CloudColumns(scene.field, 128, 200_000, 12)
  const misses: string[] = []
  // Optical depths as they are, and as a march counts them.
  for (const [coverage, longitude, depthScale] of [
    [0.03, 20, 0.6],
    [0.05, 20, 0.6],
    [0.1, 20, 0.6],
    [0.2, 20, 1],
    [0.4, 20, 0.6],
    [0.7, 20, 1],
    [0.08, -120, 1],
    [0.93, 20, 1],
    [0.4, -120, 1],
    [0.7, -120, 0.6]
  ]) {
    layers.at(0).set({ coverage })
    scene.field.depthScale.value = depthScale
    scene.field.atmosphere.place({ longitude, latitude: 45 })
    scene.update()
    const means: number[] = []
    for (const distance of [2e3, 1e4, 3e4, 1e5, 2e5, 4e5, 1e6, 3e6]) {
      columns.distance = distance
      const { depth } = await columns.draw(scene.renderer)
      means.push(1 - mean(depth.map(tau => Math.exp(-depthScale * tau))))
    }
    t.note(`${coverage} at ${longitude}°: opacity ${means.map(x => x.toFixed(3)).join(' ')}`)
    const worst = Math.max(...means.map(x => Math.abs(x - means[0])))
    if (worst > 0.04) misses.push(`coverage ${coverage}: opacity changes by ${worst}`)
  }
  expectTrue(misses.length === 0, misses.join(', '))
  columns.dispose()
  scene.dispose()
})

gpuTest('covers what is asked for, from near and far', async t => {
  const layers = new CloudLayers([{}])
  const scene = await cloudScene(t, layers, { longitude: 20, latitude: 45 })
  const { field } = scene
  const [size, steps, depthScale] = [96, 16, 0.6]
  field.depthScale.value = depthScale
  const columns = new PlanetColumns(field, size, steps)
  const misses: string[] = []
  for (const [name, index] of [
    ['fairWeather', 0],
    ['stratocumulus', 0],
    ['cumulonimbus', 0]
  ] as const) {
    for (const coverage of [0, 0.03, 0.1, 0.2, 0.5, 0.8, 0.95, 1]) {
      layers.at(0).set({ ...cloudPreset(name).at(index).parameters, coverage })
      scene.update()
      const found: number[] = []
      for (const distance of [500, 3e5, 1e6, 2e7]) {
        const depth = await columns.draw(scene.renderer, layers.at(0).parameters, distance)
        found.push(1 - mean(depth.map(tau => Math.exp(-depthScale * tau))))
      }
      t.note(`${name} ${coverage}: ${found.map(x => x.toFixed(3)).join(' ')}`)
      const worst = Math.max(...found.map(x => Math.abs(x - coverage)))
      if (worst > 0.05) misses.push(`${name}: ${found.join(' ')} for ${coverage}`)
    }
  }
  expectTrue(misses.length === 0, misses.join(', '))
  columns.dispose()
  scene.dispose()
})

gpuTest('descends to the clouds of a world map without a pop, whatever they are', async t => {
  const map = worldMap()
  for (const [name, limit] of [
    ['fairWeather', 0.05],
    ['cumulonimbus', 0.06],
    ['cirrus', 0.1]
  ] as const) {
    const layers = cloudPreset(name)
    layers.at(0).set({ coverage: 0.5 })
    for (let i = 1; i < layers.length; i++) layers.at(i).set({ coverage: 0 })
    const scene = await cloudScene(t, layers, { longitude: 100, latitude: -30 }, map)
    const columns = new CloudColumns(scene.field, 96, 600_000, 12)
    for (const longitude of [100, 60]) {
      scene.field.atmosphere.place({ longitude, latitude: -30 })
      scene.update()
      const means: number[] = []
      for (const distance of [2e3, 2e5, 1e6, 2e6, 4e6, 2e7]) {
        columns.distance = distance
        means.push(1 - mean((await columns.draw(scene.renderer)).light))
      }
      t.note(`${name} at ${longitude}°: opacity ${means.map(x => x.toFixed(3)).join(' ')}`)
      const worst = Math.max(...means.map(x => Math.abs(x - means[0])))
      expectTrue(worst < limit, `${name} at ${longitude}°: opacity changes by ${worst}`)
    }
    columns.dispose()
    scene.dispose()
  }
  map.dispose()
})

gpuTest('shows no lattice in an overcast sky from below', async t => {
  const size = 128
  // Wider than the noise's periods by far.
  const width = 90_000
  for (const place of places.map(([, p]) => p)) {
    const layers = new CloudLayers([
      { coverage: 0.95, density: 0.004, weatherWeights: [0, 1, 0, 0] }
    ])
    const scene = await cloudScene(t, layers, place)
    const columns = new CloudColumns(scene.field, size, width, 16)
    const { light } = await columns.draw(scene.renderer)
    const { ratio, wave } = highestPeak(light, size)
    t.note(`highest peak ${ratio.toFixed(1)} times the mean of its ring, at ${wave.join(', ')}`)
    // Noise without a lattice: the highest of 6,000 powers, exponentially distributed, is about 9.
    expectTrue(ratio < 18, `a peak of ${ratio} times the noise floor at ${wave.join(', ')}`)
    if (place === places[0][1]) {
      // The same noise as it repeats, for comparison: rows of puffs along its axes.
      const { shape } = scene.field.textures
      const inputs = Array.from({ length: size ** 2 }, (_, i) => [i % size, Math.floor(i / size)])
      const texels = await evaluateOnGpu(scene.renderer, inputs, input => {
        const at = vec3(input.xy.mul(width / size / 2600), 0.3)
        return shape.sample(at).level(2)
      })
      const rows = highestPeak(
        inputs.map((_, i) => texels[4 * i]),
        size
      )
      t.note(`rows of puffs: ${rows.ratio.toFixed(0)} at ${rows.wave.join(', ')}`)
      expectTrue(rows.ratio > 36, `rows of puffs would pass, with a peak of ${rows.ratio}`)
    }
    columns.dispose()
    scene.dispose()
  }
})

gpuTest('has no seam in a world map', async t => {
  const renderer = await t.createRenderer()
  const map = worldMap()
  const atmosphere = new Atmosphere()
  atmosphere.frame = 'ecef'
  const layers = new CloudLayers([{ coverage: 0.5, baseAltitude: 0, topAltitude: 1500 }])
  const field = new CloudField(atmosphere, layers, undefined, { worldMap: map })
  field.bake(renderer)
  const camera = new PerspectiveCamera()
  const seams: [string, (s: number) => [number, number]][] = [
    ['180° meridian', s => [180 + 0.2 * s, 30]],
    ['north pole', s => [s < 0 ? 10 : 190, 90 - 0.1 * Math.abs(s)]],
    ['south pole', s => [s < 0 ? -70 : 110, -90 + 0.1 * Math.abs(s)]]
  ]
  for (const [name, at] of seams) {
    const points = Array.from({ length: 101 }, (_, i) => {
      const [longitude, latitude] = at((i - 50) / 50)
      return atmosphere.ellipsoid.geodeticToECEF({
        longitude: ((longitude + 180) % 360) - 180,
        latitude,
        height: 700
      })
    })
    // From orbit, where only the map is seen.
    camera.position.copy(points[50]).multiplyScalar(3)
    camera.updateMatrixWorld()
    const view = atmosphere.update(renderer, camera)
    field.view.update({ renderer, camera } as unknown as NodeFrame)
    field.update(view, 0)
    field.pixelAngle.value = 0.002
    const eye = view.up.clone().multiplyScalar(atmosphere.parameters.bottomRadius + view.height)
    const inputs = points.map(point => {
      const offset = atmosphere.space.position(point, new Vector3()).sub(eye)
      return [...offset.toArray(), offset.length()].map(Math.fround)
    })
    const results = await evaluateOnGpu(renderer, inputs, input => {
      const offset = input.xyz.toConst() as unknown as Node<'vec3'>
      const { altitude, up } = field.view.place(offset)
      return cloudColumn(field, { offset, altitude, up, distance: input.w })
    })
    const depths = inputs.map((_, i) => results[4 * i])
    expectFinite(depths)
    const steps = depths.slice(1).map((depth, i) => Math.abs(depth - depths[i]) / mean(depths))
    t.note(
      `${name}: depth ${mean(depths).toFixed(2)}, largest step ${Math.max(...steps).toFixed(4)}`
    )
    expectTrue(mean(depths) > 0.05, `${name}: mean depth ${mean(depths)}`)
    expectTrue(Math.max(...steps) < 0.05, `${name}: a step of ${Math.max(...steps)}`)
  }
  field.dispose()
  atmosphere.dispose()
  map.dispose()
})

gpuTest('gives numbers for any parameters', async t => {
  const draw = random(11)
  const pick = (...values: number[]): number => values[Math.floor(draw() * values.length)]
  const layers = new CloudLayers([{}, {}, {}, {}])
  const scene = await cloudScene(t, layers, { longitude: -75, latitude: -60, height: 3000 })
  const inputs = [
    ...offsets(scene.eye, 400, 50_000, 5),
    ...offsets(scene.eye, 100, 3_000_000, 6),
    [0, 0, 0, 0],
    [0, 0, 0, 1e9],
    [scene.eye.x, scene.eye.y, scene.eye.z, 1e7],
    [-scene.eye.x, -scene.eye.y, -scene.eye.z, 1e7]
  ]
  for (let round = 0; round < 12; round++) {
    for (const layer of layers) {
      const baseAltitude = pick(0, 500, 29_999)
      layer.set({
        baseAltitude,
        topAltitude: pick(baseAltitude + 1e-3, baseAltitude + 1, 30_000),
        coverage: pick(0, 1e-6, 0.5, 1),
        density: pick(0, 1e-9, 0.05, 1),
        profileExponent: pick(1e-9, 0.01, 1, 8),
        shapeAmount: pick(0, 0.5, 1),
        detailAmount: pick(0, 1),
        weatherWeights: [pick(0, 1), pick(0, 1e-9), pick(0, 1), pick(0, 1)],
        wind: { east: pick(0, 1e6), north: pick(0, -1e9) }
      })
    }
    scene.update(pick(0, 1, 1e12))
    const results = await evaluateOnGpu(scene.renderer, inputs, input => {
      const offset = input.xyz.toConst() as unknown as Node<'vec3'>
      const { altitude, up } = scene.field.view.place(offset)
      const sample = { offset, altitude, up, distance: input.w }
      return vec4(
        cloudExtinction(scene.field, sample, true),
        cloudBound(scene.field, sample),
        cloudColumn(scene.field, sample),
        1
      )
    })
    expectFinite(results, `round ${round}`)
    expectTrue(
      results.every(x => x >= 0),
      `round ${round}: a negative extinction`
    )
  }
  scene.dispose()
})

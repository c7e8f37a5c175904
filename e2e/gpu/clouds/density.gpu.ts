import { Atmosphere } from '@welkin/atmosphere'
import type { AtmosphereView } from '@welkin/atmosphere'
import { CloudField, CloudLayers, cloudPreset, precipitationShafts } from '@welkin/clouds'
import type { PrecipitationShafts } from '@welkin/clouds'
import { MathUtils, Vector3 } from 'three'
import { float, int, Loop, texture3D, vec4 } from 'three/tsl'
import type { Node } from 'three/webgpu'
import { cloudExtinction as extinctionTwin } from '../../../packages/clouds/test/twins/density'
import { extinctionOf, fallenRank, rateOf } from '../../../packages/clouds/test/twins/precipitation'
import { layerAt } from '../../../packages/clouds/src/density/tsl/layer'
import { fallForm } from '../../../packages/clouds/src/precipitation/fallForm'
import { fallenFrom } from '../../../packages/clouds/src/precipitation/tsl/fall'
import { fallExtinctions } from '../../../packages/clouds/src/precipitation/tsl/fallExtinctions'
import { NoiseTextures } from '../../../packages/clouds/test/twins/noiseTextures'
import { NOISE_SIZE, type NoiseName } from '../../../packages/clouds/src/noise/noiseSizes'
import { cloudExtinction, verticalOpticalDepth } from '../harness/cloud-extinction'
import { random } from '../harness/atmosphere'
import { CloudColumns } from '../harness/cloud-columns'
import { cloudScene, mean, altitudeIn, offsets, places, worldMap } from '../harness/cloud-scene'
import { evaluateOnGpu } from '../harness/evaluate'
import { expectClose, expectFinite, expectTrue } from '../harness/expect'
import { gpuTest } from '../harness/gpu-test'
import { keepTables, reuseTables } from '../harness/reuse-tables'

const twin = new NoiseTextures()
const names = Object.keys(NOISE_SIZE) as NoiseName[]

/** Slices of textures that WebGL bakes in part. */
const SLICES = 6

gpuTest(
  'bakes the noise that float64 computes, levels of detail and all',
  async t => {
    const renderer = await t.createRenderer()
    const field = new CloudField(new Atmosphere(), new CloudLayers())
    // The functions are the same on both backends: on WebGL some slices tell, and one texture that is whole.
    const isWhole = (name: NoiseName): boolean => t.backend === 'webgpu' || name === 'detail'
    if (t.backend === 'webgpu') {
      // Keeps what it bakes, for later tests, and takes nothing.
      reuseTables(true, false)
      let frames = 0
      do {
        expectTrue(!field.noise.isReady && frames < 40, `not drawn after ${frames} frames`)
        frames++
      } while (!field.bake(renderer, 10))
      t.note(`${frames} frames of 10 slices`)
      expectTrue(frames > 20, `drawn in ${frames} frames`)
    } else {
      for (const name of names) {
        const steps = field.noise[name].bake(renderer)
        for (let slice = 0; isWhole(name) || slice < SLICES; slice++) if (steps.next().done) break
      }
    }
    const draw = random(1)
    for (const name of names) {
      const source = texture3D(field.noise[name].target.texture)
      for (const level of isWhole(name) ? [0, 1, 2.5] : [0]) {
        // Beyond the period, too: it repeats.
        const inputs = Array.from({ length: level === 0 ? 60 : 6 }, () => {
          const [x, y, z] = [4, 4, 4].map(range => range * draw() - 1)
          const inSlices = (0.5 + (SLICES - 1) * ((z + 1) / 4)) / NOISE_SIZE[name]
          return [x, y, isWhole(name) ? z : inSlices].map(Math.fround)
        })
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
    await keepTables()
    field.dispose()
  },
  { bakes: true }
)

for (const [where, place] of places) {
  gpuTest(
    `puts clouds where float64 does ${where}`,
    async t => {
      const layers = cloudPreset('mixed')
      for (const layer of layers) layer.set({ coverage: 0.85 })
      const scene = await cloudScene(t, layers, place)
      scene.update(7200)
      let cloudy = 0
      for (const detail of [false, true]) {
        const inputs = offsets(scene.viewpoint, 60, 20_000, 7, altitudeIn(layers))
        const results = await evaluateOnGpu(scene.renderer, inputs, input =>
          scene.extinction(input.xyz, input.w, detail)
        )
        const state = scene.state()
        const differences = inputs.map(([x, y, z, distance], i) => {
          const position = scene.viewpoint.clone().add(new Vector3(x, y, z))
          const expected = extinctionTwin(state, twin, position, distance, detail)
          if (expected > 0) cloudy++
          return Math.abs(results[4 * i] - expected) / 0.1
        })
        const worst = differences.toSorted((a, b) => b - a)
        t.note(
          `detail ${detail}: worst ${worst
            .slice(0, 3)
            .map(x => x.toFixed(4))
            .join(' ')}`
        )
        // A byte of the noise is 0.1 of the density at a sharp edge: both have the same bytes.
        expectTrue(worst[0] < 0.015, `worst difference ${worst[0]} of full density`)
      }
      expectTrue(cloudy > 30, `${cloudy} cloudy points`)
      scene.dispose()
    },
    // Where they are is known in float64: one place shows that WebGL's shader is the same.
    { backends: where === 'in Europe' ? ['webgpu', 'webgl'] : ['webgpu'] }
  )
}

gpuTest('puts storms where float64 does', async t => {
  const layers = cloudPreset('cumulonimbus')
  const scene = await cloudScene(t, layers, { longitude: 20, latitude: 45 })
  scene.update(3600)
  const { baseAltitude, topAltitude, density } = layers.at(0).parameters
  const inputs = offsets(
    scene.viewpoint,
    120,
    30_000,
    9,
    share => baseAltitude + (topAltitude - baseAltitude) * share
  )
  for (const detail of [false, true]) {
    const results = await evaluateOnGpu(scene.renderer, inputs, input =>
      scene.extinction(input.xyz, input.w, detail)
    )
    const state = scene.state()
    let cloudy = 0
    const differences = inputs.map(([x, y, z, distance], i) => {
      const position = scene.viewpoint.clone().add(new Vector3(x, y, z))
      const expected = extinctionTwin(state, twin, position, distance, detail)
      if (expected > 0) cloudy++
      return Math.abs(results[4 * i] - expected) / density
    })
    const worst = differences.toSorted((a, b) => b - a)
    const told = worst.slice(0, 3).map(x => x.toFixed(4))
    t.note(`detail ${detail}: ${cloudy} cloudy points, worst ${told.join(' ')}`)
    expectTrue(worst[0] < 0.015, `worst difference ${worst[0]} of full density`)
    expectTrue(cloudy > 15, `${cloudy} cloudy points`)
  }
  scene.dispose()
})

/** Twin of the noise without shape, whose coarse levels take float64 minutes. */
class ShapelessTwin extends NoiseTextures {
  override sample(name: NoiseName, p: readonly [number, number, number], level: number): number[] {
    return name === 'shape' ? [0.5, 0.5, 0.5, 0.5] : twin.sample(name, p, level)
  }
}

gpuTest(
  'puts clouds where float64 does, of a world map and where they blur',
  async t => {
    const layers = cloudPreset('mixed')
    for (const layer of layers) layer.set({ coverage: 0.5, shapeAmount: 0, turbulence: 0 })
    const map = worldMap()
    const scene = await cloudScene(t, layers, { longitude: 100, latitude: -30 }, map)
    const shapeless = new ShapelessTwin()
    // Their footprints are up to 1.2 km.
    scene.field.pixelAngle.value = 0.3
    const inputs = offsets(scene.viewpoint, 15, 2000, 7, altitudeIn(layers))
    const results = await evaluateOnGpu(scene.renderer, inputs, input =>
      scene.extinction(input.xyz, input.w, false)
    )
    const state = scene.state()
    let cloudy = 0
    const differences = inputs.map(([x, y, z, distance], i) => {
      const position = scene.viewpoint.clone().add(new Vector3(x, y, z))
      const expected = extinctionTwin(state, shapeless, position, distance, false)
      if (expected > 0) cloudy++
      return Math.abs(results[4 * i] - expected) / 0.05
    })
    t.note(`worst ${Math.max(...differences).toExponential(1)}`)
    expectTrue(cloudy > 10, `${cloudy} cloudy points`)
    expectTrue(Math.max(...differences) < 0.002, `worst difference ${Math.max(...differences)}`)
    scene.dispose()
    map.dispose()
  },
  // On WebGL a world map is drawn without a seam, from clouds of its own: see coverage.
  { backends: ['webgpu'] }
)

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

/** Depth of the columns of rain [m], and samples in each. */
const RAIN_DEPTH = 950
const COLUMN_STEPS = 12

/** Optical depth of what falls from the field's only layer, straight up from the ground below a place. */
function rainDepth(
  field: CloudField,
  medium: PrecipitationShafts,
  place: Node<'vec4'>
): Node<'float'> {
  const depth = float(0).toVar()
  const start = place.xyz.toConst()
  const { altitude, up } = field.view.localCoordinates(start)
  const [layer, falls] = [layerAt(field, int(0)), medium.fallOf(int(0))]
  Loop(COLUMN_STEPS, ({ i }) => {
    const height = float(i as never)
      .add(0.5)
      .mul(RAIN_DEPTH / COLUMN_STEPS)
      .toConst()
    const offset = start.add(up.mul(height.sub(altitude))).toConst()
    const sample = { offset, altitude: height, up, distance: place.w }
    const { rate, snow, hail } = fallenFrom(field, undefined, layer, falls, sample)
    depth.addAssign(fallExtinctions(rate, snow, hail).x.mul(RAIN_DEPTH / COLUMN_STEPS))
  })
  return depth
}

gpuTest(
  'lets rain, snow and hail fall where float64 does, as opaque as their rates say',
  async t => {
    const rates = [0.5, 3, 12, 60]
    const [heaps, storms] = [
      [1, 0, 0, 0],
      [0, 0, 1, 0]
    ] as [number, number, number, number][]
    const layer = {
      coverage: 0.8,
      shapeAmount: 0,
      shear: 0.3,
      wind: { east: 12, north: -5 }
    }
    const layers = new CloudLayers([{ ...layer, precipitation: { rate: 1, freezingLevel: 600 } }])
    const scene = await cloudScene(t, layers, { longitude: 20, latitude: 45 })
    const medium = precipitationShafts()
    const inputs = offsets(scene.viewpoint, 40, 20_000, 21, share => 5 + 20 * share)
    const state = scene.state()
    const { zenith, bottomRadius } = state
    for (const rate of rates) {
      const [virgaDepth, hail] = [rate > 3 ? 900 : 0, rate === 60 ? 0.4 : 0]
      const falls = { rate, share: 0.7, freezingLevel: 600, virgaDepth, hail }
      const weatherWeights = rate === 12 ? storms : heaps
      layers.at(0).set({ precipitation: falls, weatherWeights })
      scene.update()
      medium.update(scene.field, { up: zenith } as AtmosphereView)
      const places = { ...state, layers: [layers.at(0).parameters] }
      const results = await evaluateOnGpu(scene.renderer, inputs, input =>
        vec4(rainDepth(scene.field, medium, input))
      )
      // As above: of the strongest column's.
      const deepest = extinctionOf(rateOf(rate, 1, 0, 0), 1, 0) * RAIN_DEPTH
      let wet = 0
      inputs.forEach(([x, y, z, distance], i) => {
        const place = scene.viewpoint.clone().add(new Vector3(x, y, z))
        const up = place.clone().normalize()
        let depth = 0
        for (let k = 0; k < COLUMN_STEPS; k++) {
          const altitude = (RAIN_DEPTH * (k + 0.5)) / COLUMN_STEPS
          const at = up.clone().multiplyScalar(bottomRadius + altitude)
          const rank = fallenRank(places, twin, 0, at, distance)
          const rateUnder = (column: number): number =>
            column > 0 ? rateOf(rate, column, 1000 - altitude, falls.virgaDepth) : 0
          const hailUnder = (column: number): number =>
            rateUnder(column) * hail * MathUtils.smoothstep(column, ...fallForm.hailFrom)
          const drops = rateUnder(rank) - hailUnder(rank)
          const snow = MathUtils.smoothstep(altitude, 600 - fallForm.melting, 600)
          const stones = hail > 0 ? hailUnder(fallenRank(places, twin, 0, at, distance, true)) : 0
          depth += (extinctionOf(drops, snow, stones) * RAIN_DEPTH) / COLUMN_STEPS
        }
        if (depth > 0.01) wet++
        const got = results[4 * i]
        expectTrue(
          Math.abs(got - depth) < 0.015 * deepest,
          `rate ${rate}: optical depth ${got} for ${depth}`
        )
      })
      expectTrue(wet > 8, `rate ${rate}: ${wet} columns with rain`)
    }
    scene.dispose()
  },
  { backends: ['webgpu'] }
)

gpuTest(
  'gives numbers for any parameters, of clouds and of what falls from them',
  async t => {
    const draw = random(11)
    const pick = (...values: number[]): number => values[Math.floor(draw() * values.length)]
    const layers = new CloudLayers([{}, {}, {}, {}])
    const scene = await cloudScene(t, layers, { longitude: -75, latitude: -60, height: 3000 })
    const medium = precipitationShafts()
    const inputs = [
      ...offsets(scene.viewpoint, 400, 50_000, 5),
      ...offsets(scene.viewpoint, 100, 3_000_000, 6),
      [0, 0, 0, 0],
      [0, 0, 0, 1e9],
      [scene.viewpoint.x, scene.viewpoint.y, scene.viewpoint.z, 1e7],
      [-scene.viewpoint.x, -scene.viewpoint.y, -scene.viewpoint.z, 1e7]
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
          baseRelief: pick(0, 1e-9, 0.5, 1),
          shapeAmount: pick(0, 0.5, 1),
          detailAmount: pick(0, 1),
          weatherScale: pick(0.1, 1, 10),
          shapeScale: pick(0.1, 1, 10),
          detailScale: pick(0.1, 1, 10),
          edgeSoftness: pick(0, 0.5, 1),
          turbulence: pick(0, 1, 2),
          shear: pick(-5, 0, 5),
          anvil: pick(0, 0.5, 1),
          openCells: pick(0, 0.5, 1),
          densityGrowth: pick(0, 1, 4),
          weatherWeights: [pick(0, 1), pick(0, 1e-9), pick(0, 1), pick(0, 1)],
          wind: { east: pick(0, 1e6), north: pick(0, -1e9) },
          precipitation: {
            rate: pick(0, 1e-3, 300),
            share: pick(1e-9, 0.5, 1),
            virgaDepth: pick(0, 1e-3, 20_000),
            freezingLevel: pick(-1000, 600, 30_000),
            hail: pick(0, 1),
            streaks: pick(0, 1, 3)
          }
        })
      }
      medium.update(scene.field, scene.update(pick(0, 1, 1e12)))
      const results = await evaluateOnGpu(scene.renderer, inputs, input => {
        const offset = input.xyz.toConst() as unknown as Node<'vec3'>
        const { altitude, up } = scene.field.view.localCoordinates(offset)
        const sample = { offset, altitude, up, distance: input.w }
        return vec4(
          cloudExtinction(scene.field, sample, true),
          cloudExtinction(scene.field, sample, false),
          verticalOpticalDepth(scene.field, sample),
          medium.extinctionAt(scene.field, layerAt(scene.field, int(0)), sample)
        )
      })
      expectFinite(results, `round ${round}`)
      expectTrue(
        results.every(x => x >= 0),
        `round ${round}: a negative extinction`
      )
    }
    scene.dispose()
  },
  { backends: ['webgpu'] }
)

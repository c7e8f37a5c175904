import type { AtmosphereView } from '@welkin/atmosphere'
import { CloudLayers, cloudPreset, precipitationShafts, type CloudPresetName } from '@welkin/clouds'
import { Vector3 } from 'three'
import { float, int, vec4 } from 'three/tsl'
import type { Node } from 'three/webgpu'
import { sampleLayer } from '../../../packages/clouds/src/density/tsl/sampleLayer'
import type { Float, Int, Vec3 } from '../../../packages/clouds/src/tsl-types'
import { layerAt } from '../../../packages/clouds/src/density/tsl/layer'
import {
  footprintOf,
  subpointOffset,
  type CloudSample
} from '../../../packages/clouds/src/density/tsl/sample'
import { weatherBackground } from '../../../packages/clouds/src/density/tsl/weatherBackground'
import { WeatherMap } from '../../../packages/clouds/src/density/WeatherMap'
import { fallColumn } from '../../../packages/clouds/src/precipitation/tsl/fallColumn'
import { cloudScene, mean, offsets, worldMap } from '../harness/cloud-scene'
import { evaluateOnGpu } from '../harness/evaluate'
import { expectTrue } from '../harness/expect'
import { gpuTest, takeFineShadows } from '../harness/gpu-test'

// The users' maps of the weather.
takeFineShadows('half')

/** Greatest mean error of the weather's sum [–], and of the shift of noise [m]. */
const SUM = 0.04
const SHIFT = 12

/** Greatest mean error of the rank of columns from which it falls, and the least mean that the test means anything with [–]. */
const RANK = 0.005
const LEAST_RANK = 0.05

/** Places all over the planet, and the width of what each stands for [m]. */
const COUNT = 8192
const FOOTPRINT = 50

/** Greatest error of a share, over the share, and of the mean rate [–]. Storms crowd, and small cells blur. */
const ERROR = 0.12

/** Least part of the places where it rains hard that have the storm's cloud above them, at this height in its layer [–]. */
const UNDER_CLOUD = 0.9
const HEIGHT = 0.15

/** Presets, their coverage, and the share that is asked for. */
const asked = [
  ['shower', 0.25, 0.25],
  ['hailstorm', 0.25, 0.2],
  ['snowShower', 0.25, 0.25],
  ['altocumulus', 0.3, 0.5]
] as const satisfies [CloudPresetName, number, number][]

/** Heights of the camera, and the farthest places that are looked up [m]. */
const views = [
  [2, 28_000],
  [2, 340_000],
  [400_000, 2_200_000]
] as const

gpuTest(
  'the maps have the weather of the places that they stand for',
  async t => {
    for (const [height, farthest] of views) {
      const place = { longitude: 20, latitude: 45, height }
      const layers = cloudPreset('mixed')
      const scene = await cloudScene(t, layers, place)
      const { field, viewpoint, renderer } = scene
      const map = new WeatherMap(field)
      map.render(renderer, viewpoint.clone().normalize())
      const { baseAltitude } = layers.at(1).parameters
      const inputs = offsets(viewpoint, 1024, farthest, 5, () => baseAltitude - height)
      const errors = await evaluateOnGpu(renderer, inputs, input => {
        const offset = input.xyz.toConst() as unknown as Node<'vec3'>
        const sample: CloudSample = {
          offset,
          ...field.view.localCoordinates(offset),
          distance: input.w
        }
        const index = int(1)
        const layer = layerAt(field, index)
        const subpoint = subpointOffset(field, sample).toConst()
        const footprint = footprintOf(field, sample)
        const found = map.sample(layer, index, subpoint, sample.up, footprint)
        return vec4(found.sub(weatherBackground(field, layer, subpoint, sample, footprint)).abs())
      })
      const of = (component: number): number[] => inputs.map((_, i) => errors[4 * i + component])
      const [sum, x, y] = [0, 2, 3].map(component => mean(of(component)))
      t.note(
        `from ${height} m to ${farthest / 1000} km: ${sum.toFixed(
          4
        )}, ${x.toFixed(1)} and ${y.toFixed(1)} m`
      )
      expectTrue(sum < SUM, `from ${height} m: the sum is off by ${sum}`)
      expectTrue(Math.max(x, y) < SHIFT, `from ${height} m: noise is shifted by ${x} and ${y} m`)
      map.dispose()
      scene.dispose()
    }
  },
  // Minutes on WebGL, where it was the same to four digits.
  { backends: ['webgpu'] }
)

gpuTest(
  'the map has the columns from which rain falls',
  async t => {
    const place = { longitude: 20, latitude: 45, height: 2 }
    const layers = cloudPreset('shower')
    layers.at(0).set({ coverage: 0.6 })
    const scene = await cloudScene(t, layers, place)
    const { field, viewpoint, renderer } = scene
    const medium = precipitationShafts()
    medium.update(field, { up: viewpoint.clone().normalize() } as AtmosphereView)
    const map = new WeatherMap(field, index => medium.fallOf(index))
    map.render(renderer, viewpoint.clone().normalize())
    const inputs = offsets(viewpoint, 512, 30_000, 7, () => 500)
    const found = await evaluateOnGpu(renderer, inputs, input => {
      const offset = input.xyz.toConst() as unknown as Node<'vec3'>
      const sample: CloudSample = {
        offset,
        ...field.view.localCoordinates(offset),
        distance: input.w
      }
      const index = int(0)
      const layer = layerAt(field, index)
      const subpoint = subpointOffset(field, sample).toConst()
      const footprint = footprintOf(field, sample)
      const background = weatherBackground(field, layer, subpoint, sample, footprint)
      const nodes = medium.fallOf(index)
      const truth = fallColumn(field, layer, nodes, background, subpoint, footprint).x.max(0)
      const mapped = map.fallAt(index, subpoint)!.x.max(0)
      return vec4(mapped.sub(truth).abs(), truth, 0, 0)
    })
    const [error, rank] = [0, 1].map(component =>
      mean(inputs.map((_, i) => found[4 * i + component]))
    )
    t.note(`rank ${rank.toFixed(3)} in the mean, off by ${error.toFixed(4)}`)
    expectTrue(rank > LEAST_RANK, `too little rain: a mean rank of ${rank}`)
    expectTrue(error < RANK, `ranks are off by ${error}`)
    map.dispose()
    scene.dispose()
  },
  { backends: ['webgpu'] }
)

gpuTest(
  'the maps are drawn anew where camera, clouds or layers have gone on, and only there',
  async t => {
    const layers = cloudPreset('fairWeather')
    layers.at(0).wind = { east: 10, north: 0 }
    const cover = worldMap()
    const scene = await cloudScene(t, layers, { longitude: 20, latitude: 45, height: 2 }, cover)
    const { field, viewpoint, renderer } = scene
    const map = new WeatherMap(field)
    let draws = 0
    const render = renderer.render.bind(renderer)
    renderer.render = (...args) => {
      draws++
      return render(...args)
    }
    const drawn = (seconds: number): number => {
      scene.update(seconds)
      draws = 0
      map.render(renderer, viewpoint.clone().normalize())
      return draws
    }
    const all = drawn(0)
    expectTrue(all > 0, 'nothing is drawn at first')
    expectTrue(drawn(0.1) === 0, 'a metre of wind draws them anew')
    expectTrue(drawn(0.3) === 0, 'three metres of wind draw them anew')
    expectTrue(drawn(0.5) === all, 'five metres of wind do not')
    layers.at(0).coverage = 0.6
    expectTrue(drawn(0.5) === all, 'another coverage does not')
    expectTrue(drawn(0.5) === 0, 'they are drawn again for nothing')
    cover.needsUpdate = true
    expectTrue(drawn(0.5) === all, 'another map of the world does not')
    field.worldMap!.bounds = { west: -170, south: -90, east: 190, north: 90 }
    expectTrue(drawn(0.5) === all, 'other bounds of it do not')
    cover.isRenderTargetTexture = true
    expectTrue(drawn(0.5) === all && drawn(0.5) === all, 'a map that is drawn into does not')
    cover.isRenderTargetTexture = false
    expectTrue(drawn(0.5) === all && drawn(0.5) === 0, 'it is drawn into no more')
    field.atmosphere.place({ longitude: 20, latitude: 45.0001, height: 2 })
    expectTrue(drawn(0.5) === all, 'eleven metres of way do not')
    map.dispose()
    expectTrue(drawn(0.5) === all, 'they are not there after they were freed')
    map.dispose()
    scene.dispose()
  }
)

gpuTest(
  'rain falls from the share of the clouds that is asked for, at the rate asked for, and under towers',
  async t => {
    const layers = new CloudLayers(
      asked.map(([preset, coverage, share]) => {
        const [{ parameters }] = cloudPreset(preset)
        return { ...parameters, coverage, precipitation: { rate: 5, share } }
      })
    )
    const scene = await cloudScene(t, layers, { longitude: 20, latitude: 45 })
    const { renderer, field, viewpoint } = scene
    const medium = precipitationShafts()
    medium.update(field, scene.update())
    // A spiral of even density, for each layer.
    const inputs = Array.from({ length: COUNT * asked.length }, (_, i) => {
      const z = (2 * (i % COUNT) + 1) / COUNT - 1
      const [across, angle] = [Math.sqrt(1 - z * z), 2.399963 * (i % COUNT)]
      const place = new Vector3(across * Math.cos(angle), across * Math.sin(angle), z)
      place.multiplyScalar(field.radius.value).sub(viewpoint)
      return [...place.toArray(), Math.floor(i / COUNT)].map(Math.fround)
    })
    const found = await evaluateOnGpu(renderer, inputs, input => {
      const index = int(input.w.add(0.5)).toConst() as Int
      const layer = layerAt(field, index)
      const altitude = layer.baseAltitude.add(layer.thickness.mul(HEIGHT)).toConst() as Float
      const { up } = field.view.localCoordinates(input.xyz.toConst())
      const offset = input.xyz.add(up.mul(altitude)).toConst() as unknown as Vec3
      const sample: CloudSample = { offset, altitude, up, distance: float(2000) }
      const subpoint = subpointOffset(field, sample).toConst() as Vec3
      const width = float(FOOTPRINT)
      const background = weatherBackground(field, layer, subpoint, sample, width)
      const column = fallColumn(field, layer, medium.fallOf(index), background, subpoint, width)
      const cloud = sampleLayer(field, layer, background, sample, { detail: false })
      return vec4(column.x, cloud.extinction, 0, 0)
    })
    const misses: string[] = []
    for (const [i, [preset, coverage, share]] of asked.entries()) {
      const own = Array.from({ length: COUNT }, (_, k) => 4 * (i * COUNT + k))
      const wet = own.filter(k => found[k] > 0)
      const got = wet.length / COUNT / coverage / share
      const rate = mean(wet.map(k => 3 * found[k] ** 2))
      const hard = wet.filter(k => found[k] > 0.7)
      const under = hard.filter(k => found[k + 1] > 0).length / hard.length
      const told = `${preset}: ${got.toFixed(3)} of the share, ${rate.toFixed(3)} of the rate, ${under.toFixed(3)} under clouds`
      t.note(told)
      const isWrong = Math.max(Math.abs(got - 1), Math.abs(rate - 1)) > ERROR
      if (isWrong || under < UNDER_CLOUD) misses.push(told)
    }
    expectTrue(misses.length === 0, misses.join(', '))
    scene.dispose()
  },
  { backends: ['webgpu'] }
)

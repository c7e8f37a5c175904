import type { AtmosphereView } from '@welkin/atmosphere'
import { cloudPreset, precipitationShafts } from '@welkin/clouds'
import { int, vec4 } from 'three/tsl'
import type { Node } from 'three/webgpu'
import { layerAt } from '../../../packages/clouds/src/density/tsl/layer'
import {
  footprintOf,
  subpointOffset,
  type CloudSample
} from '../../../packages/clouds/src/density/tsl/sample'
import { weatherBackground } from '../../../packages/clouds/src/density/tsl/weatherBackground'
import { WeatherMap } from '../../../packages/clouds/src/density/WeatherMap'
import { fallColumn } from '../../../packages/clouds/src/precipitation/tsl/fallColumn'
import { cloudScene, mean, offsets } from '../harness/cloud-scene'
import { evaluateOnGpu } from '../harness/evaluate'
import { expectTrue } from '../harness/expect'
import { gpuTest } from '../harness/gpu-test'

/** Greatest mean error of the weather's sum [–], and of the shift of noise [m]. */
const SUM = 0.04
const SHIFT = 12

/** Greatest mean error of the rank of columns from which it falls, and the least mean that the test means anything with [–]. */
const RANK = 0.005
const LEAST_RANK = 0.05

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
    const scene = await cloudScene(t, layers, { longitude: 20, latitude: 45, height: 2 })
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
    field.atmosphere.place({ longitude: 20, latitude: 45.0001, height: 2 })
    expectTrue(drawn(0.5) === all, 'eleven metres of way do not')
    map.dispose()
    expectTrue(drawn(0.5) === all, 'they are not there after they were freed')
    map.dispose()
    scene.dispose()
  }
)

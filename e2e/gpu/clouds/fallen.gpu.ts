import { CloudLayers, precipitationShafts } from '@welkin/clouds'
import { float, int, vec3, vec4 } from 'three/tsl'
import { fallenOf, lagOf } from '../../../packages/clouds/test/twins/precipitation'
import { fallForm } from '../../../packages/clouds/src/precipitation/fallForm'
import { vector3 } from '../../../packages/clouds/src/uniforms'
import type { WeatherMap } from '../../../packages/clouds/src/density/WeatherMap'
import { layerAt } from '../../../packages/clouds/src/density/tsl/layer'
import { fallenFrom, fallLag } from '../../../packages/clouds/src/precipitation/tsl/fall'
import type { Float, Int, Vec3 } from '../../../packages/clouds/src/tsl-types'
import { evenClouds } from '../harness/cloud-scene'
import { evaluateOnGpu } from '../harness/evaluate'
import { expectClose, expectTrue } from '../harness/expect'
import { gpuTest } from '../harness/gpu-test'

const [BASE, TOP] = [2000, 6000]

/** Ranks of columns, and altitudes from the cloud down to the ground [m]. */
const RANKS = [0.05, 0.3, 0.55, 0.7, 0.85, 1]
const ALTITUDES = [2300, 2230, 2120, 2000, 1900, 1700, 1450, 1250, 1150, 1000, 800, 500, 100, 0]

/** Weathers, each from a layer of its own, without streaks. */
const weathers = {
  'melting snow': { rate: 3, freezingLevel: 1300 },
  'virga of 600 m': { rate: 4, virgaDepth: 600, freezingLevel: 1300 },
  'virga of 2000 m': { rate: 4, virgaDepth: 2000, freezingLevel: 9000 },
  hail: { rate: 20, hail: 0.4, freezingLevel: 3000 }
} as const

gpuTest(
  'what falls evaporates, melts and has hail on the way down as in float64',
  async t => {
    const falls = Object.values(weathers)
    const layers = new CloudLayers(
      falls.map(precipitation => ({
        baseAltitude: BASE,
        topAltitude: TOP,
        shear: 0,
        wind: { east: 0, north: 0 },
        precipitation: { ...precipitation, streaks: 0 }
      }))
    )
    const scene = await evenClouds(t, layers, { longitude: 20, latitude: 45 })
    const { field, renderer } = scene
    const medium = precipitationShafts()
    medium.update(field, scene.update())
    const inputs = falls.flatMap((_, layer) =>
      RANKS.flatMap(rank => ALTITUDES.map(altitude => [rank, altitude, layer, 0]))
    )
    const found = await evaluateOnGpu(renderer, inputs, input => {
      const column = { fallAt: () => vec4(input.x, 0, 0, 0) } as unknown as WeatherMap
      const up = field.view.up.toConst() as Vec3
      const altitude = input.y.toConst() as Float
      const offset = up.mul(altitude.sub(field.view.height)).toConst() as Vec3
      const sample = { offset, altitude, up, distance: float(100) }
      const index = int(input.z.add(0.5)).toConst() as Int
      const { rate, hail, snow } = fallenFrom(
        field,
        column,
        layerAt(field, index),
        medium.fallOf(index),
        sample
      )
      return vec4(vec3(rate, hail, snow), 1)
    })
    /** Rain and snow, and hail, at the ground: sums over ranks [mm/h]. */
    const ground = falls.map(() => [0, 0])
    inputs.forEach(([rank, altitude, layer], i) => {
      const told = `${Object.keys(weathers)[layer]} under rank ${rank} at ${altitude} m`
      const { rate, hail, snow } = fallenOf(layers.at(layer).parameters, rank, altitude)
      const [gotRate, gotHail, gotSnow] = found.slice(4 * i)
      const tolerance = { absolute: 2e-3 * falls[layer].rate, relative: 1e-3 }
      expectClose([gotRate, gotHail], [rate, hail], tolerance, told)
      expectClose([gotSnow], [snow], { absolute: 1e-5 }, `snow, ${told}`)
      if (altitude > 0) return
      ground[layer][0] += gotRate
      ground[layer][1] += gotHail
    })
    t.note(ground.map(sums => sums.map(sum => sum.toFixed(2)).join(' + ')).join(', '))
    const [snow, weak, heavy, storm] = ground
    expectTrue(weak[0] === 0, 'weak virga reaches the ground')
    expectTrue(heavy[0] > 0 && heavy[0] < 0.1 * snow[0], 'heavier rain reaches the ground')
    expectTrue(snow[1] === 0 && storm[1] > 0.1 * storm[0], 'hail where it is asked for alone')
    scene.dispose()
  },
  // WebGL compiles the same functions in the clouds' march.
  { backends: ['webgpu'] }
)

gpuTest(
  'what falls lags behind its cloud as a drop does that is followed step by step',
  async t => {
    const renderer = await t.createRenderer()
    const [wind, growth] = [14, 0.6]
    const inputs = [400, 1500, 4000].flatMap(base =>
      [-500, 300, 1000, 2500, 9000].flatMap(freezingLevel =>
        [0, 0.2, 0.6, 0.95].map(part => [part * base, base, freezingLevel, 0])
      )
    )
    const found = await evaluateOnGpu(renderer, inputs, input => fallLag(input.x, input.y, input.z))
    inputs.forEach(([altitude, base, freezingLevel], i) => {
      const lag = (found[4 * i] * wind * growth) / base / 2
      const expected = lagOf(wind, altitude, base, freezingLevel)
      // A step in which snow becomes rain is one or the other: of 4000.
      const told = `from ${base} m to ${altitude} m, freezing at ${freezingLevel} m`
      expectClose([lag], [expected], { relative: 2e-3 }, told)
      expectClose([found[4 * i + 1]], [base - altitude], { absolute: 1e-3 }, `depth, ${told}`)
    })
  },
  { backends: ['webgpu'] }
)

gpuTest(
  'hail falls nearer to its column than rain does, by the speeds of both',
  async t => {
    const [wind, base] = [20, 2000]
    const layers = new CloudLayers([
      {
        baseAltitude: base,
        topAltitude: TOP,
        shear: 0,
        wind: { east: wind, north: 0 },
        precipitation: { rate: 20, hail: 0.5, freezingLevel: 3000, streaks: 0 }
      }
    ])
    const scene = await evenClouds(t, layers, { longitude: 20, latitude: 45 })
    const { field, renderer } = scene
    const medium = precipitationShafts()
    medium.update(field, scene.update())
    const east = vector3()
    east.value.set(0, 0, 1).cross(field.view.up.value).normalize()
    const expected = [fallForm.rainSpeed, fallForm.hailSpeed].map(speed =>
      lagOf(wind, 0, base, 3000, speed)
    )
    // Places on the ground from the edge of the columns on, upwind.
    const step = 10
    const inputs = Array.from({ length: 300 }, (_, i) => [-i * step, 0, 0, 0])
    const found = await evaluateOnGpu(renderer, inputs, input => {
      const column = {
        fallAt: (_: Int, subpoint: Vec3) =>
          vec4(subpoint.dot(east).greaterThan(0).select(1, -1), 0, 0, 0)
      } as unknown as WeatherMap
      const up = field.view.up.toConst() as Vec3
      const offset = east.mul(input.x).sub(up.mul(field.view.height)).toConst() as Vec3
      const sample = { offset, altitude: float(0), up, distance: float(100) }
      const { rate, hail } = fallenFrom(
        field,
        column,
        layerAt(field, int(0)),
        medium.fallOf(int(0)),
        sample
      )
      return vec4(rate, hail, 0, 1)
    })
    const lags = [0, 1].map(k => step * inputs.filter((_, i) => found[4 * i + k] > 0).length)
    t.note(`rain lags by ${lags[0]} m, hail by ${lags[1]} m`)
    expectTrue(lags[1] < 0.7 * lags[0], `rain lags by ${lags[0]} m, hail by ${lags[1]} m`)
    for (const k of [0, 1]) expectClose([lags[k]], [expected[k]], { absolute: 2 * step }, 'lag')
    scene.dispose()
  },
  { backends: ['webgpu'] }
)

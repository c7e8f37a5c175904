import { CloudLayers, CloudLightTable, cloudQualities, precipitationShafts } from '@welkin/clouds'
import type { CloudQuality } from '@welkin/clouds'
import { DataTexture, HalfFloatType, RGBAFormat, Vector3 } from 'three'
import { float, int, texture, vec3, vec4 } from 'three/tsl'
import type { WeatherMap } from '../../../packages/clouds/src/density/WeatherMap'
import { QualityUniforms } from '../../../packages/clouds/src/march/quality'
import { fallStretch } from '../../../packages/clouds/src/precipitation/tsl/fallStretch'
import { marchPrecipitation } from '../../../packages/clouds/src/precipitation/tsl/marchPrecipitation'
import type { LevelTexture, Vec2, Vec3 } from '../../../packages/clouds/src/tsl-types'
import { vector2, vector3 } from '../../../packages/clouds/src/uniforms'
import { evenClouds, mean } from '../harness/cloud-scene'
import { evaluateOnGpu } from '../harness/evaluate'
import { expectTrue } from '../harness/expect'
import { gpuTest } from '../harness/gpu-test'

/** Period of the showers along a ray, and length of steps that streaks of `shower` ask for [m]. */
const PERIOD = 6000
const STREAK = 213

/** Places of samples in steps. */
const JITTERS = [0.05, 0.25, 0.45, 0.65, 0.85]

gpuTest(
  'a ray finds the showers on its way as finely as one of eight times the steps',
  async t => {
    const layers = new CloudLayers([
      {
        baseAltitude: 2000,
        topAltitude: 3000,
        shapeAmount: 0,
        shear: 0,
        wind: { east: 0, north: 0 },
        precipitation: { rate: 1, freezingLevel: 9000 }
      }
    ])
    const { renderer, field, update, dispose } = await evenClouds(t, layers, {
      longitude: 20,
      latitude: 45,
      height: 30
    })
    const medium = precipitationShafts()
    const light = new CloudLightTable()
    light.bake()
    const east = vector3()
    // A third of the way is under columns from which it rains.
    const column = (subpoint: Vec3) =>
      vec4(
        subpoint
          .dot(east)
          .mul((2 * Math.PI) / PERIOD)
          .sin()
          .sub(0.5)
          .mul(2)
          .max(-1),
        vec3(0)
      )
    const weatherMap = {
      fallAt: (_: unknown, subpoint: Vec3) => column(subpoint)
    } as unknown as WeatherMap
    const none = new DataTexture(new Uint16Array(4), 1, 1, RGBAFormat, HalfFloatType)
    none.needsUpdate = true
    const shadows = {
      map: texture(none) as unknown as LevelTexture<Vec2>,
      cascades: [],
      scale: vector2(),
      isMoonlit: float(0) as never
    }
    const view = update()
    medium.update(field, view)
    east.value.set(1, 0, 0).applyMatrix3(view.viewToMapped).normalize()
    const rays = Array.from({ length: 12 }, (_, i) => new Vector3(1, 0.02 + 0.015 * i, 0.3))
    const inputs = rays.flatMap(ray => {
      const mapped = ray.applyMatrix3(view.viewToMapped).normalize().toArray()
      return JITTERS.map(jitter => [...mapped, jitter].map(Math.fround))
    })
    /** Opacity of what falls on the rays, and its distance. */
    const found = async (chosen: CloudQuality): Promise<Float32Array> => {
      const quality = new QualityUniforms()
      quality.set(chosen)
      return evaluateOnGpu(renderer, inputs, input => {
        const direction = input.xyz as unknown as Vec3
        const altitudes = { ceiling: medium.ceiling, floor: float(-1000) }
        const stretch = fallStretch(field, altitudes, { direction, end: float(1e6) })
        const context = { field, weatherMap, light: light.nodes, shadows, quality }
        const space = {
          fallOf: medium.fallOf.bind(medium),
          layers: { first: int(0), last: int(1) },
          ceiling: medium.ceiling,
          width: float(1500),
          shortest: float(STREAK)
        }
        const seen = marchPrecipitation(context, space, { direction, jitter: input.w }, stretch)
        return vec4(seen.weight, seen.distance, seen.spread, 0)
      })
    }
    const { low, high } = cloudQualities
    const fine = await found({ ...high, layerSteps: 8 * high.layerSteps })
    const least = Math.min(...inputs.map((_, i) => fine[4 * i]))
    const misses: string[] = []
    for (const [name, quality, most] of [
      ['low', low, 0.13],
      ['high', high, 0.1]
    ] as const) {
      const own = await found(quality)
      const squares = inputs.map((_, i) => (own[4 * i] / fine[4 * i] - 1) ** 2)
      const error = Math.sqrt(mean(squares))
      t.note(`${name} is off by ${(100 * error).toFixed(1)} % rms`)
      if (!(error < most)) misses.push(`${name} is off by ${error} rms`)
    }
    expectTrue(least > 0.05, `rays miss the showers: ${least}`)
    expectTrue(misses.length === 0, misses.join(', '))
    for (const owned of [light, none]) owned.dispose()
    dispose()
  },
  { backends: ['webgpu'] }
)

import { cloudPreset, precipitationShafts, type CloudPresetName } from '@welkin/clouds'
import { Vector3 } from 'three'
import { float, int, vec4 } from 'three/tsl'
import { layerAt } from '../../../packages/clouds/src/density/tsl/layer'
import { subpointOffset, type CloudSample } from '../../../packages/clouds/src/density/tsl/sample'
import { weatherBackground } from '../../../packages/clouds/src/density/tsl/weatherBackground'
import { isStorm } from '../../../packages/clouds/src/layers/storms'
import { fallColumn } from '../../../packages/clouds/src/precipitation/tsl/fallColumn'
import type { Vec3 } from '../../../packages/clouds/src/tsl-types'
import { cloudExtinction } from '../harness/cloud-extinction'
import { cloudScene, mean } from '../harness/cloud-scene'
import { evaluateOnGpu } from '../harness/evaluate'
import { expectTrue } from '../harness/expect'
import { gpuTest } from '../harness/gpu-test'

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

gpuTest(
  'rain falls from the share of the clouds that is asked for, at the rate asked for, and under towers',
  async t => {
    const layers = cloudPreset('shower')
    const scene = await cloudScene(t, layers, { longitude: 20, latitude: 45 })
    const { renderer, field, viewpoint } = scene
    const medium = precipitationShafts()
    // A spiral of even density.
    const inputs = Array.from({ length: COUNT }, (_, i) => {
      const z = (2 * i + 1) / COUNT - 1
      const [across, angle] = [Math.sqrt(1 - z * z), 2.399963 * i]
      const place = new Vector3(across * Math.cos(angle), across * Math.sin(angle), z)
      return [...place.multiplyScalar(field.radius.value).sub(viewpoint).toArray(), 0].map(
        Math.fround
      )
    })
    const misses: string[] = []
    for (const [preset, coverage, share] of asked) {
      const [{ parameters }] = cloudPreset(preset)
      layers.at(0).set({ ...parameters, coverage, precipitation: { rate: 5, share } })
      medium.update(field, scene.update())
      const { baseAltitude, topAltitude } = parameters
      const altitude = float(baseAltitude + HEIGHT * (topAltitude - baseAltitude))
      const found = await evaluateOnGpu(renderer, inputs, input => {
        const { up } = field.view.localCoordinates(input.xyz.toConst() as unknown as Vec3)
        const offset = input.xyz.add(up.mul(altitude)).toConst() as unknown as Vec3
        const sample: CloudSample = { offset, altitude, up, distance: float(2000) }
        const layer = layerAt(field, int(0))
        const subpoint = subpointOffset(field, sample).toConst() as Vec3
        const width = float(FOOTPRINT)
        const background = weatherBackground(field, layer, subpoint, sample, width)
        const fall = medium.fallOf(int(0))
        const column = fallColumn(field, layer, fall, background, subpoint, width)
        return vec4(column.x, cloudExtinction(field, sample, false), 0, 0)
      })
      const wet = inputs.flatMap((_, i) => (found[4 * i] > 0 ? [4 * i] : []))
      const got = wet.length / COUNT / coverage / share
      const rate = mean(wet.map(i => 3 * found[i] ** 2))
      const hard = wet.filter(i => found[i] > 0.7)
      const under = hard.filter(i => found[i + 1] > 0).length / hard.length
      const told = `${preset}: ${got.toFixed(3)} of the share, ${rate.toFixed(3)} of the rate, ${under.toFixed(3)} under clouds`
      t.note(told)
      const isWrong = Math.max(Math.abs(got - 1), Math.abs(rate - 1)) > ERROR
      if (isWrong || (isStorm(layers.at(0).parameters) && under < UNDER_CLOUD)) misses.push(told)
    }
    expectTrue(misses.length === 0, misses.join(', '))
    scene.dispose()
  },
  { backends: ['webgpu'] }
)

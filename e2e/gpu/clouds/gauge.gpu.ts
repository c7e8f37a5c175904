import {
  CloudLayers,
  PrecipitationGauge,
  precipitationShafts,
  type CloudsNode
} from '@welkin/clouds'
import { PerspectiveCamera, Vector3 } from 'three'
import type { NodeFrame } from 'three/webgpu'
import { random } from '../harness/atmosphere'
import { cloudScene, mean } from '../harness/cloud-scene'
import { expectClose, expectTrue } from '../harness/expect'
import { gpuTest } from '../harness/gpu-test'
import { nextFrame } from '../harness/graphics'

/** Share of the sky that is covered, share of that from which it falls, and the rate there [mm/h]. */
const [COVERAGE, SHARE, RATE] = [0.6, 0.5, 12]
const PLACES = 120

gpuTest('a gauge finds what layers ask for, under the columns from which it falls', async t => {
  const precipitation = { rate: RATE, share: SHARE, streaks: 0, freezingLevel: 9000 }
  const wind = { east: 0, north: 0 }
  const layers = new CloudLayers([
    { baseAltitude: 2000, topAltitude: 3500, coverage: COVERAGE, wind, shear: 0, precipitation }
  ])
  const { renderer, field, dispose } = await cloudScene(t, layers, { longitude: 20, latitude: 45 })
  const camera = new PerspectiveCamera()
  const falling = precipitationShafts()
  const clouds = { field, camera, shadows: { falling } } as unknown as CloudsNode
  const gauge = new PrecipitationGauge(clouds)
  const read = async (x: number, z: number): Promise<number[]> => {
    const view = field.atmosphere.update(renderer, camera)
    field.view.update({ renderer, camera } as unknown as NodeFrame)
    falling.update(field, view)
    gauge.update(renderer, new Vector3(x, 10, z))
    while (gauge.isReading) await nextFrame()
    return [gauge.rain, gauge.snow, gauge.hail]
  }
  const next = random(5)
  const found: number[] = []
  const places = Array.from({ length: PLACES }, () =>
    [next() - 0.5, next() - 0.5].map(n => 2e5 * n)
  )
  for (const [x, z] of places) found.push((await read(x, z))[0])
  const wet = found.filter(rate => rate > 0)
  t.note(`${wet.length} of ${PLACES} places are wet, with ${mean(wet).toFixed(1)} mm/h`)
  expectClose([wet.length / PLACES], [COVERAGE * SHARE], { absolute: 0.13 }, 'share of places')
  // Rates are 3 x² times the mean, of ranks x.
  expectClose([mean(wet)], [RATE], { relative: 0.3 }, 'mean rate')
  expectTrue(Math.max(...wet) <= 3.01 * RATE, 'greatest rate')

  const [x, z] = places[found.indexOf(Math.max(...found))]
  const [rain] = await read(x, z)
  expectTrue(rain === Math.max(...found), 'the same place has another rate')
  // A camera elsewhere asks about the same place.
  camera.position.set(x + 3000, 500, z)
  camera.updateMatrixWorld()
  expectClose([(await read(x, z))[0]], [rain], { relative: 0.02 }, 'from elsewhere')
  layers.at(0).precipitation = { rate: RATE, freezingLevel: -1000 }
  expectClose(await read(x, z), [0, rain, 0], { relative: 0.3, absolute: 0.01 }, 'as snow')
  expectTrue(gauge.rain === 0 && gauge.snow > 0, 'snow is no rain')
  layers.at(0).precipitation = null
  expectClose(await read(x, z), [0, 0, 0], { absolute: 0 }, 'dry')
  gauge.dispose()
  dispose()
})

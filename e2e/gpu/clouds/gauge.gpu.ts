import {
  CloudLayers,
  PrecipitationGauge,
  precipitationShafts,
  type CloudsNode
} from '@welkin/clouds'
import { PerspectiveCamera, Vector3 } from 'three'
import type { NodeFrame } from 'three/webgpu'
import { NoiseTextures } from '../../../packages/clouds/test/twins/noiseTextures'
import { fallenOf, fallenRank } from '../../../packages/clouds/test/twins/precipitation'
import { random } from '../harness/atmosphere'
import { cloudScene } from '../harness/cloud-scene'
import { expectClose, expectTrue } from '../harness/expect'
import { gpuTest } from '../harness/gpu-test'
import { nextFrame } from '../harness/graphics'

const RATE = 12
const ALTITUDE = 10
/** Width over which a gauge's rates are means [m]. */
const WIDTH = 50

gpuTest(
  'a gauge has the rate of the columns above a place as in float64, of rain, snow and hail',
  async t => {
    const falls = { rate: RATE, share: 0.7, hail: 0.4, streaks: 0 }
    const layers = new CloudLayers([{ baseAltitude: 2000, topAltitude: 3500, coverage: 0.6 }])
    const scene = await cloudScene(t, layers, { longitude: 20, latitude: 45 })
    const { renderer, field } = scene
    const { atmosphere } = field
    const camera = new PerspectiveCamera()
    const falling = precipitationShafts()
    const clouds = { field, camera, shadows: { falling } } as unknown as CloudsNode
    const gauge = new PrecipitationGauge(clouds)
    /** Rates, and the place in the mapped space. */
    const read = async (place: Vector3): Promise<readonly [number[], Vector3]> => {
      camera.updateMatrixWorld()
      const view = atmosphere.update(renderer, camera)
      field.view.update({ renderer, camera } as unknown as NodeFrame)
      field.update(view, 0)
      falling.update(field, view)
      gauge.update(renderer, place)
      while (gauge.isReading) await nextFrame()
      const mapped = atmosphere.space.position(place, new Vector3())
      return [[gauge.rain, gauge.snow, gauge.hail], mapped]
    }
    const noise = new NoiseTextures()
    const next = random(5)
    const places = Array.from({ length: 5 }, () => {
      const [x, z] = [next() - 0.5, next() - 0.5].map(share => 2e4 * share)
      return new Vector3(x, ALTITUDE, z)
    })
    let wet = 0
    for (const freezingLevel of [9000, -1000]) {
      layers.at(0).precipitation = { ...falls, freezingLevel }
      const state = scene.state()
      const [{ bottomRadius, pixelAngle }, { parameters }] = [state, layers.at(0)]
      for (const place of places) {
        const [found, mapped] = await read(place)
        const altitude = mapped.length() - bottomRadius
        const under = (isHail: boolean): number =>
          fallenRank(state, noise, 0, mapped, WIDTH / pixelAngle, isHail)
        const { rate, snow } = fallenOf(parameters, under(false), altitude)
        const { hail } = fallenOf(parameters, under(true), altitude)
        const told = `at ${place.toArray().map(Math.round)}, freezing at ${freezingLevel} m`
        const tolerance = { absolute: 0.02 * 3 * RATE }
        expectClose(found, [rate * (1 - snow), rate * snow, hail], tolerance, told)
        if (rate > 1) wet++
      }
    }
    t.note(`${wet} of 10 are wet`)
    expectTrue(wet > 2 && wet < 10, `${wet} of 10 are wet`)

    // A camera elsewhere asks about the same place.
    layers.at(0).precipitation = { ...falls, share: 1, freezingLevel: 9000 }
    const [here] = await read(places[0])
    camera.position.set(3000, 500, -2000)
    const [same] = await read(places[0])
    expectTrue(here[0] > 0.1, 'dry at the first place')
    expectClose(same, here, { absolute: 0.1 }, 'from elsewhere')
    layers.at(0).precipitation = { rate: 300, streaks: 0, share: 1, freezingLevel: 9000 }
    for (const place of places) {
      const [[rain]] = await read(place)
      expectTrue(rain <= 300, `a rate of ${rain} mm/h, which nothing takes`)
    }
    layers.at(0).precipitation = null
    expectClose((await read(places[0]))[0], [0, 0, 0], { absolute: 0 }, 'dry')
    gauge.dispose()
    scene.dispose()
  },
  // WebGL compiles the same functions in the clouds' march.
  { backends: ['webgpu'] }
)

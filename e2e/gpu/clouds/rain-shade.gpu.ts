import type { AirOccluder } from '@welkin/atmosphere'
import {
  CloudLayers,
  CloudLightTable,
  CloudNoise,
  cloudAirShadow,
  clouds,
  precipitationShafts
} from '@welkin/clouds'
import { Vector3 } from 'three'
import { uniform } from 'three/tsl'
import { RenderPipeline } from 'three/webgpu'
import { drawToFloat } from '../harness/atmosphere'
import { coarse, fog } from '../harness/cloud-view'
import { expectClose, expectTrue } from '../harness/expect'
import { gpuTest } from '../harness/gpu-test'
import { nextFrame } from '../harness/graphics'
import type { Picture } from '../harness/picture'
import { stage, stageSize as size } from '../harness/shaft-stage'

/** Sun in the north, before the camera [°]: rain shines where it hides the sun. */
const SUN = 25

/** A layer over the camera that is seen through, and from which it rains everywhere. */
const layer = {
  ...fog,
  baseAltitude: 1500,
  topAltitude: 1800,
  density: 1e-7,
  precipitation: { rate: 0.2, share: 1, freezingLevel: 9000 }
}

/** Distance that parts near and far casters [m]. */
const BETWEEN = 2500

/** Frames that light is the mean of. */
const FRAMES = 16

/** Spectrum of one value. */
const all4 = (value: number): [number, number, number, number] => [value, value, value, value]

gpuTest(
  "loses rain's sunlight where something shades it, near and far",
  async t => {
    const renderer = await t.createRenderer(size)
    const set = stage(renderer, SUN)
    const { shafts, camera, air, depth, atmosphere } = set
    // Next to no air: what one sees is rain in sunlight.
    atmosphere.parameters.set({
      rayleighScattering: all4(1e-12),
      mieScattering: all4(0),
      mieExtinction: all4(1e-12),
      groundAlbedo: all4(0)
    })
    const [light, noise, precipitation] = [
      new CloudLightTable(),
      new CloudNoise(),
      precipitationShafts()
    ]
    const layers = new CloudLayers([layer])
    const node = clouds(air, depth, camera, atmosphere, layers, {
      // Rain falls unevenly: few steps would find another share of it far away in each frame.
      quality: { ...coarse, layerSteps: 32 },
      noise,
      light,
      precipitation
    })
    node.time = 0
    node.accumulates = false
    await node.bake(renderer)
    const pipeline = new RenderPipeline(renderer)
    pipeline.outputColorTransform = false
    pipeline.outputNode = node
    camera.position.y = 50
    camera.lookAt(new Vector3(0, 0.3, -1).add(camera.position))
    camera.updateMatrixWorld()
    const [litNear, litFar] = [uniform(1), uniform(1)]
    const caster: AirOccluder = {
      castInto: () => ({
        transmittance: () => place => place.distance.greaterThan(BETWEEN).select(litFar, litNear)
      })
    }
    shafts.add(caster, cloudAirShadow(node))
    /** A picture, with what shades all that is near, or far. */
    const draw = async (isDark: { near?: boolean; far?: boolean }): Promise<Picture> => {
      litNear.value = isDark.near ? 0 : 1
      litFar.value = isDark.far ? 0 : 1
      await nextFrame()
      return drawToFloat(renderer, () => pipeline.render())
    }
    /** Light of the middle third of the picture. */
    const sumOf = (picture: Picture): number => {
      let sum = 0
      for (let y = size.height / 3; y < (2 * size.height) / 3; y++) {
        for (let x = Math.ceil(size.width / 3); x < (2 * size.width) / 3; x++) {
          sum += picture.at(x, y)[1]
        }
      }
      return sum
    }
    await draw({}) // shadows of clouds are drawn now
    /** Mean light over frames: each finds rain at other places. */
    const lightOf = async (isDark: { near?: boolean; far?: boolean }): Promise<number> => {
      let light = 0
      for (let frame = 0; frame < FRAMES; frame++) light += sumOf(await draw(isDark)) / FRAMES
      return light
    }
    const sum = await lightOf({})
    const lossTo = async (isDark: { near?: boolean; far?: boolean }): Promise<number> =>
      sum - (await lightOf(isDark))
    const all = await lossTo({ near: true, far: true })
    const [near, far] = [await lossTo({ near: true }), await lossTo({ far: true })]
    const parts = [near / all, far / all, all / sum].map(part => part.toFixed(3))
    t.note(`near shade takes ${parts[0]}, far ${parts[1]} of what both take, ${parts[2]} of all`)
    expectTrue(near > 0.1 * all && far > 0.1 * all, `near ${near}, far ${far} of ${all}`)
    // What rain scatters more than once stays.
    expectTrue(all > 0.03 * sum, `all shade takes ${all} of ${sum}`)
    // What is lost to one shade or the other is lost to both.
    expectClose(near + far, all, { relative: 0.04 }, 'near and far')
    for (const owned of [node, pipeline, light, noise, set]) owned.dispose()
  },
  // The same look-ups as in clouds, which WebGL draws, too.
  { backends: ['webgpu'], timeoutSeconds: 120 }
)

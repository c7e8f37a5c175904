import type { LightShaftsQuality } from '@welkin/atmosphere'
import { float, mix, vec4 } from 'three/tsl'
import type { Vec4 } from '../../../packages/atmosphere/src/tsl-types'
import { expectTrue } from '../harness/expect'
import { gpuTest } from '../harness/gpu-test'
import { addBox, stage, stageSize as size } from '../harness/shaft-stage'

/** Altitude below which the diffuse light of the air is dim, as under clouds [m]. */
const DECK = 10_000

/** Rows of the picture above the ground. */
const ROWS = 22

/** Greatest error of the light that a pixel at a silhouette loses, of what it loses. */
const MOST_ERROR = 0.12

gpuTest(
  'takes diffuse light along a silhouette as beside it',
  async t => {
    const renderer = await t.createRenderer(size)
    const set = stage(renderer, 5)
    const { shafts, camera, scene } = set
    // A wall across the picture, whose top is level, 10° high.
    addBox(scene, [0, 1250, -15_000], [80_000, 2500, 100])
    camera.rotation.x = 0.15
    const under: Vec4 = vec4(0.05, 0.1, 0.1, 0.2)
    shafts.add({
      castInto: () => ({
        transmittance: () => () => float(1),
        diffuse: ({ view, offset }) =>
          mix(under, vec4(1), view.localCoordinates(offset).altitude.div(DECK).clamp())
      })
    })
    shafts.enabled = false
    const lit = await set.draw()
    shafts.enabled = true
    const lostIn = async (quality: LightShaftsQuality): Promise<number[]> => {
      shafts.set({ quality })
      const picture = await set.draw()
      return Array.from({ length: ROWS }, (_, y) => lit.at(32, y)[1] - picture.at(32, y)[1])
    }
    const exact = await lostIn('reference')
    // In small pictures all others have as many samples.
    const errors = (await lostIn('medium')).map((lost, y) => Math.abs(lost / exact[y] - 1))
    const most = Math.max(...errors)
    t.note(`off by ${(100 * most).toFixed(1)} % at most, in row ${errors.indexOf(most)}`)
    expectTrue(most <= MOST_ERROR, `a row's lost light is off by ${most}`)
    set.dispose()
  },
  // The grid is the same on WebGL.
  { backends: ['webgpu'] }
)

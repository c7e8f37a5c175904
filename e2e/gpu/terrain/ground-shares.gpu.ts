import { float, vec3, vec4 } from 'three/tsl'
import type { Node } from 'three/webgpu'
import { groundShares as twin } from '../../../packages/terrain/src/surface/cpu/groundRules'
import type { Grain } from '../../../packages/terrain/src/surface/tsl/grain'
import {
  groundClimate,
  groundRules,
  groundZone,
  type GroundPlace
} from '../../../packages/terrain/src/surface/tsl/groundRules'
import { sharesOf } from '../../../packages/terrain/src/surface/tsl/groundShares'
import { randomSequence } from '../../../stories/src/random'
import { gpuTest } from '../harness/gpu-test'

type Float = Node<'float'>

/** No stones, and pixels that are smaller than all else. */
const none = float(0)
const grain = {
  stone: none,
  blade: none,
  boulder: none,
  tuft: none,
  crown: none,
  brush: none,
  lost: none,
  footprint: none
} as unknown as Grain

gpuTest('the ground consists of the same materials on the CPU and the GPU', async t => {
  const random = randomSequence(3)
  // Height, patchiness, climate, and sine of the latitude.
  const inputs = Array.from({ length: 300 }, () => [
    4500 * random() ** 2 - 20,
    1.2 * (random() - 0.5),
    1.2 * (random() - 0.5),
    2 * random() - 1
  ])
  let worst = 0
  for (const [tilt, seaLevel] of [
    [0, 0],
    [0.55, 300],
    [0.8, 0],
    [0, -1e6]
  ]) {
    const sharesAt = (input: Node<'vec4'>) => {
      const { x, y, z, w } = input as unknown as Record<'x' | 'y' | 'z' | 'w', Float>
      // Downhill towards the south.
      const level = w.mul(w).oneMinus().sqrt()
      const [sine, cosine] = [Math.sin(tilt), Math.cos(tilt)]
      const place = {
        height: x,
        patch: y,
        climate: z,
        pole: vec3(0, 0, 1),
        zone: groundZone(w),
        up: vec3(level, 0, w),
        normal: vec3(level.mul(cosine).add(w.mul(sine)), 0, w.mul(cosine).sub(level.mul(sine))),
        cosSlope: float(Math.cos(tilt)),
        hollow: none
      } as unknown as GroundPlace
      return sharesOf(groundRules(place, grain, groundClimate(place, float(seaLevel))).layers)
    }
    const first = await t.evaluate(inputs, input => {
      const { snow, rock, sand, scree } = sharesAt(input)
      return vec4(snow, rock, sand, scree)
    })
    const second = await t.evaluate(inputs, input => {
      const { desert, forest, grass } = sharesAt(input)
      return vec4(desert, forest, grass, 0)
    })
    for (const [i, [height, patch, climate, sinLatitude]] of inputs.entries()) {
      const overSea = height - seaLevel
      const sinNormal = Math.sin(Math.asin(sinLatitude) - tilt)
      const cosSlope = Math.cos(tilt)
      const cpu = twin({ height, overSea, patch, climate, sinLatitude, sinNormal, cosSlope })
      const expected = [cpu.snow, cpu.rock, cpu.sand, cpu.scree, cpu.desert, cpu.forest, cpu.grass]
      const found = [...first.subarray(4 * i, 4 * i + 4), ...second.subarray(4 * i, 4 * i + 3)]
      for (const [n, share] of found.entries()) {
        worst = Math.max(worst, Math.abs(share - expected[n]))
      }
    }
  }
  t.note(`shares within ${worst.toExponential(1)}`)
  if (!(worst < 1e-4)) throw new Error(`shares differ by ${worst}`)
})

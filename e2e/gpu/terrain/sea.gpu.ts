import { float, vec3, vec4 } from 'three/tsl'
import * as onCPU from '../../../packages/terrain/src/surface/cpu/seaSurface'
import { seaSlopeVariance } from '../../../packages/terrain/src/surface/seaWaves'
import { seaSurface, waterFresnel } from '../../../packages/terrain/src/surface/tsl/seaSurface'
import { gpuTest } from '../harness/gpu-test'

gpuTest('a shader finds the waves that the CPU does', async t => {
  const up = [0.48, 0.6, 0.64] as const
  const variance = seaSlopeVariance(9)
  const seconds = 41.3
  const inputs = Array.from({ length: 200 }, (_, i) => [
    Math.fround(128 * Math.sin(12.9 * i)),
    Math.fround(128 * Math.sin(78.2 * i + 1)),
    Math.fround(128 * Math.sin(37.7 * i + 2)),
    Math.fround(0.02 * 300 ** ((i % 20) / 20))
  ])
  const results = await t.evaluate(inputs, input => {
    const place = {
      offset: input.xyz,
      depth: float(10),
      up: vec3(...up),
      footprint: input.w,
      spread: float(0)
    }
    const { slope, variance: left } = seaSurface(place, float(variance), float(seconds))
    return vec4(slope, left)
  })
  let worst = 0
  for (const [i, [x, y, z, footprint]] of inputs.entries()) {
    const { slope, variance: left } = onCPU.seaWaves([x, y, z], up, footprint, variance, seconds)
    for (const [n, value] of [...slope, left].entries()) {
      worst = Math.max(worst, Math.abs(results[4 * i + n] - value))
    }
  }
  t.note(`within ${worst.toExponential(1)}`)
  if (!(worst < 1e-3)) throw new Error(`waves differ by ${worst}`)
})

gpuTest('a shader finds the reflectance of water that the CPU does', async t => {
  const inputs = Array.from({ length: 400 }, (_, i) => [
    Math.fround((i % 20) / 19),
    Math.fround(0.2 * (Math.floor(i / 20) / 19) ** 2)
  ])
  const results = await t.evaluate(inputs, input => vec4(waterFresnel(input.x, input.y), 0, 0, 1))
  let worst = 0
  for (const [i, [cosine, variance]] of inputs.entries()) {
    const expected = onCPU.waterFresnel(cosine, variance)
    worst = Math.max(worst, Math.abs(results[4 * i] - expected))
  }
  t.note(`within ${worst.toExponential(1)}`)
  if (!(worst < 1e-5)) throw new Error(`reflectances differ by ${worst}`)
})

import { vec4 } from 'three/tsl'
import { streakOf } from '../../../packages/clouds/test/twins/precipitation'
import { fallForm, STRONGEST } from '../../../packages/clouds/src/precipitation/fallForm'
import { fallStreak } from '../../../packages/clouds/src/precipitation/tsl/fallStreak'
import { evaluateOnGpu } from '../harness/evaluate'
import { expectClose, expectTrue } from '../harness/expect'
import { gpuTest } from '../harness/gpu-test'

/** Deviation of the streaks' noise near by. */
const DEVIATION = Math.hypot(fallForm.coarseStreaks, fallForm.fineStreaks)

gpuTest('streaks what falls as float64 does', async t => {
  const renderer = await t.createRenderer()
  const cases: [deviations: number, amount: number, lost: number][] = []
  for (const amount of [0, 0.5, 1, 1.6, 2]) {
    for (const lost of [0, 0.3, 0.9, 1]) {
      for (const deviations of [-3, -1, 0, 0.4, 1, 2, 4]) cases.push([deviations, amount, lost])
    }
  }
  // The shader takes noise as blur has left it; the twin, its deviations.
  const inputs = cases.map(([deviations, amount, lost]) => [
    deviations * DEVIATION * (1 - lost),
    amount,
    lost
  ])
  const results = await evaluateOnGpu(renderer, inputs, input =>
    vec4(fallStreak(input.x, input.y, input.z), 0, 0, 1)
  )
  let strongest = 0
  cases.forEach(([deviations, amount, lost], i) => {
    const expected = streakOf(deviations, amount, lost)
    if (expected === STRONGEST) strongest++
    const told = `${deviations} deviations, amount ${amount}, lost ${lost}`
    expectClose([results[4 * i]], [expected], { relative: 2e-5 }, told)
  })
  t.note(`${strongest} of ${cases.length} at the bound`)
  // The bound is reached, and not by all.
  expectTrue(strongest > 0 && strongest < cases.length / 4, `${strongest} at the bound`)
})

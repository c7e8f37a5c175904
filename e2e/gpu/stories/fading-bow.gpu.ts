import { raindrops } from '@welkin/atmosphere'
import { float } from 'three/tsl'
import type { Node } from 'three/webgpu'
import { FadingBow } from '../../../stories/src/valley/FadingBow'
import { evaluateOnGpu } from '../harness/evaluate'
import { expectTrue } from '../harness/expect'
import { gpuTest } from '../harness/gpu-test'

/** Steps of the scattering angle, half a degree each. */
const STEPS = 360

/** Share of light that is diffracted straight on, which smooth rain leaves out. */
const DIFFRACTED = 0.5

const angles = Array.from({ length: STEPS }, (_, i) => ((i + 0.5) * Math.PI) / STEPS)

gpuTest('rain fades from its bow to smooth scattering of as much light, and back', async t => {
  const renderer = await t.createRenderer({ width: 8, height: 8 })
  const drops = raindrops({ rate: 12 })
  const rain = new FadingBow(drops)
  const inputs = angles.map(angle => [Math.cos(angle)])
  const phase = async (of: Pick<FadingBow, 'phase'>): Promise<number[]> => {
    const body = ({ x }: Node<'vec4'>) =>
      of.phase({ cosViewLight: x, cosView: float(0), cosLight: float(0) })
    const values = await evaluateOnGpu(renderer, inputs, body)
    return angles.map((_, i) => values[4 * i + 3]) // red
  }
  /** Brightness at an angle from the point opposite the sun [°]. */
  const at = (values: readonly number[], angle: number) => values[Math.round(2 * (180 - angle))]
  const total = (values: readonly number[]) =>
    values.reduce((sum, p, i) => sum + 2 * Math.PI * p * Math.sin(angles[i]) * (Math.PI / STEPS), 0)

  const physical = await phase(drops)
  const whole = await phase(rain)
  const other = Math.max(...angles.map((_, i) => Math.abs(whole[i] / physical[i] - 1)))
  expectTrue(other < 1e-5, `rain with its bow is off by ${other}`)
  const { version } = rain
  rain.strength = 0
  expectTrue(rain.version > version, 'who draws it does not know of the change')
  const smooth = await phase(rain)
  rain.strength = 0.5
  const half = await phase(rain)
  const [bow, without] = [physical, smooth].map(values => at(values, 41.8) / at(values, 46))
  t.note(`bow ${bow.toFixed(2)}, ${without.toFixed(2)} without; smooth ${total(smooth).toFixed(4)}`)
  expectTrue(bow > 3 && without > 0.9 && without < 1.1, `bow ${bow}, ${without} without it`)
  const error = Math.abs(total(smooth) - (1 - DIFFRACTED))
  expectTrue(error < 0.002, `smooth rain scatters ${total(smooth)}`)
  const between = angles.map((_, i) => Math.abs(2 * half[i] - whole[i] - smooth[i]) / whole[i])
  expectTrue(Math.max(...between) < 1e-4, `half of a bow is off by ${Math.max(...between)}`)
  rain.dispose()
})

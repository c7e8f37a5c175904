import type { HeightSample, HeightSource, SurfacePoint } from '@welkin/terrain'
import type { Vector3 } from 'three'
import { float, vec3, vec4 } from 'three/tsl'
import type { Node } from 'three/webgpu'
import { randomSequence } from '../../stories/src/random'

type Float = Node<'float'>

/** A plane wave: `vector` is of whole numbers, in periods of `period` [m], a power of two. */
interface Wave {
  readonly vector: readonly [number, number, number]
  readonly period: number
  readonly length: number
  readonly amplitude: number
}

/** Greatest slope of each wave [–]: all of them make slopes of 0.42 in the mean, as rough as mountains are. */
const SLOPE = 0.15

/** Periods of the longest and the shortest wave [binary logarithm, m]. */
const LONGEST = 18
const SHORTEST = 3

function wavesOf(): Wave[] {
  const random = randomSequence(77)
  const waves: Wave[] = []
  for (let exponent = LONGEST; exponent >= SHORTEST; exponent--) {
    const vector = [0, 1, 2].map(() => Math.round(8 * random() - 4)) as [number, number, number]
    if (vector.every(component => component === 0)) vector[0] = 3
    const length = 2 ** exponent / Math.hypot(...vector)
    waves.push({
      vector,
      period: 2 ** exponent,
      length,
      amplitude: (SLOPE * length) / (2 * Math.PI)
    })
  }
  return waves
}

/**
 * Rough ground of plane waves from 60 km to 2 m, which costs a hundredth of the procedural planet's: thousands of cameras see their pages within seconds.
 */
export class WaveHeights implements HeightSource {
  readonly #waves = wavesOf()
  readonly highest = this.#waves.reduce((sum, { amplitude }) => sum + amplitude, 0)
  readonly lowest = -this.highest

  variation(distance: number): number {
    return Math.min(SLOPE * this.#waves.length * distance, this.highest - this.lowest)
  }

  sampleAt({ x, y, z }: Vector3, target: HeightSample): HeightSample {
    target.height = 0
    target.gradient.set(0, 0, 0)
    for (const { vector, period, amplitude } of this.#waves) {
      const [a, b, c] = vector
      const phase = (2 * Math.PI * (a * x + b * y + c * z)) / period
      target.height += amplitude * Math.sin(phase)
      const slope = (2 * Math.PI * amplitude * Math.cos(phase)) / period
      target.gradient.x += slope * a
      target.gradient.y += slope * b
      target.gradient.z += slope * c
    }
    return target
  }

  sample({ reference, offset }: SurfacePoint, shortest: Float): Node<'vec4'> {
    return this.#waves.reduce<Node<'vec4'>>(
      (sum, { vector, period, length, amplitude }) => {
        const n = vec3(...vector)
        // Whole numbers: exact.
        const whole = reference
          .dot(n)
          .mul(Math.min(256 / period, 1))
          .fract()
        const turns = offset
          .dot(n)
          .div(period)
          .add(period > 256 ? whole : 0)
        const phase = turns.fract().mul(2 * Math.PI)
        const kept = float(length).div(shortest).sub(1).clamp(0, 1)
        const slope = phase.cos().mul((2 * Math.PI * amplitude) / period)
        return sum.add(vec4(n.mul(slope), phase.sin().mul(amplitude)).mul(kept))
      },
      vec4(0) as Node<'vec4'>
    )
  }
}

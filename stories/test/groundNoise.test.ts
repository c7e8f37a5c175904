import { expect, it } from 'vitest'
import { createGroundNoise } from '../src/valley/groundNoise'

it('has no lines along the lattice of its coarsest octave', () => {
  const noise = createGroundNoise()
  const { data: texels, width } = noise.image as { data: Uint8Array; width: number }
  const data = texels.filter((_, i) => i % 2 === 0)
  // Mean square step from one column to the next. Noise of values is steep between lattice lines and level at them.
  const steps = Array.from({ length: width }, (_, x) => {
    let sum = 0
    for (let y = 0; y < width; y++) {
      sum += (data[y * width + x] - data[y * width + ((x + 1) % width)]) ** 2
    }
    return sum / width
  })
  const mean = (values: number[]): number => values.reduce((a, b) => a + b, 0) / values.length
  const cell = width / 8
  const atLines = mean(steps.filter((_, x) => (x + 1) % cell <= 1))
  expect(atLines / mean(steps)).toBeGreaterThan(0.8)
  // It repeats: no step is greater at its edge.
  expect(steps[width - 1]).toBeLessThan(2 * mean(steps))
  const deviation = Math.sqrt(mean([...data].map(value => (value - 127.5) ** 2)))
  expect(deviation).toBeGreaterThan(25)
  expect(deviation).toBeLessThan(50)
  // Crowns are about 0.5, too, so that woods keep their height and colour far away.
  const crowns = texels.filter((_, i) => i % 2 === 1)
  expect(Math.abs(mean([...crowns]) - 127.5)).toBeLessThan(2)
  noise.dispose()
})

import { expect, it } from 'vitest'
import { pixelAt } from '../../src/march/FrameUniforms'

it.each([1, 2, 3, 4, 5, 6])(
  'marches each pixel of a block of %i once, neighbours in time apart',
  block => {
    const count = block ** 2
    const order = Array.from({ length: count }, (_, frame) => pixelAt(block, frame + 7 * count))
    expect([...order].sort((a, b) => a - b)).toEqual(order.map((_, i) => i))
    const apart = (from: number, to: number): number => {
      const along = Math.abs((from % block) - (to % block))
      const across = Math.abs(Math.floor(from / block) - Math.floor(to / block))
      return Math.hypot(Math.min(along, block - along), Math.min(across, block - across))
    }
    const least = block > 4 ? 2 : block > 2 ? Math.SQRT2 : 1
    if (block > 1)
      order.forEach((pixel, i) => {
        expect(apart(pixel, order[(i + 1) % count])).toBeGreaterThanOrEqual(least)
      })
  }
)

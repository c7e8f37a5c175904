import { expect, it } from 'vitest'
import { FrameUniforms } from '../../src/march/FrameUniforms'

it('gives small pictures a ray through what falls for each marched pixel, as many as a large one has', () => {
  const frame = new FrameUniforms()
  // 1920 × 1080, 640 × 360 and 320 × 180, one pixel of sixteen.
  const sizes = [
    [480, 270],
    [160, 90],
    [80, 45]
  ] as const
  expect(sizes.map(([width, height]) => frame.fallBlockOf(4, width, height))).toEqual([2, 1, 1])
  expect(frame.fallBlockOf(1, 1920, 1080)).toBe(1)
  const rays = (width: number, height: number): number =>
    (width * height) / frame.fallBlockOf(4, width, height) ** 2
  for (let width = 16; width < 480; width += 16)
    expect(rays(width, width / 2)).toBeLessThan(1.02 * rays(480, 270))
})

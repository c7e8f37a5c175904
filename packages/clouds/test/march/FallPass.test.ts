import { expect, it } from 'vitest'
import { fallBlockOf } from '../../src/march/FallPass'

it('gives small pictures a ray through what falls for each marched pixel, as many as a large one has', () => {
  // 1920 × 1080, 640 × 360 and 320 × 180, one pixel of sixteen.
  const pixels = [480 * 270, 160 * 90, 80 * 45]
  expect(pixels.map(count => fallBlockOf(4, count))).toEqual([2, 1, 1])
  expect(fallBlockOf(1, 1920 * 1080)).toBe(1)
  // Rays of larger blocks are far apart as it is.
  expect([5, 6].map(block => fallBlockOf(block, (1920 * 1080) / block ** 2))).toEqual([2, 1])
  const rays = (count: number): number => count / fallBlockOf(4, count) ** 2
  for (let count = 16; count < pixels[0]; count += 99)
    expect(rays(count)).toBeLessThan(1.02 * rays(pixels[0]))
})

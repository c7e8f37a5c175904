import fc from 'fast-check'
import { describe, expect, it } from 'vitest'
import { depthNormal, rayOf, type DepthPicture } from '../twins/lights/depthNormal'

const size = { width: 16, height: 9, tangent: 0.6 }
const unit = fc.double({ min: -1, max: 1, noNaN: true })

/** A plane through (0, 0, −10), with a normal towards the camera. */
function plane(x: number, y: number): { normal: number[]; distanceAt: DepthPicture['distanceAt'] } {
  const z = 1.6
  const length = Math.hypot(x, y, z)
  return {
    normal: [x / length, y / length, z / length],
    distanceAt: (column, row) => {
      const ray = rayOf({ ...size, distanceAt: () => 0 }, column, row)
      return (10 * z) / (z - x * ray.x - y * ray.y)
    }
  }
}

const apart = (a: readonly number[], b: readonly number[]): number =>
  Math.hypot(...a.map((value, i) => value - b[i]))

describe('depthNormal', () => {
  it('is that of a plane, in every pixel', () => {
    fc.assert(
      fc.property(unit, unit, fc.nat(15), fc.nat(8), (x, y, column, row) => {
        const { normal, distanceAt } = plane(x, y)
        const found = depthNormal({ ...size, distanceAt }, column, row)
        expect(apart(found, normal)).toBeLessThan(1e-9)
      })
    )
  })

  it('is that of its own side at an edge', () => {
    const [near, far] = [plane(0.4, -0.3), plane(-0.2, 0.5)]
    const distanceAt = (column: number, row: number): number =>
      column < 8 ? near.distanceAt(column, row) : 3 * far.distanceAt(column, row)
    for (const column of [6, 7, 8, 9]) {
      const { normal } = column < 8 ? near : far
      const found = depthNormal({ ...size, distanceAt }, column, 4)
      expect(apart(found, normal)).toBeLessThan(1e-9)
    }
  })
})

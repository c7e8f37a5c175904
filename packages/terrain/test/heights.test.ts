import fc from 'fast-check'
import { Ellipsoid } from '@welkin/geo'
import { Vector3 } from 'three'
import { expect, it } from 'vitest'
import { MountainHeights } from '../src/heights/MountainHeights'
import { latticeNoise } from '../src/noise/cpu/latticeNoise'

const earth = Ellipsoid.WGS84
const source = new MountainHeights({ seed: 1 })
const sampleAt = (position: Vector3) =>
  source.sampleAt(position, { height: 0, gradient: new Vector3() })
const noiseAt = (x: number, y: number, z: number) =>
  latticeNoise(x, y, z, 1, 3, { x: 0, y: 0, z: 0, value: 0 })

const coordinate = fc.double({ min: -1e6, max: 1e6, noNaN: true })
const directions = fc
  .tuple(...[0, 1, 2].map(() => fc.double({ min: -1, max: 1, noNaN: true })))
  .map(([x, y, z]) => new Vector3(x, y, z))
  .filter(vector => vector.length() > 0.1)
const subpoints = directions.map(direction => earth.footPoint(direction.setLength(6.4e6)))

it('is 0 at the corners of the lattice, and smooth across its cells', () => {
  fc.assert(
    fc.property(fc.integer({ min: -1e6, max: 1e6 }), coordinate, coordinate, (i, y, z) => {
      expect(noiseAt(i, Math.floor(y), Math.floor(z)).value).toBe(0)
      const before = { ...noiseAt(i - 1e-7, y, z) }
      const after = noiseAt(i + 1e-7, y, z)
      expect(after.value).toBeCloseTo(before.value, 5)
      expect(after.x).toBeCloseTo(before.x, 5)
    })
  )
})

it('has the gradient of its values', () => {
  const step = 0.01
  fc.assert(
    fc.property(subpoints, subpoint => {
      const { gradient } = sampleAt(subpoint)
      for (const axis of ['x', 'y', 'z'] as const) {
        const at = (shift: number): number => {
          const place = subpoint.clone()
          place[axis] += shift
          return sampleAt(place).height
        }
        expect((at(step) - at(-step)) / (2 * step)).toBeCloseTo(gradient[axis], 3)
      }
    })
  )
})

it('is within its bounds', () => {
  fc.assert(
    fc.property(
      subpoints,
      directions,
      fc.double({ min: -1, max: 6, noNaN: true }),
      (subpoint, to, power) => {
        const { height } = sampleAt(subpoint)
        expect(height).toBeGreaterThan(source.lowest)
        expect(height).toBeLessThan(source.highest)
        const distance = 10 ** power
        const there = earth.footPoint(to.setLength(distance).add(subpoint))
        const variation = source.variation(there.distanceTo(subpoint))
        expect(Math.abs(sampleAt(there).height - height)).toBeLessThanOrEqual(variation + 1e-9)
      }
    ),
    { numRuns: 2000 }
  )
})

it('has land and sea, plains and, on little of the land, belts of mountains', () => {
  const points = Array.from({ length: 4000 }, (_, i) => {
    const z = (2 * i + 1) / 4000 - 1
    const level = Math.sqrt(1 - z * z)
    const turn = i * 2.399963
    return earth.footPoint(
      new Vector3(level * Math.cos(turn), level * Math.sin(turn), z).setLength(6.4e6)
    )
  })
  const heightOf = (point: Vector3): number => sampleAt(point).height
  const land = points.filter(point => heightOf(point) > 0)
  expect(land.length / points.length).toBeGreaterThan(0.2)
  expect(land.length / points.length).toBeLessThan(0.6)
  /** Differences of height within 10 km. */
  const reliefs = land.map(point => {
    const east = new Vector3(0, 0, 1).cross(point).normalize()
    const north = point.clone().normalize().cross(east)
    const heights = [0, 1, 2, 3, 4, 5].map(i => {
      const there = point.clone().addScaledVector(east, 1e4 * Math.cos(i))
      return heightOf(earth.footPoint(there.addScaledVector(north, 1e4 * Math.sin(i))))
    })
    return Math.max(...heights) - Math.min(...heights)
  })
  const share = (least: number): number =>
    reliefs.filter(relief => relief > least).length / reliefs.length
  expect(share(1500)).toBeGreaterThan(0.01)
  expect(share(1000)).toBeLessThan(0.25)
  expect(share(300)).toBeLessThan(0.6)
  expect(Math.max(...land.map(heightOf))).toBeGreaterThan(3500)
})

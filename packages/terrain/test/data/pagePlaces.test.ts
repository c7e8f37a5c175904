import fc from 'fast-check'
import { Vector3 } from 'three'
import { expect, it } from 'vitest'
import { geographicPlace } from '../../src/data/geographic'
import { mercatorX, mercatorY } from '../../src/data/mercator'
import { pagePlaces } from '../../src/data/pagePlaces'
import { earth, pageAt } from './tiles'

const STEPS = 132
const place = { longitude: 0, latitude: 0 }
const project = (position: Vector3, target: { x: number; y: number }): void => {
  geographicPlace(position, earth.radii, place)
  target.x = mercatorX(place.longitude)
  target.y = mercatorY(place.latitude)
}

it('are on the map to 2 mm or a 5,000th of a step, interpolated on most pages', () => {
  const pages = fc.tuple(
    fc.double({ min: -180, max: 180, noNaN: true }),
    fc.double({ min: -85, max: 85, noNaN: true }),
    fc.integer({ min: 2, max: 18 })
  )
  let smooth = 0
  let fine = 0
  fc.assert(
    fc.property(pages, ([longitude, latitude, level]) => {
      const page = pageAt(longitude, latitude, level, STEPS)
      const { x, y, isSmooth } = pagePlaces(page, project, 1)
      smooth += Number(isSmooth)
      fine += Number(level >= 5 && Math.abs(latitude) < 75)
      const most = Math.max(2e-3, page.spacing / 5000)
      const position = new Vector3()
      const exact = { x: 0, y: 0 }
      // Off the knots, at the corners, and anywhere.
      for (const i of [0, 5, 66, STEPS - 4, STEPS + 2]) {
        for (const j of [0, 6, 71, STEPS - 3, STEPS + 2]) {
          project(page.placeOf(i, j, position), exact)
          const width = 2 * Math.PI * earth.maximumRadius * Math.cos(place.latitude)
          const n = j * page.side + i
          expect(Math.abs(x[n] - exact.x) * width).toBeLessThan(most)
          expect(Math.abs(y[n] - exact.y) * width).toBeLessThan(most)
        }
      }
    }),
    { numRuns: 300 }
  )
  expect(smooth).toBeGreaterThan(0.95 * fine)
})

it('are found of few places: a page takes no more than a tenth of the projections', () => {
  let projections = 0
  const counted = (position: Vector3, target: { x: number; y: number }): void => {
    projections++
    project(position, target)
  }
  const page = pageAt(1, 47, 8, STEPS)
  pagePlaces(page, counted, 1)
  expect(projections).toBeLessThan(page.side ** 2 / 10)
  // Too near a pole they are exact.
  projections = 0
  const { isSmooth } = pagePlaces(pageAt(1, 89.9, 8, STEPS), counted, 1)
  expect(isSmooth).toBe(false)
  expect(projections).toBe(page.side ** 2)
})

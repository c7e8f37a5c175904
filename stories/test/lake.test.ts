import { expect, it } from 'vitest'
import { groundHeight } from '../src/valley/ground'
import { skylineHeight } from '../src/valley/lake'
import { LAKE } from '../src/valley/places'

/** Places along the lake: its ends and its middle. */
const places = [-0.8, 0, 0.8].map(part => LAKE.z + part * LAKE.halfLength)

it('mirrors the mountains that one sees from the shore, not those seen from the middle of the lake', () => {
  const azimuths = Array.from({ length: 16 }, (_, i) => (Math.PI * i) / 8)
  const differences = azimuths.map(azimuth => {
    const heights = places.map(from => skylineHeight(azimuth, from))
    return Math.max(...heights) - Math.min(...heights)
  })
  // 0.1 is some 5° of the sky, a twelfth of the picture's height.
  expect(Math.max(...differences)).toBeGreaterThan(0.1)
})

it.each(places)('finds no mountain that stands out of the skyline from %d m', from => {
  for (const azimuth of [0.3, 2.8, 4.7]) {
    const tangents = Array.from({ length: 400 }, (_, i) => {
      const distance = 250 + 30 * i
      const x = LAKE.x + distance * Math.cos(azimuth)
      return groundHeight(x, from + distance * Math.sin(azimuth)) / distance
    })
    expect(Math.max(...tangents) - skylineHeight(azimuth, from)).toBeLessThan(0.05)
  }
})

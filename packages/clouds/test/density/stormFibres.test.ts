import fc from 'fast-check'
import { Vector3 } from 'three'
import { describe, expect, it } from 'vitest'
import { cloudPreset } from '../../src'
import { stormFibres, stormPlaces } from '../../src/density/stormForm'
import { stormCell } from '../../src/layers/storms'
import { stormAround, stormGaps } from '../twins/storm'

const layer = cloudPreset('cumulonimbus').at(0).parameters
const angle = fc.double({ min: 0, max: 6.28, noNaN: true })

describe('stormAround', () => {
  it('has fibres that are as wide about their tower as at its core, where a storm may have none', () => {
    const place = fc.double({ min: 0, max: 1, noNaN: true })
    fc.assert(
      fc.property(fc.tuple(place, place, place), angle, angle, (from, turn, side) => {
        const up = new Vector3(Math.cos(turn), Math.sin(turn), 0)
        const level = new Vector3(0, 0, Math.cos(side)).addScaledVector(
          new Vector3(-up.y, up.x, 0),
          Math.sin(side)
        )
        const { anvil } = stormGaps(from, up, new Vector3())
        // Without shear its tower stands in the middle of an anvil.
        const tower = anvil.projectOnPlane(up).divideScalar(stormPlaces.cells)
        const cell = stormCell(layer)
        const placeAt = (metres: number): Vector3 => {
          const aside = level.clone().multiplyScalar(metres / cell / stormPlaces.cells)
          return new Vector3(...from).add(tower).add(aside)
        }
        // Between two storms, another one may be the nearest.
        const stormAt = (at: Vector3): Vector3 =>
          stormGaps(at.toArray(), up, new Vector3()).anvil.addScaledVector(at, stormPlaces.cells)
        const [east, west] = [placeAt(100), placeAt(-100)]
        fc.pre(stormAt(east).distanceTo(stormAt(west)) < 1e-6)
        const [there, back] = [east, west].map(
          at => stormAround(layer, at.toArray(), up).fibrePlace
        )
        const apart = there.distanceTo(back)
        expect(apart).toBeLessThan((1.05 * 200 * stormFibres.around) / stormFibres.core / cell)
      }),
      { numRuns: 100, examples: [[[0, 0.3362541508754233, 0.945939226982083], 0, 0]] }
    )
  })
})

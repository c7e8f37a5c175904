import fc from 'fast-check'
import { Vector3 } from 'three'
import { describe, expect, it } from 'vitest'
import { cyclones } from '../../src/density/systemsForm'
import { cycloneAround, frontsAndBelts } from '../twins/weatherSystems'

const direction = fc
  .tuple(fc.double({ min: -1, max: 1, noNaN: true }), fc.double({ min: 0, max: 6.28, noNaN: true }))
  .map(([z, angle]) => {
    const across = Math.sqrt(1 - z * z)
    return new Vector3(across * Math.cos(angle), across * Math.sin(angle), z)
  })

describe('cyclones', () => {
  it('do not touch each other, or the equator', () => {
    const centres = cyclones.map(({ centre }) => new Vector3(...centre))
    cyclones.forEach(({ radius }, i) => {
      expect(centres[i].length()).toBeCloseTo(1)
      expect(centres[i].z).toBeGreaterThan(radius)
      // Beyond half of the distance the other one is nearer.
      for (const other of centres) {
        if (other !== centres[i]) expect(other.distanceTo(centres[i]) / 2).toBeGreaterThan(radius)
      }
    })
  })

  it('turn air on the sphere, about their middle and no farther than their rim', () => {
    fc.assert(
      fc.property(direction, up => {
        const { displacement, share, square, from } = cycloneAround(up)
        const source = up.clone().add(displacement)
        expect(source.length()).toBeCloseTo(1, 9)
        if (share === 0) expect(displacement.length()).toBe(0)
        // The source is as far from the middle: chord² = 2 − 2 √(1 − east² − north²).
        const across = from[0] ** 2 + from[1] ** 2
        if (square < 1) expect(2 - 2 * Math.sqrt(1 - across)).toBeCloseTo(square, 6)
      })
    )
  })

  it('turn against the clock north of the equator, with the clock south of it', () => {
    const [{ centre, radius }] = cyclones
    const middle = new Vector3(...centre)
    const east = new Vector3(-middle.y, middle.x, 0).normalize()
    const place = middle
      .clone()
      .addScaledVector(east, radius / 2)
      .normalize()
    // East of a low the air comes from the equator.
    expect(cycloneAround(place).displacement.z).toBeLessThan(-0.01)
    expect(cycloneAround(place.setZ(-place.z)).displacement.length()).toBeGreaterThanOrEqual(0)
    const southern = Array.from({ length: 720 }, (_, i) => {
      const angle = (i * Math.PI) / 360
      const across = Math.hypot(middle.x, middle.y)
      return new Vector3(across * Math.cos(angle), across * Math.sin(angle), -middle.z)
    }).reduce((a, b) => (cycloneAround(a).square < cycloneAround(b).square ? a : b))
    const southEast = new Vector3(-southern.y, southern.x, 0).normalize()
    const beside = southern
      .clone()
      .addScaledVector(southEast, radius / 2)
      .normalize()
    // So it does there: from the north.
    expect(cycloneAround(beside).displacement.z).toBeGreaterThan(0.01)
  })
})

describe('frontsAndBelts', () => {
  const calm = [0, 0, 0, 0]
  const at = (latitude: number, longitude = 0): number => {
    const [phi, lambda] = [latitude, longitude].map(x => (x * Math.PI) / 180)
    const up = new Vector3(
      Math.cos(phi) * Math.cos(lambda),
      Math.cos(phi) * Math.sin(lambda),
      Math.sin(phi)
    )
    return frontsAndBelts(up, [0, 0, 0], calm, cycloneAround(up))
  }

  it('has a convergence zone about the equator and clear subtropics on both sides', () => {
    for (const side of [1, -1]) {
      expect(at(side * 5.5)).toBeGreaterThan(0.4)
      expect(at(side * 25)).toBeLessThan(-0.8)
      expect(at(side * 25)).toBeLessThan(at(side * 70))
    }
  })

  it('has no step anywhere', () => {
    fc.assert(
      fc.property(direction, direction, (up, other) => {
        const step = 1e-4
        const near = up.clone().addScaledVector(other, step).normalize()
        const [a, b] = [up, near].map(v =>
          frontsAndBelts(v, [0.3, -0.5, 0.2], calm, cycloneAround(v))
        )
        // Fronts are sharp, but 200 km wide: the slope stays below 400.
        expect(Math.abs(a - b)).toBeLessThan(400 * step)
      }),
      { numRuns: 2000 }
    )
  })
})

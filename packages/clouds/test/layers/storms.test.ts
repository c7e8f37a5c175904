import { Vector3 } from 'three'
import { describe, expect, it } from 'vitest'
import { cloudPreset } from '../../src'
import { billowForm } from '../../src/density/formConstants'
import { stormPlaces } from '../../src/density/stormForm'
import { layerPeriods } from '../../src/layers/layerUniforms'
import { isStorm, stormBody, stormCell, stormRadius } from '../../src/layers/storms'
import { hashBits, type Vec3Array } from '../twins/noise'
import { stormAround, stormAside } from '../twins/storm'

const { parameters: storm } = cloudPreset('cumulonimbus').at(0)
const THICKNESS = storm.topAltitude - storm.baseAltitude

/** Radius of a storm's body at a height [m]. */
function radiusAt(radius: number, height: number): number {
  let [inside, outside] = [0, 3 * radius]
  if (stormBody(storm, 0, radius, height) < 0) return 0
  for (let i = 0; i < 40; i++) {
    const middle = (inside + outside) / 2
    if (stormBody(storm, middle, radius, height) > 0) inside = middle
    else outside = middle
  }
  return inside
}

const random = (i: number): number => (hashBits(i, 7, 13)[0] >>> 0) / 2 ** 32

/** Random places in the lattice, and zeniths. */
const places = Array.from({ length: 3000 }, (_, i) => {
  const z = 2 * random(5 * i + 3) - 1
  const [across, angle] = [Math.sqrt(1 - z * z), 2 * Math.PI * random(5 * i + 4)]
  return {
    place: [random(5 * i), random(5 * i + 1), random(5 * i + 2)] as const,
    up: new Vector3(across * Math.cos(angle), across * Math.sin(angle), z)
  }
})

describe('storms', () => {
  it('are layers of the weather of cumulonimbus alone', () => {
    expect(isStorm(storm)).toBe(true)
    expect(isStorm({ ...storm, weatherWeights: [0.1, 0, 1, 0] })).toBe(false)
    expect(isStorm(cloudPreset('congestus').at(0).parameters)).toBe(false)
  })

  it('have ranks that are equally frequent, so that they cover what is asked for', () => {
    const ranks = places.map(({ place, up }) => stormAround(storm, place, up).rank)
    for (const share of [0.1, 0.25, 0.5, 0.75, 0.9]) {
      const covered = ranks.filter(rank => rank > 1 - share).length / ranks.length
      expect(Math.abs(covered - share), `${covered} for ${share}`).toBeLessThan(0.03)
    }
  })

  it('have the radius whose rank their coverage asks for', () => {
    for (const coverage of [0.2, 0.3, 0.6]) {
      const radius = stormRadius(storm, 0, coverage, 2)
      const rank = Math.exp(-((radius / stormCell(storm) / stormPlaces.scale) ** stormPlaces.power))
      const quantile = Math.log(coverage / (1 - coverage)) / 1.702
      expect(2 * (rank - 0.5) + quantile).toBeCloseTo(0, 6)
    }
    expect(stormRadius(storm, 0.4, 0.3, 2)).toBeGreaterThan(stormRadius(storm, 0, 0.3, 2))
  })

  it('have the anatomy of simulated ones: a narrow tower, a broad anvil, a dome', () => {
    const radius = 8000
    const areas = [0.1, 0.2, 0.3, 0.5, 0.68, 0.9].map(
      height => (radiusAt(radius, height) / radiusAt(radius, 0.66)) ** 2
    )
    // storm.json: 0.02 to 0.1 up to 0.35 of the height, 0.45 at half, 1 at 0.68, 0.3 at 0.9.
    for (const area of areas.slice(0, 3)) {
      expect(area).toBeGreaterThan(0.02)
      expect(area).toBeLessThan(0.15)
    }
    expect(areas[3]).toBeGreaterThan(0.2)
    expect(areas[3]).toBeLessThan(0.7)
    expect(areas[4]).toBeGreaterThan(0.9)
    expect(areas[5]).toBeGreaterThan(0.005)
    expect(areas[5]).toBeLessThan(0.4)
  })

  it('have a tower upwind of the middle of the anvil, within its rim', () => {
    const radius = 8000
    const aside = stormAside(storm, radius)
    const bodyAt = (x: number, height: number): number =>
      stormBody(storm, Math.abs(x), radius, height, Math.abs(x + aside))
    expect(aside).toBeGreaterThan(0.3 * radius)
    for (const height of [0.05, 0.2, 0.35]) {
      expect(bodyAt(-aside, height)).toBeGreaterThan(1000)
      expect(bodyAt(-radius, height)).toBeLessThan(0)
      expect(bodyAt(aside, height)).toBeLessThan(0)
    }
    expect(bodyAt(0.9 * radius, 0.68)).toBeGreaterThan(0)
    // The dome is over the tower.
    expect(bodyAt(-aside, 0.85)).toBeGreaterThan(0)
    expect(bodyAt(aside, 0.85)).toBeLessThan(0)
    expect(stormAside({ ...storm, shear: 0 }, radius)).toBe(0)
    expect(stormAside({ ...storm, shear: -5 }, radius)).toBeLessThanOrEqual(0.5 * radius)
  })

  it('are no taller than their thickness, and lower where they are small', () => {
    const top = (radius: number): number => {
      const heights = Array.from({ length: 200 }, (_, i) => (i + 0.5) / 200)
      return Math.max(...heights.filter(height => stormBody(storm, 0, radius, height) > 0))
    }
    expect(top(8000)).toBeLessThan(0.97)
    expect(top(8000)).toBeGreaterThan(0.85)
    expect(top(1500)).toBeLessThan(0.65)
  })

  it('have no walls where they crowd: one whose anvil is farther may have the nearer tower', () => {
    const radius = stormRadius(storm, 0, 0.7, 2)
    const step = 20
    let steepest = 0
    for (const { place, up } of places) {
      const downwind = new Vector3(1, 0, 0).cross(up)
      const along = up.clone().cross(downwind).normalize()
      along.addScaledVector(downwind, 2 / downwind.length()).normalize()
      const moved = along.multiplyScalar(step / stormCell(storm) / stormPlaces.cells)
      const there = place.map((x, i) => x + moved.getComponent(i)) as [number, number, number]
      const [before, after] = [place, there].map(at => {
        const { distance, towerDistance } = stormAround(storm, at, up, downwind, radius)
        return stormBody(storm, distance, radius, 0.3, towerDistance)
      })
      steepest = Math.max(steepest, Math.abs(after - before) / step)
    }
    // Places aside of the surface have greater slopes: the cube of their height is in the distance.
    expect(steepest).toBeLessThan(3)
  })

  it('have no walls midway between two, where turbulence bends them by as much as it does', () => {
    const radius = stormRadius(storm, 0, 0.7, 2)
    const bend = 3 * storm.turbulence * billowForm.bend * layerPeriods(storm).shape
    const step = 20
    const periodsOf = (metres: number): number => metres / stormCell(storm) / stormPlaces.cells
    let steepest = 0
    for (const [i, { place, up }] of places.entries()) {
      const level = (seed: number): Vector3 =>
        new Vector3(...[0, 1, 2].map(axis => random(9 * i + 3 * seed + axis) - 0.5))
          .projectOnPlane(up)
          .normalize()
      const [along, aside, downwind] = [0, 1, 2].map(level)
      const moved = (from: Vec3Array, direction: Vector3, metres: number): Vec3Array => {
        const [x, y, z] = direction.clone().multiplyScalar(periodsOf(metres))
        return [from[0] + x, from[1] + y, from[2] + z]
      }
      const [before, after] = [place, moved(place, along, step)].map(still => {
        const found = stormAround(storm, moved(still, aside, bend), up, downwind, radius, still)
        return [found.distance, found.towerDistance]
      })
      before.forEach((distance, k) => {
        // Neither anvils nor towers reach farther.
        if (Math.min(distance, after[k]) > [1.1, 0.6][k] * radius) return
        steepest = Math.max(steepest, Math.abs(after[k] - distance) / step)
      })
    }
    // Else nearly 100: a step of twice the bend.
    expect(steepest).toBeLessThan(2)
  })

  it('have a distance outside of their bodies within which there is none of them', () => {
    for (const { place } of places) {
      const [distance, height, radius] = [20_000 * place[0], place[1], 1000 + 11_000 * place[2]]
      const aside = stormAside(storm, radius)
      const here = stormBody(storm, distance, radius, height, Math.abs(distance + aside))
      if (here > 0) continue
      for (let angle = 0; angle < 2 * Math.PI; angle += Math.PI / 8) {
        const [x, y] = [Math.cos(angle), Math.sin(angle)].map(part => -0.9 * here * part)
        const there = height + y / THICKNESS
        if (there < 0 || there > 1) continue
        const [from, fromTower] = [distance + x, distance + x + aside].map(Math.abs)
        const body = stormBody(storm, from, radius, there, fromTower)
        expect(body, `${distance} ${height} ${radius} ${here}`).toBeLessThan(0)
      }
    }
  })
})

import { Atmosphere } from '@welkin/atmosphere'
import { Ellipsoid } from '@welkin/geo'
import { Matrix4, Vector3 } from 'three'
import { describe, expect, it } from 'vitest'
import { MountainHeights } from '../../src/heights/MountainHeights'
import type { Ground } from '../../src/rays/Ground'
import { Terrain } from '../../src/Terrain'
import { Walker, type WalkerOptions } from '../../src/walk/Walker'
import { groundOf, RADIUS } from '../ground'

const none = new Vector3()
const flat = groundOf(() => 0, [0, 0], 0)
/** A slope up to the east of longitude 0°, from its tangent. */
const slopeOf = (tangent: number, seaLevel = -Infinity): Ground => ({
  ...groundOf(({ x, y }) => tangent * RADIUS * Math.atan2(y, x), [-1e9, 1e9], tangent),
  seaLevel
})

/** A walker whose eyes begin over longitude and latitude 0°, or `east` of it [m]. */
function walkerOn(ground: Ground, height: number, options: WalkerOptions = {}, east = 0) {
  const walker = new Walker(ground, options)
  walker.moveTo(new Vector3(RADIUS + height, east, 0))
  const eye = new Vector3()
  return {
    walker,
    run: (seconds: number, direction = none, isJumping = false, step = 1 / 60): void => {
      for (let t = step / 2; t < seconds; t += step) walker.update(direction, isJumping, step)
    },
    /** Way to the east [m]. */
    east: () => RADIUS * Math.atan2(walker.eyePosition(eye).y, eye.x),
    eyeHeight: () => walker.eyePosition(eye).length() - RADIUS
  }
}

const EAST = new Vector3(0, 1, 0)
const WEST = new Vector3(0, -1, 0)

describe('in the air', () => {
  it('falls by g t²/2, and lands on its feet', () => {
    const { walker, run, eyeHeight } = walkerOn(flat, 101.7)
    run(3)
    expect(walker.state).toBe('falling')
    expect(eyeHeight()).toBeCloseTo(101.7 - (9.81 / 2) * 9, 6)
    expect(walker.verticalSpeed).toBeCloseTo(-9.81 * 3, 6)
    run(3)
    expect(walker.state).toBe('standing')
    expect(eyeHeight()).toBeCloseTo(1.7, 6)
    expect(walker.verticalSpeed).toBe(0)
  })

  it.each([20, 60, 144])('jumps by v²/2g at %i frames a second', rate => {
    const { run, eyeHeight, walker } = walkerOn(flat, 0, { jumpSpeed: 6, gravity: 3 })
    let highest = 0
    let frames = 0
    run(1 / rate, none, true, 1 / rate)
    for (; walker.state === 'falling' && frames < 10 * rate; frames++) {
      highest = Math.max(highest, eyeHeight())
      run(1 / rate, none, false, 1 / rate)
    }
    const time = frames / rate
    expect(highest - 1.7).toBeCloseTo(6, 1)
    expect(Math.abs(time - 4)).toBeLessThan(2 / rate)
  })

  it('jumps from the ground alone', () => {
    const { run, eyeHeight } = walkerOn(flat, 51.7)
    run(1, none, true)
    expect(eyeHeight()).toBeCloseTo(51.7 - 9.81 / 2, 6)
  })
})

describe('on the ground', () => {
  it('walks 3 m a second, after a tenth of one', () => {
    const { run, east, eyeHeight } = walkerOn(flat, 1.7)
    run(4, EAST)
    expect(east()).toBeCloseTo(3 * (4 - 0.1), 3)
    run(2, new Vector3(5, 0, 0)) // straight up: no level part
    expect(east()).toBeCloseTo(12, 3)
    run(2, new Vector3(0, -0.5, 0))
    expect(east()).toBeCloseTo(12 - 1.5 * 1.9, 3)
    expect(eyeHeight()).toBeCloseTo(1.7, 6)
  })

  it('goes as fast along a slope as on level ground, and does not slide where feet hold', () => {
    const { run, east, walker } = walkerOn(slopeOf(0.9), 0)
    run(5)
    expect(east()).toBeCloseTo(0, 6)
    run(4, EAST)
    expect(east()).toBeCloseTo((3 * (4 - 0.1)) / Math.hypot(1, 0.9), 2)
    expect(walker.state).toBe('standing')
    run(4, WEST)
    expect(walker.state).toBe('standing')
    expect(walker.height).toBeCloseTo(0.9 * east(), 2)
  })

  it('slides down a steeper one against friction, and climbs none', () => {
    const { run, east, walker } = walkerOn(slopeOf(2), 0)
    run(2, EAST)
    expect(walker.state).toBe('sliding')
    // g (sin − µ cos) along the slope, of which its cosine is level; µ = 0.6 tan 45°.
    const level = (9.81 * (2 - 0.6)) / 5
    expect(east()).toBeCloseTo((-level / 2) * 4, 3)
  })

  it('stops at a wall, and walks along one that it meets askew', () => {
    const wall = groundOf(({ y }) => Math.min(Math.max(8 * (RADIUS * y - 10), 0), 50), [0, 50], 8)
    const { run, east } = walkerOn(wall, 0)
    run(8, EAST)
    expect(east()).toBeGreaterThan(9)
    expect(east()).toBeLessThan(10.05)
    const askew = walkerOn(wall, 0)
    askew.run(8, new Vector3(0, 1, 1).normalize())
    expect(askew.east()).toBeLessThan(10.05)
    expect(askew.walker.eyePosition(new Vector3()).z).toBeGreaterThan(15)
  })

  it('steps over a kerb, and falls from an edge', () => {
    const stairs = groundOf(
      ({ y }) => (RADIUS * y < 3 ? 0 : RADIUS * y < 9 ? 0.25 : -30),
      [-30, 0.25],
      1e9
    )
    const { run, east, walker } = walkerOn(stairs, 0)
    run(2.5, EAST)
    expect(east()).toBeGreaterThan(5)
    expect(walker.height).toBeCloseTo(0.25, 6)
    run(1.5, EAST)
    expect(walker.state).toBe('falling')
    expect(walker.height).toBeLessThan(0)
  })

  it('comes to much the same place at any rate of frames', () => {
    const atmosphere = new Atmosphere()
    atmosphere.place({ longitude: 1, latitude: 47 })
    const terrain = new Terrain(atmosphere, new MountainHeights({ seed: 1 }), { resolution: 4 })
    const ends = [13, 30, 60, 144].map(rate => {
      const walker = new Walker(terrain).moveTo(new Vector3(0, 4000, 0))
      walker.moveTo(new Vector3(0, terrain.heightAt(1, 47) + 2, 0))
      const direction = new Vector3(1, 0, -0.6).normalize()
      for (let i = 0; i < 20 * rate; i++) walker.update(direction, false, 1 / rate)
      expect(walker.state).not.toBe('falling')
      return walker.eyePosition(new Vector3())
    })
    for (const end of ends) expect(end.distanceTo(ends[3])).toBeLessThan(0.5)
    expect(Math.hypot(ends[0].x, ends[0].z)).toBeGreaterThan(20)
    terrain.dispose()
  })
})

describe('in water', () => {
  /** A beach whose sea begins at 0 and is 0.1 m deeper per metre to the west. */
  const beach = slopeOf(0.1, 0)

  it('wades ever slower, floats with the eyes above water, and comes ashore', () => {
    const { run, walker, eyeHeight, east } = walkerOn(beach, 0, {}, -5)
    expect(walker.state).toBe('standing')
    run(1, WEST)
    const start = east()
    run(1, WEST)
    expect(start - east()).toBeLessThan(2.6)
    run(20, WEST)
    expect(walker.state).toBe('swimming')
    expect(eyeHeight()).toBeCloseTo(0.15 * 1.7, 2)
    const deep = east()
    run(1, WEST)
    expect(deep - east()).toBeCloseTo(3 * 0.4, 2)
    run(60, EAST)
    expect(walker.state).toBe('standing')
    expect(eyeHeight()).toBeGreaterThan(1.7)
  })

  it('dives after a fall, comes up and stays', () => {
    const { run, walker, eyeHeight } = walkerOn(beach, 20, {}, -500)
    let lowest = Infinity
    for (let i = 0; i < 50; i++) {
      run(0.1)
      lowest = Math.min(lowest, eyeHeight())
    }
    expect(lowest).toBeLessThan(-1)
    run(5)
    expect(walker.state).toBe('swimming')
    expect(eyeHeight()).toBeCloseTo(0.15 * 1.7, 3)
  })
})

it('walks around a planet and over its poles, in a world of kilometres that moves', () => {
  const worldToECEF = new Matrix4().makeScale(1000, 1000, 1000)
  const small = { ...flat, atmosphere: { ellipsoid: new Ellipsoid(1000, 1000, 990), worldToECEF } }
  const walker = new Walker(small, { speed: 12 }).moveTo(new Vector3(1.0017, 0, 0))
  const eye = new Vector3()
  const up = new Vector3()
  const north = new Vector3(0, 0, 1)
  const direction = new Vector3().copy(north)
  for (let i = 0; i < 600; i++) {
    walker.update(direction, false, 0.5)
    walker.eyePosition(eye).applyMatrix4(worldToECEF)
    small.atmosphere.ellipsoid.surfaceNormal(eye, up)
    direction.set(-up.z, 0, up.x) // along the meridian, whichever side of the pole
    expect(small.atmosphere.ellipsoid.heightAt(eye)).toBeCloseTo(1.7, 6)
    expect(Math.abs(eye.y)).toBeLessThan(1e-6)
    if (i === 200) worldToECEF.setPosition(500, 0, 0)
  }
  expect(eye.x).toBeLessThan(0)
  expect(walker.levelVelocity.length()).toBeCloseTo(12, 3)
})

it.each<[string, () => unknown]>([
  ['Walker: ground must be a Terrain', () => new Walker({} as never)],
  ["Walker: unknown option 'sped'", () => new Walker(flat, { sped: 1 } as never)],
  ['Walker: eyeHeight must be positive', () => new Walker(flat, { eyeHeight: 0 })],
  ['Walker: speed must be finite and ≥ 0', () => new Walker(flat, { speed: -1 })],
  ['Walker: jumpSpeed must be finite', () => new Walker(flat, { jumpSpeed: NaN })],
  ['Walker: gravity must be positive', () => new Walker(flat, { gravity: 0 })],
  ['Walker: steepest must be in [5, 80]', () => new Walker(flat, { steepest: 90 })],
  ['Walker.moveTo: eye must have finite', () => new Walker(flat).moveTo(new Vector3(NaN, 0, 0))],
  ['Walker.update: seconds must be finite and ≥ 0', () => new Walker(flat).update(none, false, -1)],
  [
    'Walker.update: direction must have finite',
    () => new Walker(flat).update(new Vector3(NaN, 0, 0), false, 0)
  ]
])('%s', (message, call) => {
  expect(call).toThrow(message)
})

import { Ellipsoid } from '@welkin/geo'
import { Walker, type Ground } from '@welkin/terrain'
import { Matrix4, Quaternion, Vector3 } from 'three'
import type { PerspectiveCamera } from 'three'
import { describe, expect, it } from 'vitest'
import type { ExplorerOptions } from '../src/moving/Explorer'
import { formatState, parseState } from '../src/moving/ExplorerState'
import { explore } from './explore'

const directionOf = (camera: PerspectiveCamera): Vector3 => camera.getWorldDirection(new Vector3())

describe('flight', () => {
  it('goes where the camera looks, and stops', () => {
    const { camera, press, release, run } = explore()
    press('KeyW')
    run(1)
    expect(camera.position.z).toBeLessThan(-2)
    expect(camera.position.x).toBeCloseTo(0)
    expect(camera.position.y).toBeCloseTo(2)
    release('KeyW')
    run(1)
    const { z } = camera.position
    run(1)
    expect(camera.position.z).toBe(z)
  })

  it('goes to the right with D, up with E, and down with Q no further than the ground', () => {
    const { camera, press, release, run } = explore()
    press('KeyD')
    press('KeyE')
    run(1)
    expect(camera.position.x).toBeGreaterThan(1)
    expect(camera.position.y).toBeGreaterThan(3)
    release('KeyE')
    press('KeyQ')
    run(10)
    expect(camera.position.y).toBeCloseTo(0.5)
  })

  it('is faster by height above the ground, Shift and the wheel', () => {
    const speed = (
      height: number,
      ground: number,
      act: (explored: ReturnType<typeof explore>) => void = () => {}
    ): number => {
      const explored = explore({ groundAt: () => ground }, height)
      act(explored)
      explored.press('KeyW')
      explored.run(1)
      const { z } = explored.camera.position
      explored.run(1)
      return z - explored.camera.position.z
    }
    const slow = speed(2, 0)
    expect(slow).toBeCloseTo(4, 2)
    expect(speed(1002, 0)).toBeCloseTo(504, 0)
    expect(speed(1002, 1000)).toBeCloseTo(slow, 5)
    expect(speed(2, 0, ({ press }) => press('ShiftLeft'))).toBeCloseTo(4 * slow, 1)
    expect(speed(2, 0, ({ wheel }) => wheel(-300))).toBeCloseTo(2 * slow, 1)
  })

  it('keeps heights, speeds and links in metres in a world of kilometres', () => {
    const { camera, explorer, press, run } = explore({ metersPerUnit: 1000 }, 1)
    press('KeyW')
    run(1)
    const { z } = camera.position
    run(1)
    expect(z - camera.position.z).toBeCloseTo(0.503, 3)
    expect(explorer.state.y).toBeCloseTo(1000)
    explorer.state = { x: 2000, y: 50, z: 0, heading: 0, pitch: 0, walking: 1 }
    expect(camera.position.x).toBeCloseTo(2)
    run(6)
    expect(camera.position.y).toBeCloseTo(0.0017)
  })

  it('takes a long frame for a tenth of a second', () => {
    const [hidden, shown] = [explore(), explore()]
    for (const { press, explorer } of [hidden, shown]) {
      press('KeyW')
      explorer.update(0.1)
    }
    hidden.explorer.update(3600)
    shown.explorer.update(0.1)
    expect(hidden.camera.position.z).toBe(shown.camera.position.z)
  })

  it('lets keys go with the page, and leaves those that are typed', () => {
    const { camera, press, hide, run } = explore()
    const field = { closest: (selector: string) => selector.includes('textarea') }
    press('KeyW', field)
    run(1)
    expect(camera.position.z).toBe(0)
    press('KeyW')
    hide()
    run(1)
    expect(camera.position.z).toBe(0)
  })
})

describe('looking', () => {
  it('turns to the right and up with the mouse, no further than the zenith', () => {
    const { camera, explorer, pointer, run } = explore()
    pointer('pointerdown', 'mouse', 1, 100, 100)
    pointer('pointermove', 'mouse', 1, 150, 50)
    run(0.1)
    expect(explorer.state.heading).toBeCloseTo(9)
    expect(explorer.state.pitch).toBeCloseTo(9)
    expect(directionOf(camera).x).toBeGreaterThan(0.1)
    pointer('pointermove', 'mouse', 1, 150, -2000)
    run(0.1)
    expect(explorer.state.pitch).toBeCloseTo(89.5)
    expect(explorer.state.heading).toBeCloseTo(9)
    pointer('pointerup', 'mouse', 1, 150, -2000)
    pointer('pointermove', 'mouse', 1, 500, 500)
    run(0.1)
    expect(explorer.state.heading).toBeCloseTo(9)
  })

  it('draws the picture along with one finger, and moves with two', () => {
    const { camera, explorer, pointer, run } = explore()
    pointer('pointerdown', 'touch', 1, 100, 100)
    pointer('pointermove', 'touch', 1, 150, 100)
    run(0.1)
    expect(explorer.state.heading).toBeCloseTo(351)
    expect(camera.position.z).toBe(0)
    pointer('pointerdown', 'touch', 2, 250, 100)
    pointer('pointermove', 'touch', 1, 150, 20)
    pointer('pointermove', 'touch', 2, 250, 20)
    run(1)
    expect(camera.position.z).toBeLessThan(-2)
    expect(explorer.state.heading).toBeCloseTo(351)
  })

  it('brings a tilted view level while one looks, without a jump', () => {
    const { camera, pointer, run } = explore()
    const tilt = (): number =>
      Math.asin(new Vector3(1, 0, 0).applyQuaternion(camera.quaternion).y) * (180 / Math.PI)
    camera.rotation.set(-0.5, 0, 1.2, 'YXZ')
    run(1)
    const before = tilt()
    expect(before).toBeGreaterThan(50)
    pointer('pointerdown', 'mouse', 1, 100, 100)
    const view = new Quaternion()
    for (let i = 1; i <= 180; i++) {
      view.copy(camera.quaternion)
      pointer('pointermove', 'mouse', 1, 100 + i, 100)
      run(1 / 60)
      expect(view.angleTo(camera.quaternion)).toBeLessThan(0.06)
    }
    expect(Math.abs(tilt())).toBeLessThan(0.1)
  })

  it('leaves other buttons, and button and wheel with Ctrl, to other controls', () => {
    const { explorer, drag, roll, run } = explore()
    const heading = (options: object): number => {
      drag(50, options)
      run(0.1)
      return explorer.state.heading
    }
    expect(heading({ button: 2 })).toBe(0)
    expect(heading({ ctrlKey: true })).toBe(0)
    expect(heading({})).toBeCloseTo(9)
    expect(roll({ ctrlKey: true }).defaultPrevented).toBe(false)
    expect(roll({}).defaultPrevented).toBe(true)
  })
})

describe('walking', () => {
  const hill = ({ x }: Vector3): number => 3 * Math.sin(x / 10)

  it('falls to the ground, and stays on it up and down hill', () => {
    const { camera, explorer, press, run } = explore({ groundAt: hill }, 40)
    press('KeyF')
    run(6)
    expect(explorer.isWalking).toBe(true)
    expect(camera.position.y).toBeCloseTo(1.7)
    press('KeyD')
    for (let i = 0; i < 100; i++) {
      run(0.2)
      expect(camera.position.y).toBeCloseTo(1.7 + hill(camera.position))
    }
    expect(camera.position.x).toBeGreaterThan(50)
    press('KeyF')
    run(0.1)
    expect(explorer.isWalking).toBe(false)
  })

  it('jumps by v²/2g, and lands', () => {
    const { camera, explorer, press, release, run } = explore()
    explorer.isWalking = true
    run(2)
    expect(camera.position.y).toBeCloseTo(1.7)
    press('Space')
    let highest = 0
    for (let i = 0; i < 60; i++) {
      run(1 / 60)
      if (i === 2) release('Space')
      highest = Math.max(highest, camera.position.y)
    }
    expect(highest - 1.7).toBeCloseTo(4.2 ** 2 / (2 * 9.81), 2)
    expect(camera.position.y).toBeCloseTo(1.7)
  })

  it('goes level while it looks up, and stops at walls', () => {
    const { camera, explorer, press, run } = explore({ groundAt: ({ z }) => (z < -5 ? 20 : 0) })
    explorer.state = { x: 0, y: 1.7, z: 0, heading: 0, pitch: 60, walking: 1 }
    press('KeyW')
    run(10)
    expect(camera.position.z).toBeLessThan(-4.8)
    expect(camera.position.z).toBeGreaterThanOrEqual(-5)
    expect(camera.position.y).toBeCloseTo(1.7)
  })

  it('comes down from any height in seconds, and waits for ground that is not loaded', () => {
    let ground = NaN
    const { camera, explorer, run } = explore({ groundAt: () => ground }, 2e7)
    explorer.isWalking = true
    run(1)
    expect(camera.position.y).toBe(2e7)
    ground = 100
    run(15)
    expect(camera.position.y).toBeCloseTo(101.7)
  })
})

describe('on foot', () => {
  it('falls to a terrain, jumps, and climbs no cliff', () => {
    const radius = 6.4e6
    const worldToECEF = new Matrix4().makeTranslation(0, radius, 0)
    const cliff = ({ x }: Vector3): number => Math.min(Math.max(5 * (x - 4), 0), 100)
    const ground: Ground = {
      atmosphere: { ellipsoid: new Ellipsoid(radius), worldToECEF },
      seaLevel: -Infinity,
      source: {
        lowest: 0,
        highest: 100,
        variation: distance => 5 * distance,
        sampleAt(position, target) {
          target.height = cliff(position)
          return target
        }
      }
    }
    const walker = new Walker(ground)
    const { camera, press, release, run } = explore({ groundAt: cliff, walker }, 40)
    press('KeyF')
    run(6)
    expect(walker.state).toBe('standing')
    expect(camera.position.y).toBeCloseTo(1.7, 3)
    press('Space')
    run(0.2)
    release('Space')
    expect(camera.position.y).toBeGreaterThan(2.2)
    run(2)
    press('KeyD')
    run(4)
    expect(camera.position.x).toBeGreaterThan(3)
    expect(camera.position.x).toBeLessThan(4.5)
    expect(camera.position.y).toBeLessThan(2.5)
  })

  it('stops at walls that the terrain does not know, and gets out of them', () => {
    const radius = 6.4e6
    const worldToECEF = new Matrix4().makeTranslation(0, radius, 0)
    const ground: Ground = {
      atmosphere: { ellipsoid: new Ellipsoid(radius), worldToECEF },
      seaLevel: -Infinity,
      source: {
        lowest: 0,
        highest: 1,
        variation: () => 0,
        sampleAt(_, target) {
          target.height = 0
          return target
        }
      }
    }
    const footingAt = ({ x }: Vector3): number => (Math.abs(x - 6) < 2 ? 5 : 0)
    const walker = new Walker(ground)
    const { camera, explorer, press, run } = explore({ footingAt, walker }, 1.7)
    press('KeyF')
    run(1)
    press('KeyD')
    run(4)
    expect(camera.position.x).toBeGreaterThan(3.8)
    expect(camera.position.x).toBeLessThanOrEqual(4)
    expect(camera.position.y).toBeCloseTo(1.7, 2)
    explorer.state = { x: 6, y: 1.7, z: 0, heading: 0, pitch: 0, walking: 1 }
    run(2)
    expect(camera.position.x).toBeGreaterThan(8)
  })
})

describe('flyTo', () => {
  const position = new Vector3(200, 30, -100)
  const direction = new Vector3(1, -1, 1).normalize()

  it('arrives, above the hills between', async () => {
    const groundAt = ({ x }: Vector3): number => (Math.abs(x - 100) < 20 ? 500 : 0)
    const { camera, explorer, run } = explore({ groundAt })
    const arrival = explorer.flyTo({ position, direction }, 2)
    run(1)
    expect(camera.position.x).toBeCloseTo(100, -1)
    expect(camera.position.y).toBeCloseTo(500.5)
    run(1.1)
    await arrival
    expect(camera.position.distanceTo(position)).toBeLessThan(1e-9)
    expect(directionOf(camera).distanceTo(direction)).toBeLessThan(1e-6)
  })

  it('is broken off by whoever moves, and by another flight', async () => {
    const { camera, explorer, press, run } = explore()
    const first = explorer.flyTo({ position, direction }, 2)
    const second = explorer.flyTo({ position, direction }, 2)
    await first
    run(0.5)
    press('KeyS')
    run(0.1)
    await second
    run(3)
    expect(camera.position.distanceTo(position)).toBeGreaterThan(50)
  })
})

describe('on a globe', () => {
  const radius = 1000
  const globe: ExplorerOptions = {
    upAt: (position, target) => target.copy(position).normalize(),
    heightAt: position => position.length() - radius,
    pole: new Vector3(0, 0, 1)
  }

  it('walks around it and over its poles, level all the way', () => {
    const { camera, explorer, press, run } = explore(globe)
    explorer.state = { x: 1001.7, y: 0, z: 0, heading: 0, pitch: 0, walking: 1 }
    press('KeyW')
    press('ShiftLeft')
    let highest = 0
    for (let i = 0; i < 300; i++) {
      run(0.5)
      expect(camera.position.length()).toBeCloseTo(radius + 1.7)
      expect(Math.abs(explorer.state.pitch)).toBeLessThan(1e-3)
      expect(Math.abs(camera.position.y)).toBeLessThan(1e-3)
      highest = Math.max(highest, camera.position.z)
    }
    expect(highest).toBeGreaterThan(radius)
    expect(camera.position.x).toBeLessThan(0)
  })

  it('flies around it, not through it', () => {
    const { camera, explorer, run } = explore(globe)
    explorer.state = { x: 1010, y: 0, z: 0, heading: 0, pitch: -10, walking: 0 }
    const position = new Vector3(-300, 0, 970)
    void explorer.flyTo({ position, direction: new Vector3(0, 1, 0) }, 4)
    for (let i = 0; i < 40; i++) {
      run(0.1)
      expect(camera.position.length()).toBeGreaterThan(radius + 9)
    }
    run(0.1)
    expect(camera.position.distanceTo(position)).toBeLessThan(1e-6)
  })

  it.each([
    ['the antipodes', new Vector3(-1010, 0, 0), new Vector3(0, 0, -1)],
    ['near them', new Vector3(-1005, 60, 40), new Vector3(0, 0.1, -1).normalize()]
  ])(
    'flies around it to %s without a jump, and looks ahead all the way',
    (_, position, direction) => {
      const { camera, explorer, run } = explore(globe)
      explorer.state = { x: 1010, y: 0, z: 0, heading: 0, pitch: 0, walking: 0 }
      void explorer.flyTo({ position, direction }, 4)
      const before = { position: camera.position.clone(), direction: directionOf(camera) }
      for (let i = 0; i < 241; i++) {
        run(1 / 60)
        // 1.875 times the mean speed at most.
        expect(camera.position.angleTo(before.position)).toBeLessThan(0.025)
        expect(directionOf(camera).angleTo(before.direction)).toBeLessThan(0.03)
        expect(Math.abs(explorer.state.pitch)).toBeLessThan(8)
        before.position.copy(camera.position)
        before.direction.copy(directionOf(camera))
      }
      expect(camera.position.distanceTo(position)).toBeLessThan(1e-6)
      expect(directionOf(camera).distanceTo(direction)).toBeLessThan(1e-6)
    }
  )

  it('measures heading from its pole', () => {
    const { camera, explorer } = explore(globe)
    explorer.state = { x: 1010, y: 0, z: 0, heading: 90, pitch: 0, walking: 0 }
    expect(directionOf(camera).distanceTo(new Vector3(0, 1, 0))).toBeLessThan(1e-9)
    camera.lookAt(0, 0, 0)
    expect(explorer.state.pitch).toBeCloseTo(-90)
  })
})

describe('state', () => {
  it('brings a view back, by itself and as text', () => {
    const { explorer } = explore()
    const state = { x: 1, y: 20, z: -3.25, heading: 200, pitch: -30, walking: 0 }
    explorer.state = state
    for (const [name, value] of Object.entries(explorer.state)) {
      expect(value).toBeCloseTo(state[name as keyof typeof state])
    }
    expect(formatState(explorer.state)).toBe('1,20,-3.25,200,-30,0')
    expect(parseState(formatState(explorer.state))).toEqual(state)
  })

  it.each(['', '1,2,3', '1,2,3,4,5,x', '1,2,3,4,,6', '1,2,3,4,5,6,7'])('%j is none', text => {
    expect(parseState(text)).toBeUndefined()
  })
})

import { Vector3 } from 'three'
import { describe, expect, it } from 'vitest'
import { Descent } from '../src/shell/Descent'
import { DESCENT_SECONDS } from '../src/shell/descentPath'
import { explore } from './explore'

const radius = 6378.137
const center = new Vector3(0, -radius, 0)

/** A descent of an explorer's camera, drawn as the story does. */
function descent() {
  const explored = explore({
    metersPerUnit: 1000,
    upAt: (place, target) => target.copy(place).sub(center).normalize(),
    heightAt: place => (place.distanceTo(center) - radius) * 1000
  })
  const { camera, explorer } = explored
  const way = new Descent(center, radius, explorer)
  const run = (seconds: number, step = 0.05): void => {
    for (let t = step / 2; t < seconds; t += step) {
      way.update(camera, step)
      explorer.update(step)
    }
  }
  const height = (): number => (camera.position.distanceTo(center) - radius) * 1000
  return { ...explored, way, run, height }
}

type Watched = ReturnType<typeof descent>

const acts: Record<string, (watched: Watched) => void> = {
  'a key that moves': ({ press }) => press('KeyW'),
  'any other key': ({ press }) => press('Escape'),
  F: ({ press }) => press('KeyF'),
  'a press of the mouse': ({ pointer }) => pointer('pointerdown', 'mouse', 1, 100, 100),
  'a finger': ({ pointer }) => pointer('pointerdown', 'touch', 1, 100, 100),
  'the wheel': ({ wheel }) => wheel(100),
  'a link': ({ explorer }) => {
    explorer.state = { x: 0, y: 500, z: 0, heading: 0, pitch: 0, walking: 0 }
  }
}

describe('the descent', () => {
  it('leads from the map to the ground, and ends there', () => {
    const { way, run, height, press, camera } = descent()
    run(0.05)
    expect(height()).toBeGreaterThan(2e7)
    run(DESCENT_SECONDS)
    expect(way.runs).toBe(false)
    expect(way.part).toBe(1)
    expect(height()).toBeCloseTo(2, 3)
    const { x, z } = camera.position
    press('KeyW')
    run(2)
    expect(Math.hypot(camera.position.x - x, camera.position.z - z)).toBeGreaterThan(0.003)
  })

  it.each(Object.keys(acts))('is ended by %s, where the explorer goes on', name => {
    const watched = descent()
    const { way, run, camera } = watched
    run(20)
    expect(way.runs).toBe(true)
    const { part } = way
    const place = camera.position.clone()
    acts[name](watched)
    if (name === 'a link') place.copy(camera.position)
    run(0.05)
    expect(way.runs).toBe(false)
    // A frame's way at most.
    expect(camera.position.distanceTo(place)).toBeLessThan(0.1 * place.distanceTo(center))
    run(DESCENT_SECONDS)
    expect(way.part).toBe(part)
    expect(way.runs).toBe(false)
  })

  it('stays where it was ended, and goes on when it is started again', () => {
    const { way, run, camera, wheel, pointer, explorer, press } = descent()
    run(20)
    wheel(100)
    const { x, y, z } = camera.position
    run(5)
    expect(camera.position.toArray()).toEqual([x, y, z])
    const { heading } = explorer.state
    pointer('pointerdown', 'mouse', 1, 100, 100)
    pointer('pointermove', 'mouse', 1, 150, 100)
    run(0.05)
    expect(explorer.state.heading).not.toBeCloseTo(heading, 0)
    press('KeyW')
    way.start(0.9)
    run(0.05)
    expect(way.runs).toBe(true)
    expect(way.part).toBeCloseTo(0.9 + 0.05 / DESCENT_SECONDS, 9)
  })

  it('goes on through moves of the mouse, typing and keys of the browser', () => {
    const { way, run, pointer, press, page } = descent()
    run(1)
    pointer('pointermove', 'mouse', 1, 150, 100)
    press('KeyW', { closest: (selector: string) => selector.includes('textarea') })
    page('keydown', { code: 'KeyR', ctrlKey: true })
    run(1)
    expect(way.runs).toBe(true)
  })

  it('puts the camera at its part alone in a still', () => {
    const { camera, height } = descent()
    const still = new Descent(center, radius)
    for (const part of [0.5, 1]) {
      still.start(part)
      still.update(camera, 0)
      still.update(camera, 0)
      expect(still.part).toBe(part)
      expect(still.runs).toBe(true)
    }
    expect(height()).toBeCloseTo(2, 3)
  })
})

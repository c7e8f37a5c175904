import { expect, it } from 'vitest'
import { VIEWS } from '../src/terrain.scene'
import { viewAlong } from '../src/terrain/viewAlong'

const views = [VIEWS.shore, VIEWS.summit, VIEWS.orbit]
const KEYS = ['longitude', 'latitude', 'height', 'heading', 'pitch'] as const

it('comes by every view', () => {
  for (const [i, view] of views.entries()) {
    const found = viewAlong(views, i / 2)
    for (const key of KEYS) {
      const turns = key === 'heading' ? Math.round((found[key] - view[key]) / 360) : 0
      expect(found[key] - 360 * turns).toBeCloseTo(view[key], 6)
    }
  }
})

it('has no cut: no step is long beside the height, and the camera stays above the ground', () => {
  const steps = 60 * 60
  let last = viewAlong(views, 0)
  for (let i = 1; i <= steps; i++) {
    const next = viewAlong(views, i / steps)
    const way = 111_000 * Math.hypot(next.longitude - last.longitude, next.latitude - last.latitude)
    expect(way).toBeLessThan(0.15 * next.height + 2)
    expect(Math.abs(Math.log(next.height / last.height))).toBeLessThan(0.1)
    expect(next.height).toBeGreaterThan(1.9)
    last = next
  }
})

import { Atmosphere } from '@welkin/atmosphere'
import { Vector3 } from 'three'
import { expect, it } from 'vitest'
import { ImageTiles } from '../src/data/ImageTiles'
import type { HeightSource } from '../src/heights/HeightSource'
import { groundSharesAt } from '../src/surface/groundSharesAt'
import { Terrain } from '../src/Terrain'
import { Walker } from '../src/walk/Walker'

/** Ground at 40 m that its source knows west of x = 5 alone. */
const known: HeightSource = {
  lowest: 20,
  highest: 60,
  variation: distance => Math.min(distance, 40),
  sampleAt({ x }, target) {
    target.height = x < 5 ? 40 : NaN
    target.gradient.setScalar(x < 5 ? 0 : NaN)
    return target
  },
  sample: () => {
    throw new Error('not drawn here')
  }
}
const terrain = new Terrain(new Atmosphere({ flat: true }), known, {
  resolution: 4,
  seaLevel: -Infinity
})

it('has level ground as near to 0 m as there is any where its source has no number', () => {
  const there = new Vector3(8, 100, 0)
  expect(terrain.heightBelow(new Vector3())).toBe(40)
  expect(terrain.heightBelow(there)).toBe(20)
  expect(terrain.normalBelow(there).toArray()).toEqual([0, 1, 0])
  const hit = terrain.intersectRay(there, new Vector3(0, -1, 0))
  expect(hit?.y).toBeCloseTo(20, 3)
  const { grass, rock, snow } = groundSharesAt(terrain, there)
  expect(Number.isFinite(grass + rock + snow)).toBe(true)
})

it('lets a walker go on where its source has no number', () => {
  const walker = new Walker(terrain).moveTo(new Vector3(0, 41.7, 0))
  const eye = new Vector3()
  for (let i = 0; i < 240; i++) walker.update(new Vector3(1, 0, 0), false, 1 / 60)
  walker.eyePosition(eye)
  expect(eye.x).toBeGreaterThan(8)
  expect(eye.y).toBeGreaterThan(21)
  expect(eye.y).toBeLessThan(42)
  for (let i = 0; i < 480; i++) walker.update(new Vector3(-1, 0, 0), true, 1 / 60)
  expect(walker.eyePosition(eye).toArray().every(Number.isFinite)).toBe(true)
})

it('names the sources of its heights and imagery', () => {
  const imagery = new ImageTiles('memory:{z}/{x}/{y}', { attribution: 'Pictures by B' })
  const heights = { ...known, attribution: 'Heights by A' }
  const linesOf = (source: HeightSource, options = {}): string[] => {
    const made = new Terrain(new Atmosphere({ flat: true }), source, { resolution: 4, ...options })
    made.dispose()
    return made.attributions
  }
  expect(linesOf(known)).toEqual([])
  expect(linesOf(heights, { imagery })).toEqual(['Heights by A', 'Pictures by B'])
  expect(linesOf({ ...known, attribution: 'Pictures by B' }, { imagery })).toEqual([
    'Pictures by B'
  ])
})

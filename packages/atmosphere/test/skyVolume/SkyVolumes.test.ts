import type { Renderer } from 'three/webgpu'
import { expect, it } from 'vitest'
import { AtmosphereParameters } from '@welkin/atmosphere'
import { AtmosphereTables } from '../../src/tables/AtmosphereTables'
import { viewpointScalars } from '../../src/view/cpu/viewpoint'

const earth = new AtmosphereParameters()
const PASSES = 3

/** Volumes of a renderer that draws nothing, and the number of volumes that it was asked to compute since. */
function volumes() {
  let draws = 0
  const parts: Record<string, unknown> = { render: () => draws++ }
  const renderer = new Proxy(parts, {
    get: (target, name) => target[name as string] ?? (() => undefined)
  }) as unknown as Renderer
  const { volumes: made } = new AtmosphereTables(earth)
  const at = (altitude: number, version = 1, cosLight = 0.5) =>
    made.volumeFor(renderer, viewpointScalars(earth, altitude, cosLight), version)
  const computed = (): number => {
    const count = draws / PASSES
    draws = 0
    return count
  }
  return { made, at, computed }
}

it('serves every camera of a place from one volume, until the light or the tables change', () => {
  const { at, computed } = volumes()
  const first = at(2)
  expect(computed()).toBe(1)
  expect(at(2)).toBe(first)
  expect(at(2.0005)).toBe(first)
  expect(computed()).toBe(0)
  at(2, 1, 0.501)
  expect(computed()).toBe(1)
  at(2, 2)
  expect(computed()).toBe(1)
})

it('keeps two places, and computes the one anew that was not asked for the longest', () => {
  const { at, computed } = volumes()
  const [ground, plane] = [at(2), at(10_000)]
  expect(plane).not.toBe(ground)
  for (let i = 0; i < 5; i++) for (const altitude of [2, 10_000]) at(altitude)
  expect(computed()).toBe(2)
  expect(at(1e6)).toBe(ground)
  expect(at(10_000)).toBe(plane)
  expect(computed()).toBe(1)
})

it('lays volumes out side by side, none over another, and grows for more', () => {
  const { made, at, computed } = volumes()
  expect(made.reserve(2)).toBe(false)
  at(2)
  expect(made.reserve(6)).toBe(true)
  computed()
  const kept = [2, 20, 200, 2000, 20_000, 200_000].map(altitude => at(altitude))
  expect(computed()).toBe(6)
  const { width, height } = made.atlas.target
  const boxes = kept.flatMap(({ light, depth }) => [
    { x: light.x, y: light.y, width: 2 * 6 * 32, height: 4 * 96 },
    { x: depth.x, y: depth.y, width: 192, height: 33 }
  ])
  boxes.forEach((a, i) => {
    expect(a.x + a.width <= width && a.y + a.height <= height).toBe(true)
    for (const b of boxes.slice(i + 1)) {
      const apart =
        a.x + a.width <= b.x ||
        b.x + b.width <= a.x ||
        a.y + a.height <= b.y ||
        b.y + b.height <= a.y
      expect(apart, `${JSON.stringify(a)} over ${JSON.stringify(b)}`).toBe(true)
    }
  })
})

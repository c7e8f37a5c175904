import { PNG } from 'pngjs'
import { expect, it } from 'vitest'
import { degreesOf, RINGS, type RingView } from '../visual/rings'

const view: RingView = { fieldOfView: 62, pitch: 10, sun: 25, aside: 180 }

/** A grey picture over a dark ground, with a red and a blue ring about the point opposite the sun. */
function picture(red: number, blue: number, hasGround = true): PNG {
  const png = new PNG({ width: 320, height: 180 })
  const focal = 90 / Math.tan((31 * Math.PI) / 180)
  for (let y = 0; y < 180; y++)
    for (let x = 0; x < 320; x++) {
      // The view ahead turned down by pitch and sun, so that the point opposite the sun is straight ahead.
      const [right, up] = [(x + 0.5 - 160) / focal, (90 - y - 0.5) / focal]
      const turn = (35 * Math.PI) / 180
      const ahead = Math.cos(turn) - up * Math.sin(turn)
      const away =
        (Math.atan2(Math.hypot(right, up * Math.cos(turn) + Math.sin(turn)), ahead) * 180) / Math.PI
      const isGround = hasGround && up * Math.cos(radians(10)) + Math.sin(radians(10)) < 0
      const of = (middle: number): number =>
        isGround ? 0 : 20 * Math.exp(-(((away - middle) / 0.6) ** 2))
      png.data.set([120 + of(red), 120, 120 + of(blue), 255], 4 * (y * 320 + x))
    }
  return png
}

const radians = (degrees: number): number => (degrees * Math.PI) / 180

const degrees = (ring: keyof typeof RINGS, drawn: PNG, seenFrom = view): number =>
  degreesOf(RINGS[ring], drawn, seenFrom)

it('finds a bow by its angle and the order of its colours, on the arc above the ground', () => {
  // The ground cuts it at ±56° from its top.
  const bow = picture(42.4, 40.6)
  expect(degrees('primary', bow)).toBeGreaterThan(90)
  expect(degrees('primary', bow)).toBeLessThan(125)
  expect(degrees('secondary', bow)).toBe(0)
  expect(degrees('secondary', picture(50.6, 53))).toBeGreaterThan(80)
})

it('finds none in a grey picture, with the colours the other way round, or at another angle', () => {
  for (const [red, blue] of [
    [0, 0],
    [40.6, 42.4],
    [46, 44.5]
  ])
    for (const ring of ['primary', 'secondary'] as const)
      expect(degrees(ring, picture(red, blue))).toBe(0)
  const turned = { ...view, sun: 35 }
  expect(degrees('primary', picture(42.4, 40.6), turned)).toBeLessThan(40)
})

it('finds a halo about the sun, and white bows by their light', () => {
  // The sun where the point opposite it was.
  const before = { ...view, sun: -25, aside: 0 }
  expect(degrees('halo', picture(22, 22.8, false), before)).toBeGreaterThan(150)
  expect(degrees('halo', picture(22, 22.8, false))).toBe(0)
  expect(degrees('fogbow', picture(38, 38))).toBeGreaterThan(60)
  expect(degrees('fogbow', picture(34, 42))).toBe(0)
})

import { PNG } from 'pngjs'
import { expect, it } from 'vitest'
import { bowsIn, type BowView } from '../visual/bow'

const view: BowView = { fieldOfView: 62, pitch: 10, sun: 25, aside: 180 }

/** A grey picture over a dark ground, with a red and a blue ring about the point opposite the sun. */
function picture(red: number, blue: number): PNG {
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
      const isGround = up * Math.cos(radians(10)) + Math.sin(radians(10)) < 0
      const of = (middle: number): number =>
        isGround ? 0 : 20 * Math.exp(-(((away - middle) / 0.6) ** 2))
      png.data.set([120 + of(red), 120, 120 + of(blue), 255], 4 * (y * 320 + x))
    }
  return png
}

const radians = (degrees: number): number => (degrees * Math.PI) / 180

it('finds a bow by its angle and the order of its colours, on the arc above the ground', () => {
  const { primary, secondary } = bowsIn(picture(42.4, 40.6), view)
  // The ground cuts it at ±56° from its top.
  expect(primary).toBeGreaterThan(90)
  expect(primary).toBeLessThan(125)
  expect(secondary).toBe(0)
  expect(bowsIn(picture(50.6, 53), view).secondary).toBeGreaterThan(80)
})

it('finds none in a grey picture, with the colours the other way round, or at another angle', () => {
  for (const [red, blue] of [
    [0, 0],
    [40.6, 42.4],
    [46, 44.5]
  ])
    expect(bowsIn(picture(red, blue), view)).toEqual({ primary: 0, secondary: 0 })
  const turned = { ...view, sun: 35 }
  expect(bowsIn(picture(42.4, 40.6), turned).primary).toBeLessThan(40)
})

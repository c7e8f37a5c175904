import { PNG } from 'pngjs'
import { describe, expect, it } from 'vitest'
import { compare, isBlank } from '../visual/compare'

const width = 64
const height = 36

function picture(color: (x: number, y: number) => [number, number, number]): PNG {
  const png = new PNG({ width, height })
  for (let y = 0; y < height; y++) {
    for (let x = 0; x < width; x++) {
      png.data.set([...color(x, y), 255], 4 * (y * width + x))
    }
  }
  return png
}

const gradient = (offset: number, edge: number): PNG =>
  picture((x, y) => (x < edge ? [0, 0, 0] : [2 * x + offset, 3 * y + offset, 60 + offset]))

describe('compare', () => {
  const expected = gradient(0, 20)

  it('takes a picture for itself', () => {
    expect(compare(expected, expected)).toMatchObject({ same: true, isNearLimit: false })
  })

  it('lets an edge move by a pixel', () => {
    expect(compare(gradient(0, 21), expected).same).toBe(true)
  })

  it('sees a shape that moved by three pixels', () => {
    expect(compare(gradient(0, 23), expected).same).toBe(false)
  })

  it('sees an exposure that is off by 2 %', () => {
    expect(compare(gradient(5, 20), expected).same).toBe(false)
  })

  it('knows when a picture passes but barely', () => {
    const fewOff = picture((x, y) =>
      y === 18 && x > 40 && x % 6 === 0 ? [255, 0, 255] : [2 * x, 3 * y, 60]
    )
    const plain = picture((x, y) => [2 * x, 3 * y, 60])
    expect(compare(fewOff, plain)).toMatchObject({ same: true, isNearLimit: true })
  })

  it('sees another size', () => {
    const other = new PNG({ width, height: height + 1 })
    expect(compare(other, expected)).toMatchObject({
      same: false,
      detail: '64×37 instead of 64×36'
    })
  })
})

describe('isBlank', () => {
  it('is true of one flat colour only', () => {
    expect(isBlank(picture(() => [10, 20, 30]))).toBe(true)
    expect(isBlank(picture((x, y) => (x === 63 && y === 35 ? [1, 0, 0] : [0, 0, 0])))).toBe(false)
  })
})

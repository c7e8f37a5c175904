import type { CloudPresetName } from '@welkin/clouds'
import fc from 'fast-check'
import { describe, expect, it } from 'vitest'
import { formFigures, type FormFigures } from '../validate/form/figures'
import { blurMask, squaredDistances } from '../validate/form/filters'
import { boundaryFaces, labelPieces, type Mask } from '../validate/form/grid'
import { perimeterDimension, piecesOf } from '../validate/form/pieces'
import { formResult, WINDOWS } from '../validate/form/result'
import { logSlope, sizeSlope, spectrumSlope } from '../validate/form/slopes'

/** A mask of the cells for which a test holds. */
function maskOf(
  size: [number, number, number],
  test: (x: number, y: number, z: number) => boolean
): Mask {
  const [nx, ny, nz] = size
  const cells = Uint8Array.from({ length: nx * ny * nz }, (_, i) =>
    Number(test(i % nx, Math.floor(i / nx) % ny, Math.floor(i / (nx * ny))))
  )
  return { size, cells }
}

const small = fc
  .tuple(
    fc.integer({ min: 1, max: 6 }),
    fc.integer({ min: 1, max: 6 }),
    fc.integer({ min: 1, max: 5 })
  )
  .chain(size =>
    fc
      .array(fc.boolean(), {
        minLength: size[0] * size[1] * size[2],
        maxLength: size[0] * size[1] * size[2]
      })
      .map((cells): Mask => ({ size, cells: Uint8Array.from(cells, Number) }))
  )

describe('pieces', () => {
  it('belong together if and only if a path of faces joins their cells', () => {
    fc.assert(
      fc.property(small, mask => {
        const { labels, count } = labelPieces(mask)
        const [nx, ny, nz] = mask.size
        const filled = new Int32Array(labels.length)
        let found = 0
        const fill = (x: number, y: number, z: number): void => {
          if (x < 0 || y < 0 || z < 0 || x >= nx || y >= ny || z >= nz) return
          const i = x + nx * (y + ny * z)
          if (mask.cells[i] === 0 || filled[i] > 0) return
          filled[i] = found
          for (const d of [-1, 1]) {
            fill(x + d, y, z)
            fill(x, y + d, z)
            fill(x, y, z + d)
          }
        }
        mask.cells.forEach((cell, i) => {
          if (cell === 0 || filled[i] > 0) return
          found++
          fill(i % nx, Math.floor(i / nx) % ny, Math.floor(i / (nx * ny)))
        })
        expect(count).toBe(found)
        const pairs = new Map<number, number>()
        filled.forEach((label, i) => {
          if (!pairs.has(label)) pairs.set(label, labels[i])
          expect(labels[i]).toBe(pairs.get(label))
        })
      })
    )
  })

  it('have their volume, extents and lowest level', () => {
    const mask = maskOf([9, 8, 7], (x, y, z) => x > 1 && x < 5 && y === 3 && z > 2 && z < 5)
    expect(piecesOf(mask)).toEqual([{ volume: 6, extents: [3, 1, 2], lowest: 3 }])
  })

  it('of smooth outline have dimension 1, of a plane-filling one more', () => {
    const discs = Array.from({ length: 12 }, (_, i) => {
      const radius = 6 + 4 * i
      return maskOf([120, 120, 1], (x, y) => Math.hypot(x - 60, y - 60) < radius)
    })
    expect(perimeterDimension(discs)).toBeCloseTo(1, 1)
    const combs = Array.from({ length: 12 }, (_, i) => {
      const size = 20 + 6 * i
      return maskOf([120, 120, 1], (x, y) => {
        const inside = x >= 5 && y >= 5 && x < 5 + size && y < 5 + size
        return inside && (y === 5 || x % 2 === 1)
      })
    })
    expect(perimeterDimension(combs)).toBeGreaterThan(1.7)
  })
})

describe('filters', () => {
  it('find the distance to the nearest cell outside', () => {
    fc.assert(
      fc.property(small, mask => {
        const [nx, ny] = mask.size
        const place = (i: number): number[] => [
          i % nx,
          Math.floor(i / nx) % ny,
          Math.floor(i / (nx * ny))
        ]
        const outside = [...mask.cells.keys()].filter(i => mask.cells[i] === 0)
        squaredDistances(mask).forEach((square, i) => {
          const expected = outside.map(o =>
            place(o).reduce((sum, at, axis) => sum + (at - place(i)[axis]) ** 2, 0)
          )
          expect(square).toBe(Math.min(Infinity, ...expected))
        })
      })
    )
  })

  it('keep a half space, and rub out what is finer than the blur', () => {
    const half = maskOf([24, 10, 10], x => x < 12)
    expect(blurMask(half, 2)).toEqual(half)
    const crumb = maskOf([20, 20, 20], (x, y, z) => x === 10 && y === 10 && z === 10)
    expect(boundaryFaces(crumb)).toBe(6)
    expect(boundaryFaces(blurMask(crumb, 1))).toBe(0)
  })
})

describe('slopes', () => {
  it('are exponents of power laws', () => {
    const x = [1, 2, 5, 20]
    expect(
      logSlope(
        x,
        x.map(v => 3 * v ** -1.7)
      )
    ).toBeCloseTo(-1.7, 12)
    // Quantiles of a number density ∝ width^−1.8 from 1 to 30.
    const widths = Array.from({ length: 4000 }, (_, i) => {
      const share = (i + 0.5) / 4000
      return (1 - share * (1 - 30 ** -0.8)) ** (-1 / 0.8)
    })
    expect(sizeSlope(widths)).toBeCloseTo(-1.8, 1)
  })

  it('find that of a picture made of waves', () => {
    // Waves evenly spread over wavenumber k, of amplitude 1/k: power per wavenumber ∝ k^−2.
    const size = 96
    const waves = Array.from({ length: 900 }, (_, i) => {
      const [k, angle] = [2 + 40 * ((i * 0.618034) % 1), 2 * Math.PI * ((i * 0.754878) % 1)]
      return { k, phase: i * i * 1.7, x: Math.cos(angle), y: Math.sin(angle) }
    })
    const picture = Array.from({ length: size ** 2 }, (_, i) => {
      const [x, y] = [i % size, Math.floor(i / size)].map(at => (2 * Math.PI * at) / size)
      return waves.reduce(
        (sum, wave) => sum + Math.cos(wave.k * (x * wave.x + y * wave.y) + wave.phase) / wave.k,
        0
      )
    })
    const slope = spectrumSlope(picture, size, 1, size / 4, size / 32)
    expect(Math.abs(slope + 2)).toBeLessThan(0.2)
  })
})

it('figures of a field of upright boxes', () => {
  const [nx, ny, nz] = [60, 60, 20]
  const data = Float32Array.from({ length: nx * ny * nz }, (_, i) => {
    const [x, y, z] = [i % nx, Math.floor(i / nx) % ny, Math.floor(i / (nx * ny))]
    const inside = x % 30 >= 5 && x % 30 < 25 && y % 30 >= 5 && y % 30 < 25
    return inside && z >= 2 && z < 18 ? 0.01 * (z - 1) : 0
  })
  const figures = formFigures({ nx, ny, nz, dx: 20, dz: 20, z0: 0, data })
  expect(figures.cover).toBeCloseTo(1600 / 3600, 6)
  expect(figures.aspect).toBeCloseTo(16 / 20, 6)
  expect(figures.detached).toBe(0)
  expect(figures.midOverPeak).toBeCloseTo(1, 6)
  expect(figures.extinctionRise).toBeCloseTo((1 + 0.8 * 15) / (1 + 0.2 * 15), 5)
  expect(figures.piecesPerKm2).toBeCloseTo(4 / 1.44, 6)
  expect(() =>
    formFigures({ nx: 2, ny: 2, nz: 1, dx: 1, dz: 1, z0: 0, data: new Float32Array(4) })
  ).toThrow('no cloud')
})

describe('medians over windows', () => {
  const met: FormFigures = {
    cover: 0.2,
    horizontalDimension: 1.4,
    verticalDimension: 1.4,
    boundaryLeft: [0.6, 0.4, 0.2],
    peakHeight: 0.1,
    midOverPeak: 0.3,
    extinctionRise: 1.4,
    aspect: 0.8,
    sizeSlope: -1.7,
    detached: 0.05,
    piecesPerKm2: 4,
    spectrumSlope: -2,
    interior: [0.7, 0.8, 0.85, 0.85]
  }
  const windows = (count: number, changes: Partial<FormFigures> = {}): FormFigures[] =>
    Array.from({ length: count }, () => ({ ...met, ...changes }))
  const missed = (judged: FormFigures[], preset: CloudPresetName = 'fairWeather'): string[] =>
    formResult(preset, judged, [])
      .rows.filter(({ isMet }) => !isMet)
      .map(({ name }) => name)

  it('are of five, or there are none', () => {
    expect(missed(windows(WINDOWS))).toEqual([])
    expect(() => formResult('fairWeather', windows(WINDOWS - 1), [0.2, 0.5])).toThrow(
      '--form: only 4 of 5 windows of fairWeather have a cover from 0.1 to 0.35, of 0.20, 0.50: give --coverage'
    )
  })

  it('miss what is out of its limits, or not known in all of them', () => {
    const dim = windows(WINDOWS, { interior: [0.7, 0.8, 0.79, 0.85] })
    expect(missed(dim)).toEqual(['extinction 40–80 m inside'])
    const unknown = [...windows(WINDOWS - 1), { ...met, aspect: NaN }]
    expect(missed(unknown)).toEqual(['height over width'])
  })

  it('have limits for fair weather alone', () => {
    const tall = windows(WINDOWS, { aspect: 3 })
    expect(missed(tall)).toEqual(['height over width'])
    expect(missed(tall, 'cumulonimbus')).toEqual([])
  })
})

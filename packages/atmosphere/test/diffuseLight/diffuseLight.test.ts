import fc from 'fast-check'
import { describe, expect, it } from 'vitest'
import { AtmosphereParameters } from '@welkin/atmosphere'
import {
  diffuseColumn,
  diffuseColumnCosine,
  diffuseTexel
} from '../../src/diffuseLight/cpu/diffuseLight'
import { applyMoments } from '../../src/diffuseLight/cpu/moments'
import { skyIrradiance } from '../../src/diffuseLight/cpu/skyIrradiance'
import { DIFFUSE_SIZE, DIFFUSE_TILES, RADIANCE_SCALE } from '../../src/tables/tableSizes'
import { cosine, number, runs } from '../arbitraries'

const earth = new AtmosphereParameters()
const legendre = [() => 1, (x: number) => x, (x: number) => (3 * x * x - 1) / 2] as const

describe('sky irradiance', () => {
  it('under a uniform sky is π times its radiance', () => {
    const [columns, rows] = DIFFUSE_SIZE
    const radiance = 0.3
    const values = new Float32Array(4 * columns * rows * DIFFUSE_TILES)
    for (let tile = 0; tile < DIFFUSE_TILES; tile++) {
      const value = tile === 0 ? Math.sqrt(4 * Math.PI) : tile >= 6 ? Math.PI : 0
      for (let row = 0; row < rows; row++) {
        const [first, end] = [0, columns].map(column => 4 * diffuseTexel(tile, column, row))
        values.fill(value * radiance * RADIANCE_SCALE, first, end)
      }
    }
    const data = { values }
    fc.assert(
      fc.property(number(0, 60_000), cosine, cosine, cosine, (altitude, normal, sun, normalSun) => {
        for (const value of skyIrradiance(earth, data, altitude, normal, sun, normalSun)) {
          expect(value / (Math.PI * radiance)).toBeCloseTo(1, 5)
        }
      }),
      runs
    )
  })

  it('finds a column by its cosine', () => {
    for (let column = 0; column < DIFFUSE_SIZE[0]; column++) {
      const back = diffuseColumn(diffuseColumnCosine(column)) * (DIFFUSE_SIZE[0] - 1)
      expect(back).toBeCloseTo(column, 9)
    }
  })
})

describe('moments', () => {
  it('of light from the sun alone give Legendre polynomials of the angle to it', () => {
    fc.assert(
      fc.property(
        number(-0.999, 0.999),
        cosine,
        number(0, Math.PI),
        number(-2, 2),
        number(-2, 2),
        (cosLight, cosView, azimuth, a1, a2) => {
          const sinLight = Math.sqrt(1 - cosLight ** 2)
          const nu = cosView * cosLight + Math.sqrt(1 - cosView ** 2) * sinLight * Math.cos(azimuth)
          const [y0, y1] = [Math.sqrt(1 / (4 * Math.PI)), Math.sqrt(3 / (4 * Math.PI))]
          const y2 = Math.sqrt(5 / (16 * Math.PI))
          const moments = [
            y0,
            y1 * cosLight,
            y1,
            y2 * (3 * cosLight ** 2 - 1),
            y2 * Math.sqrt(12) * cosLight,
            y2 * Math.sqrt(3)
          ]
          const expected = [1, a1, a2].reduce(
            (sum, a, l) => sum + ((a * (2 * l + 1)) / (4 * Math.PI)) * legendre[l](nu),
            0
          )
          const actual = applyMoments(moments, [1, a1, a2], cosView, cosLight, nu)
          expect(Math.abs(actual - expected)).toBeLessThan(1e-9)
        }
      ),
      runs
    )
  })

  it('stay finite with the sun in the zenith', () => {
    expect(applyMoments([1, 1, 1, 1, 1, 1], [1, 1, 1], 0.5, 1, 0.5)).toBeGreaterThan(0)
  })
})

import { Ellipsoid } from '@welkin/geo'
import { Matrix4, Vector3 } from 'three'
import { expect, it } from 'vitest'
import { MountainHeights } from '../src/heights/MountainHeights'
import { groundShares } from '../src/surface/cpu/groundRules'
import { groundSharesAt } from '../src/surface/groundSharesAt'
import type { Terrain } from '../src/Terrain'

const place = {
  height: 800,
  overSea: 800,
  patch: 0,
  climate: 0,
  sinLatitude: Math.sin(0.8),
  sinNormal: Math.sin(0.8),
  cosSlope: 1
}

it('has woods in wet country and grass in dry, rock on cliffs, snow on summits, sand at the shore', () => {
  const most = (change: Partial<typeof place>): string => {
    const shares = groundShares({ ...place, ...change })
    return Object.entries(shares).reduce((a, b) => (b[1] > a[1] ? b : a))[0]
  }
  expect(most({ climate: -0.3 })).toBe('forest')
  expect(most({ climate: 0.2 })).toBe('grass')
  expect(most({ climate: 1 })).toBe('desert')
  expect(most({ cosSlope: 0.7, sinNormal: Math.sin(0.8 - 0.8) })).toBe('rock')
  expect(most({ height: 2800, overSea: 2800 })).toBe('scree')
  expect(most({ height: 4500, overSea: 4500 })).toBe('snow')
  expect(most({ height: 0.5, overSea: 0.5 })).toBe('sand')
  // Without a sea.
  expect(most({ climate: 0.2, overSea: Infinity })).toBe('grass')
})

it('has shares with a sum of 1 at any place of a terrain', () => {
  const terrain = {
    atmosphere: { ellipsoid: Ellipsoid.WGS84, worldToECEF: new Matrix4() },
    source: new MountainHeights({ seed: 513 }),
    seaLevel: 0
  } as unknown as Terrain
  for (let n = 0; n < 50; n++) {
    const [longitude, latitude] = [137 * n - 180 * Math.floor(n / 2), ((61 * n) % 180) - 90]
    const position = Ellipsoid.WGS84.geodeticToECEF({ longitude, latitude, height: 100 })
    const { patch, climate, ...shares } = groundSharesAt(terrain, position)
    expect(Math.abs(patch) + Math.abs(climate)).toBeLessThan(4)
    expect(Object.values(shares).reduce((a, b) => a + b)).toBeCloseTo(1, 12)
    for (const share of Object.values(shares)) expect(share).toBeGreaterThanOrEqual(0)
  }
})

it('says what is wrong', () => {
  expect(() => groundSharesAt({} as Terrain, new Vector3())).toThrow(/groundSharesAt.*terrain/)
  const terrain = { atmosphere: {}, source: {} } as unknown as Terrain
  expect(() => groundSharesAt(terrain, new Vector3(NaN))).toThrow(/groundSharesAt.*position.*NaN/)
})

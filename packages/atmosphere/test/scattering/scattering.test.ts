import fc from 'fast-check'
import { describe, expect, it } from 'vitest'
import { AtmosphereParameters } from '@welkin/atmosphere'
import { distanceToGround, distanceToTop, hitsGround } from '../../src/air/cpu/boundary'
import {
  enterAir,
  inScatter,
  skyRadiance,
  type RayNumbers
} from '../../src/scattering/cpu/scattering'
import { opticalDepth } from '../../src/transmittance/cpu/transmittance'
import { cosine, number } from '../arbitraries'

const earth = new AtmosphereParameters()
const runs = { seed: 20260621, numRuns: 30 }

/** Rays from within the air, the light at any azimuth to them and up to 6° below the horizon. */
const rays: fc.Arbitrary<RayNumbers> = fc
  .tuple(number(0, 50_000), cosine, number(-0.1, 1), number(-1, 1))
  .map(([altitude, cosView, cosLight, azimuth]) => ({
    radius: earth.bottomRadius + altitude,
    cosView,
    cosLight,
    cosViewLight: cosView * cosLight + Math.sqrt((1 - cosView ** 2) * (1 - cosLight ** 2)) * azimuth
  }))

/** Ray that begins at a distance along another one. */
function along(ray: RayNumbers, distance: number): RayNumbers {
  const { radius, cosView, cosLight, cosViewLight } = ray
  const there = Math.sqrt(radius ** 2 + 2 * radius * cosView * distance + distance ** 2)
  return {
    radius: there,
    cosView: (radius * cosView + distance) / there,
    cosLight: (radius * cosLight + distance * cosViewLight) / there,
    cosViewLight
  }
}

function lengthOf({ radius, cosView }: RayNumbers): number {
  return hitsGround(radius, cosView, earth.bottomRadius)
    ? distanceToGround(radius, cosView, earth.bottomRadius)
    : distanceToTop(radius, cosView, earth.topRadius)
}

describe('light scattered along a ray', () => {
  it('is that of its near part, and of its far part as far as it passes the near one', () => {
    fc.assert(
      fc.property(rays, number(0.1, 0.9), (ray, part) => {
        const length = lengthOf(ray)
        fc.pre(length > 10)
        const near = inScatter(earth, null, ray, part * length)
        const far = inScatter(earth, null, along(ray, part * length), (1 - part) * length)
        const depth = opticalDepth(earth, ray.radius, ray.cosView, part * length)
        const whole = inScatter(earth, null, ray, length)
        whole.forEach((value, i) => {
          const sum = near[i] + far[i] * Math.exp(-depth[i])
          expect(Math.abs(sum - value)).toBeLessThan(0.01 * value + 1e-7)
        })
      }),
      runs
    )
  })

  it('grows with its length, and is nothing without air', () => {
    fc.assert(
      fc.property(rays, ray => {
        const length = lengthOf(ray)
        const half = inScatter(earth, null, ray, length / 2)
        inScatter(earth, null, ray, length).forEach((value, i) => {
          expect(value).toBeGreaterThanOrEqual(half[i] - 1e-7)
        })
      }),
      runs
    )
    const none = new AtmosphereParameters({
      rayleighScattering: [0, 0, 0, 0],
      mieScattering: [0, 0, 0, 0]
    })
    const ray = { radius: none.bottomRadius, cosView: 1, cosLight: 0.5, cosViewLight: 0.5 }
    expect(inScatter(none, null, ray, 60_000)).toEqual([0, 0, 0, 0])
  })
})

describe('rays from space', () => {
  it('enter the air at its top, on the line that they are on', () => {
    fc.assert(
      fc.property(number(1e5, 4e7), cosine, cosine, (height, cosView, cosLight) => {
        const radius = earth.topRadius + height
        const ray = { radius, cosView, cosLight, cosViewLight: cosView * cosLight }
        const inside = enterAir(earth, ray)
        const impact = radius * Math.sqrt(1 - cosView ** 2)
        if (inside === null) {
          expect(cosView > 0 || impact > earth.topRadius * (1 - 1e-9)).toBe(true)
          return
        }
        expect(inside.radius).toBe(earth.topRadius)
        expect(inside.cosView).toBeLessThanOrEqual(0)
        const impactInside = inside.radius * Math.sqrt(Math.max(1 - inside.cosView ** 2, 0))
        expect(Math.abs(impactInside - impact)).toBeLessThan(1)
      }),
      runs
    )
  })

  it('see nothing beside the air', () => {
    const data = { values: new Float32Array(0) }
    const ray = { radius: 4e7, cosView: 0, cosLight: 1, cosViewLight: 0 }
    expect(skyRadiance(earth, data, ray)).toEqual([0, 0, 0, 0])
  })
})

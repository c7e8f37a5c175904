import { AmbientLight, MathUtils, PerspectiveCamera, PointLight, Scene, Vector3 } from 'three'
import { texture } from 'three/tsl'
import { Texture } from 'three'
import fc from 'fast-check'
import { describe, expect, it } from 'vitest'
import {
  Atmosphere,
  precipitationOverlay,
  PrecipitationShelter,
  rainfall,
  snowfall
} from '@welkin/atmosphere'
import { BOX_SIDE, drawnParticles } from '../../src/precipitation/cpu/drawnParticles'
import { gustiness } from '../../src/precipitation/cpu/gustiness'
import { numberBetween, raindropSizes, snowflakeSizes } from '../../src/precipitation/cpu/sizes'
import { FallingLattice } from '../../src/precipitation/FallingLattice'
import { rain, snow } from '../../src/precipitation/ParticleKind'
import { EDGE_FADE, LENS, REACH_FADE } from '../../src/precipitation/tsl/particleVertex'
import { classExtinction, flakeWidth } from '../twins/precipitation/meanDepth'
import { throwsEach, wrong } from '../harness/wrong'

/** Speeds of drops in still air at the ground: Gunn & Kinzer 1949, table 2. Diameter [mm], speed [m/s]. */
const gunnKinzer = [
  [0.8, 3.27],
  [1, 4.03],
  [2, 6.49],
  [3, 8.06],
  [4, 8.83],
  [5, 9.09]
]

/** Water that falls [mm/h], by sums over sizes. */
function flux(rate: number, sizes: typeof raindropSizes, speed: (d: number) => number): number {
  let sum = 0
  for (let d = 0.1; d < 8; d += 0.01) {
    const volume = (Math.PI / 6) * (d + 0.005) ** 3 // mm³
    sum += numberBetween(sizes(rate), d, d + 0.01) * volume * speed(d)
  }
  return sum * 3.6e-3
}

describe('sizes', () => {
  it('have the number that an integral of N(D) has', () => {
    // 8000/Λ at all diameters; of 25 mm/h, Λ = 2.085 per mm.
    expect(numberBetween(raindropSizes(25), 0, Infinity)).toBeCloseTo(3836, -1)
    expect(numberBetween(raindropSizes(25), 1, 2)).toBeCloseTo(418, -1)
    expect(numberBetween(snowflakeSizes(1), 1, Infinity)).toBeCloseTo(116.4, 0)
  })

  it('carry about the water of their rate at the measured speeds', () => {
    for (const rate of [1, 5, 25, 100]) {
      expect(flux(rate, raindropSizes, rain.speed) / rate).toBeGreaterThan(0.8)
      expect(flux(rate, raindropSizes, rain.speed) / rate).toBeLessThan(1.2)
    }
    for (const rate of [0.5, 1, 2.5]) {
      expect(flux(rate, snowflakeSizes, snow.speed) / rate).toBeGreaterThan(0.75)
      expect(flux(rate, snowflakeSizes, snow.speed) / rate).toBeLessThan(1.25)
    }
  })

  it('have speeds within 4 % of Gunn and Kinzer', () => {
    for (const [diameter, speed] of gunnKinzer) {
      expect(Math.abs(rain.speed(diameter) / speed - 1)).toBeLessThan(0.04)
    }
  })

  it('have speeds of flakes that Locatelli and Hobbs measured, by the width of the flake', () => {
    // Table 1: 0.8 D^0.16 m/s for aggregates of dendrites, D in mm.
    for (const diameter of [0.5, 1, 2, 4]) {
      const width = 1000 * flakeWidth(diameter)
      expect(snow.speed(diameter)).toBeCloseTo(0.8 * width ** 0.16, 4)
    }
  })

  it('extinguish as Atlas measured, half of it diffracted', () => {
    for (const rate of [2, 10, 25, 50]) {
      const drawn = [0, 1, 2, 3].reduce(
        (sum, i) => sum + classExtinction(rain, rate, i, d => d / 1000),
        0
      )
      // The smallest drops are left out: they have 2 to 15 % of it.
      const share = drawn / ((0.5 * 0.33 * rate ** 0.64) / 1000)
      expect(share).toBeGreaterThan(0.75)
      expect(share).toBeLessThan(1.15)
    }
  })
})

describe('drawn particles', () => {
  it('are as many as there are, or stand for the rest', () => {
    const rates = fc.double({ min: 0.1, max: 300, noNaN: true })
    const most = fc.integer({ min: 100, max: 200_000 })
    fc.assert(
      fc.property(rates, most, fc.constantFrom(rain, snow), (rate, limit, kind) => {
        drawnParticles(kind, rate, limit).forEach(({ side, proposed, count, weight }, i) => {
          expect(count).toBeLessThanOrEqual(limit)
          expect(weight).toBeGreaterThanOrEqual(1)
          // Mean over the class of the share that is there, by sums over the drawn sizes.
          const [from, to] = [kind.edges[i], kind.edges[i + 1]]
          const drawn = kind.sizes(kind.drawnRate)
          const now = kind.sizes(rate)
          const step = (to - from) / 500
          let there = 0
          for (let d = from; d < to - step / 2; d += step) {
            const part = numberBetween(drawn, d, d + step) / numberBetween(drawn, from, to)
            const middle = d + step / 2
            const ratio =
              (now.intercept * Math.exp(-now.slope * middle)) /
              (drawn.intercept * Math.exp(-drawn.slope * middle))
            there += part * Math.min(proposed * ratio, count)
          }
          const real = numberBetween(now, from, to) * side ** 3
          expect((there * weight) / real).toBeGreaterThan(0.97)
          expect((there * weight) / real).toBeLessThan(1.03)
        })
      }),
      { numRuns: 30 }
    )
  })

  it('are at most 400,000 at 25 mm/h, as costs are stated for', () => {
    const counts = drawnParticles(rain, 25, 131_072).map(({ count }) => count)
    expect(counts.reduce((a, b) => a + b)).toBeLessThan(400_000)
    expect(drawnParticles(rain, 0, 1000).every(({ count }) => count === 0)).toBe(true)
  })
})

describe('FallingLattice', () => {
  const calm = { east: 0, north: 0 }
  /** Place of a particle from the camera, nearest to the middle of a box of 24 m. */
  function place(lattice: FallingLattice): Vector3 {
    const [middle, drift] = [new Vector3(), new Vector3()]
    lattice.box(16, middle, drift)
    const at = new Vector3(0.3, 0.6, 0.9).add(drift)
    for (const axis of ['x', 'y', 'z'] as const) at[axis] -= Math.floor(at[axis]) + 0.5
    return at.multiplyScalar(24).add(middle)
  }

  it('leaves particles where they are while the camera moves and turns', () => {
    for (const frame of ['local', 'ecef'] as const) {
      const atmosphere = new Atmosphere({ frame })
      const start = new Vector3(0, 2, 0)
      if (frame === 'ecef') {
        atmosphere.ellipsoid.geodeticToECEF({ longitude: 11, latitude: 47, height: 600 }, start)
      }
      const camera = new PerspectiveCamera()
      camera.position.copy(start)
      camera.updateMatrixWorld()
      const lattice = new FallingLattice()
      lattice.update(atmosphere, camera, 0, calm, 0)
      const before = lattice.camera.clone().add(place(lattice))
      for (let i = 0; i < 40; i++) {
        camera.position.copy(start).add(new Vector3(31 * i, -7 * i, 3 * i))
        camera.rotation.y = i
        camera.updateMatrixWorld()
        lattice.update(atmosphere, camera, 0, calm, 0)
        const now = lattice.camera.clone().add(place(lattice)).sub(before).divideScalar(24)
        for (const turns of now.toArray()) expect(turns - Math.round(turns)).toBeCloseTo(0, 6)
      }
    }
  })

  it('lets nothing in sight pop while the view turns', () => {
    const camera = new PerspectiveCamera()
    const lattice = new FallingLattice()
    const atmosphere = new Atmosphere()
    const [middle, drift, offset, forward] = Array.from({ length: 4 }, () => new Vector3())
    const corner = (47 * Math.PI) / 180
    let most = 0
    for (const reach of [3, 16, 60]) {
      const before = new Map<number, { offset: Vector3; fade: number }>()
      for (let step = 0; step < 240; step++) {
        camera.rotation.set(0.3 * Math.sin(step / 40), (step * Math.PI) / 720, 0, 'YXZ')
        camera.updateMatrixWorld()
        forward.copy(lattice.forward)
        lattice.update(atmosphere, camera, 0, calm, 0)
        lattice.box(reach, middle, drift)
        for (let i = 0; i < 400; i++) {
          const box = new Vector3((0.618 * i) % 1, (0.755 * i) % 1, (0.57 * i) % 1).add(drift)
          for (const axis of ['x', 'y', 'z'] as const) box[axis] -= Math.floor(box[axis]) + 0.5
          offset
            .copy(box)
            .multiplyScalar(BOX_SIDE * reach)
            .add(middle)
          const distance = offset.length()
          const isNear = distance > LENS[1] && distance < reach
          const isSeen = isNear && offset.angleTo(lattice.forward) < corner
          const last = before.get(i)
          if (!isSeen) before.delete(i)
          else {
            const side = 2 * Math.max(...box.toArray().map(Math.abs))
            const fade =
              (1 - MathUtils.smoothstep(side, EDGE_FADE, 1)) *
              (1 - MathUtils.smoothstep(distance / reach, REACH_FADE, 1))
            // What has been in sight was the same particle there, and what has not was none.
            if (last) expect(offset.distanceTo(last.offset)).toBeLessThan(1e-6 * reach)
            if (offset.angleTo(forward) < corner && step > 0) {
              most = Math.max(most, Math.abs(fade - (last?.fade ?? 0)))
            }
            before.set(i, { offset: offset.clone(), fade })
          }
        }
      }
    }
    // A quarter of a degree a frame.
    expect(most).toBeGreaterThan(0)
    expect(most).toBeLessThan(0.1)
  })

  it("follows the world's origin, the wind and the camera's speed", () => {
    const atmosphere = new Atmosphere()
    const camera = new PerspectiveCamera()
    camera.updateMatrixWorld()
    const lattice = new FallingLattice()
    const wind = { east: 3, north: -2 }
    lattice.update(atmosphere, camera, 10, wind, 0)
    const before = place(lattice)
    camera.position.set(0.5, 0, 0)
    camera.updateMatrixWorld()
    lattice.update(atmosphere, camera, 10.5, wind, 0)
    expect(lattice.cameraVelocity.x).toBeCloseTo(1, 6)
    const moved = place(lattice).sub(before)
    expect(moved.x).toBeCloseTo(1.5 - 0.5, 6)
    expect(moved.z).toBeCloseTo(1, 6)
  })

  it('has gusts of deviation 1, whose way is the integral of their speed', () => {
    let [sum, squares] = [0, 0]
    for (let i = 0; i < 20_000; i++) {
      const { speed } = gustiness(i * 0.37)
      sum += speed / 20_000
      squares += speed ** 2 / 20_000
    }
    expect(sum).toBeCloseTo(0, 1)
    expect(squares).toBeCloseTo(1, 1)
    const slope = (gustiness(41.001).way - gustiness(40.999).way) / 0.002
    expect(slope).toBeCloseTo(gustiness(41).speed, 4)
    expect(gustiness(0).way).toBe(0)
  })
})

const atmosphere = new Atmosphere()
const camera = new PerspectiveCamera()
const picture = texture(new Texture())

throwsEach('precipitation', [
  [
    "Rainfall: unknown option 'rat', did you mean 'rate'?",
    () => rainfall(atmosphere, wrong({ rat: 3 }))
  ],
  ['Rainfall: atmosphere must be an Atmosphere', () => rainfall(wrong(null))],
  ['Rainfall: rate must be in [0, 300], got -1', () => rainfall(atmosphere, { rate: -1 })],
  ['Snowfall: gusts must be in [0, 1], got 2', () => snowfall(atmosphere, { gusts: 2 })],
  ['Snowfall: shutter must be finite and ≥ 0, got -1', () => snowfall(atmosphere, { shutter: -1 })],
  ['Rainfall: focus must be positive and finite, got 0', () => rainfall(atmosphere, { focus: 0 })],
  ['Rainfall: time must be a finite number', () => rainfall(atmosphere, { time: NaN })],
  [
    'Rainfall: wind.east must be a finite number',
    () => rainfall(atmosphere, { wind: wrong({ east: '1', north: 0 }) })
  ],
  [
    'Rainfall: lights[0] must be a Light',
    () => rainfall(atmosphere, { lights: wrong([new Scene()]) })
  ],
  [
    'Rainfall: lights must have at most 4 lamps, got 5',
    () => rainfall(atmosphere, { lights: Array.from({ length: 5 }, () => new PointLight()) })
  ],
  ['Rainfall: depthCamera must be the Camera', () => rainfall(atmosphere, { depth: picture })],
  [
    'Rainfall: maxParticles must be a positive integer',
    () => rainfall(atmosphere, { maxParticles: 0 })
  ],
  [
    'Rainfall: shelter must be a PrecipitationShelter',
    () => rainfall(atmosphere, { shelter: wrong({}) })
  ],
  ['PrecipitationShelter: scene must be a Scene', () => new PrecipitationShelter(wrong(null))],
  [
    'PrecipitationShelter: extent must be positive',
    () => new PrecipitationShelter(new Scene(), { extent: 0 })
  ],
  [
    'PrecipitationShelter: size must be a positive integer',
    () => new PrecipitationShelter(new Scene(), { size: 0.5 })
  ],
  [
    'PrecipitationOverlayNode: falling[0] must be rainfall or snowfall',
    () => precipitationOverlay(picture, camera, wrong([new AmbientLight()]))
  ]
])

import { Atmosphere, type AtmosphereView } from '@welkin/atmosphere'
import fc from 'fast-check'
import { Matrix3, PerspectiveCamera, PointLight, Vector3 } from 'three'
import { float, vec4 } from 'three/tsl'
import { describe, expect, it, test, vi } from 'vitest'
import { cloudPreset, clouds, lightning } from '../../src'
import { crookedLine, lightningChannel, STEM_POINTS, type Point } from '../../src/lightning/channel'
import { emittedUntil, flashCurve, lightBetween } from '../../src/lightning/flashCurve'
import { FlashLimit } from '../../src/lightning/FlashLimit'
import { LightningPasses } from '../../src/lightning/LightningPasses'
import { meanInverseSquareOf } from '../twins/lightning'

/** Numbers of a linear congruential generator. */
function numbers(seed: number): () => number {
  let state = seed
  return () => (state = (state * 1_103_515_245 + 12_345) % 2 ** 31) / 2 ** 31
}
const seeds = fc.integer({ min: 1, max: 1e6 })

describe('flash curve', () => {
  it('emits all of a pulse, and rises and falls as was measured', () => {
    expect(emittedUntil(-1e-3)).toBe(0)
    expect(emittedUntil(0.02)).toBeCloseTo(1, 12)
    // Its slope is greatest 84 µs after the begin, and half of that 0.37 ms (Christian & Goodman 1987: 0.3 to 0.5) apart.
    const step = 1e-6
    const power = Array.from(
      { length: 2000 },
      (_, i) => emittedUntil((i + 1) * step) - emittedUntil(i * step)
    )
    const peak = Math.max(...power)
    expect(power.indexOf(peak)).toBeGreaterThan(80)
    expect(power.indexOf(peak)).toBeLessThan(88)
    const wide = power.filter(value => value > peak / 2).length
    expect(wide).toBeGreaterThan(300)
    expect(wide).toBeLessThan(500)
  })

  it('gives the same light however time is cut into frames', () => {
    fc.assert(
      fc.property(seeds, fc.constantFrom('ground' as const, 'cloud' as const), (seed, kind) => {
        const curve = flashCurve(kind, numbers(seed))
        const whole = lightBetween(curve, -1, 3).all
        let sum = 0
        const frame = curve.duration / 37.3
        for (let at = -frame; at < curve.duration + 0.1; at += frame)
          sum += lightBetween(curve, at, at + frame).all
        expect(sum / whole).toBeCloseTo(1, 9)
      })
    )
  })

  it('has three or four strokes, 60 ms apart in the geometric mean, of which the first one lights branches', () => {
    const gaps: number[] = []
    for (let seed = 1; seed < 400; seed++) {
      const { strokes } = flashCurve('ground', numbers(97 * seed))
      expect([3, 4]).toContain(strokes.length)
      expect(strokes.map(({ lightsBranches }) => lightsBranches)).toEqual(
        strokes.map((_, i) => i === 0)
      )
      strokes.slice(1).forEach(({ time }, i) => gaps.push(Math.log(time - strokes[i].time)))
    }
    const mean = Math.exp(gaps.reduce((a, b) => a + b) / gaps.length)
    expect(mean).toBeGreaterThan(0.055)
    expect(mean).toBeLessThan(0.065)
  })

  it('emits as many joules as were seen from above', () => {
    // Optical energies of flashes: 1e5 to 1e7 J (Turman 1978, J. Geophys. Res. 83, 5019), with 155 lm/W.
    for (let seed = 1; seed < 50; seed++) {
      const joules = lightBetween(flashCurve('ground', numbers(seed * 31)), 0, 3).all / 155
      expect(joules).toBeGreaterThan(1e5)
      expect(joules).toBeLessThan(1e7)
    }
  })
})

describe('channel', () => {
  const column = { base: 1000, top: 11_000 }

  it('goes from the charge in the cloud to the ground, unbroken, and is the same for the same numbers', () => {
    fc.assert(
      fc.property(seeds, seed => {
        const { stem, pieces, brightLength } = lightningChannel('ground', column, numbers(seed))
        expect(stem).toHaveLength(STEM_POINTS)
        expect(stem[0][2]).toBeCloseTo(5200, 0)
        expect(stem[STEM_POINTS - 1]).toEqual([0, 0, 0])
        const main = pieces.filter(({ isBranch }) => !isBranch)
        main.slice(1).forEach((piece, i) => expect(piece.from).toEqual(main[i].to))
        expect(pieces.every(({ from, to }) => from[2] >= 0 && to[2] >= 0)).toBe(true)
        expect(brightLength).toBeGreaterThan(5200)
        const again = lightningChannel('ground', column, numbers(seed))
        expect(again.pieces).toEqual(pieces)
      }),
      { numRuns: 20 }
    )
  })

  it('stays in the cloud where it is told to', () => {
    const { stem } = lightningChannel('cloud', column, numbers(5))
    expect(stem.every(([, , z]) => z > 3000 && z < 11_000)).toBe(true)
  })

  it('turns by 16° in the mean (Hill 1968)', () => {
    const random = numbers(77)
    const turns: number[] = []
    for (let run = 0; run < 40; run++) {
      const line = crookedLine([0, 0, 5000], [0, 0, 1], random)
      const ways = line.slice(1).map((p, i) => new Vector3(...p).sub(new Vector3(...line[i])))
      // Projected, as photographs show it.
      ways.forEach(way => way.setY(0))
      ways.slice(1).forEach((way, i) => turns.push((way.angleTo(ways[i]) * 180) / Math.PI))
    }
    const mean = turns.reduce((a, b) => a + b) / turns.length
    expect(mean).toBeGreaterThan(14.5)
    expect(mean).toBeLessThan(17.5)
  })
})

describe('light of a line', () => {
  it('is an inverse square far away', () => {
    const far = meanInverseSquareOf([5e4, 0, 0], [5e4, 0, 100], 1)
    expect(far * 5e4 ** 2).toBeCloseTo(1, 4)
  })

  it('sends all of its light through a sphere around it, wherever in it the line is', () => {
    // ∮ cos θ Q/(4π r²) dA = Q (Gauss), over a sphere of 3 km with a short line aside of its middle.
    const [radius, rows] = [3000, 60]
    const line: [Point, Point] = [
      [800, 300, -200],
      [801, 300, -200]
    ]
    let flux = 0
    for (let i = 0; i < rows; i++) {
      const cosine = -1 + (2 * (i + 0.5)) / rows
      for (let j = 0; j < rows; j++) {
        const azimuth = (2 * Math.PI * (j + 0.5)) / rows
        const sine = Math.sqrt(1 - cosine ** 2)
        const normal = new Vector3(sine * Math.cos(azimuth), sine * Math.sin(azimuth), cosine)
        const place = normal.clone().multiplyScalar(radius)
        const way = place.clone().sub(new Vector3(...line[0]))
        const square = way.lengthSq()
        flux += way.normalize().dot(normal) / (4 * Math.PI * square)
      }
    }
    expect(flux * ((4 * Math.PI * radius ** 2) / rows ** 2)).toBeCloseTo(1, 3)
  })
})

describe('limit', () => {
  it('lets light rise three times a second at most, and never above the cap', () => {
    fc.assert(
      fc.property(
        fc.array(fc.double({ min: 0, max: 1e10, noNaN: true }), { minLength: 200, maxLength: 200 }),
        powers => {
          const limit = new FlashLimit()
          const frame = 1 / 60
          const rises: number[] = []
          let last = 0
          powers.forEach((power, i) => {
            const light = limit.step(power, 1e9, frame)
            expect(light).toBeLessThanOrEqual(1e9)
            if (light > last) rises.push(i * frame)
            last = light
          })
          rises.forEach((time, i) => {
            if (i >= 3) expect(time - rises[i - 3]).toBeGreaterThan(0.999)
          })
        }
      )
    )
  })
})

describe('lightning', () => {
  const node = (): ReturnType<typeof clouds> =>
    clouds(
      vec4(0),
      float(1),
      new PerspectiveCamera(),
      new Atmosphere(),
      cloudPreset('cumulonimbus')
    )

  test('is checked', () => {
    const made = node()
    expect(() => lightning(made, { rate: -1 })).toThrow(
      'Lightning: rate must be finite and ≥ 0, got -1'
    )
    expect(() => lightning(made, { groundShare: 2 })).toThrow(
      'Lightning: groundShare must be in [0, 1], got 2'
    )
    expect(() => lightning(made, { limit: 0 })).toThrow(
      'Lightning: limit must be positive and finite, or null, got 0'
    )
    expect(() => lightning(made, { seed: 0.5 })).toThrow(
      'Lightning: seed must be an integer, got 0.5'
    )
    expect(() => lightning(made, { exposure: 0 })).toThrow(
      'Lightning: exposure must be in [0.0001, 10], got 0'
    )
    expect(() => lightning(made, { rte: 1 } as never)).toThrow(
      "unknown option 'rte', did you mean 'rate'?"
    )
    expect(() => lightning(3 as never)).toThrow('Lightning: clouds must be a CloudsNode')
    expect(() => lightning(made).strike({ kind: 'sea' } as never)).toThrow(
      "Lightning.strike: kind must be 'ground' or 'cloud'"
    )
    expect(() => lightning(made).strike({ at: 1 } as never)).toThrow(
      'Lightning.strike: at must be a Vector3'
    )
  })

  test('forgets what it was asked for while it is off: no flash comes when it is switched on', () => {
    const made = node()
    vi.spyOn(made.field, 'isReady', 'get').mockReturnValue(true)
    const begin = vi.spyOn(LightningPasses.prototype, 'begin').mockReturnValue()
    const render = vi.spyOn(LightningPasses.prototype, 'render').mockReturnValue()
    const { atmosphere, camera } = made
    const up = new Vector3(0, 0, 1)
    const view = {
      atmosphere,
      camera,
      up,
      height: 0,
      viewToMapped: new Matrix3()
    } as unknown as AtmosphereView
    const storm = lightning(made)
    let [flashes, time] = [0, 0]
    storm.addEventListener('strike', () => flashes++)
    /** Frames of a second. */
    const wait = (seconds: number): void => {
      for (let i = 0; i < seconds; i++) {
        storm.time = ++time
        storm.prepare({} as never, view, { time } as never)
      }
    }
    const at = new Vector3(0, 100, -3000)
    storm.enabled = false
    for (let i = 0; i < 5; i++) storm.strike({ at })
    wait(5)
    storm.enabled = true
    wait(20)
    expect([flashes, storm.isFlashing]).toEqual([0, false])
    // What was asked for before, and has not begun, is forgotten as well.
    for (let i = 0; i < 5; i++) storm.strike({ at })
    storm.enabled = false
    wait(5)
    storm.enabled = true
    wait(20)
    expect(flashes).toBe(0)
    for (let i = 0; i < 2; i++) storm.strike({ at })
    wait(20)
    expect(flashes).toBe(2)
    begin.mockRestore()
    render.mockRestore()
    storm.dispose()
  })

  test('is part of the clouds until it is disposed', () => {
    const made = node()
    const storm = lightning(made, { rate: 3 })
    expect(made.screens.has(storm)).toBe(true)
    expect(storm.light).toBeInstanceOf(PointLight)
    expect([storm.rate, storm.limit, storm.isFlashing]).toEqual([3, 0.3, false])
    storm.dispose()
    expect(made.screens.has(storm)).toBe(false)
  })
})

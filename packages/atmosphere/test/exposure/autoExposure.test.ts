import fc from 'fast-check'
import { DataTexture, DataUtils, PerspectiveCamera } from 'three'
import { texture } from 'three/tsl'
import type { NodeFrame, Renderer } from 'three/webgpu'
import { describe, expect, it } from 'vitest'
import { Atmosphere, autoExposure, DayCycle, type AutoExposureOptions } from '@welkin/atmosphere'
import {
  adaptedScale,
  exposedScale,
  type MeteredLuminance
} from '../../src/exposure/cpu/exposedScale'
import {
  cellWeights,
  meteredLogLuminance,
  meterForm
} from '../../src/exposure/cpu/meteredLuminance'
import { number, runs } from '../arbitraries'

const COUNT = meterForm.cells[0] * meterForm.cells[1] * 4
const even = cellWeights(0)
const settings = {
  compensation: 0,
  limits: [1e-9, 1e12],
  darkNights: false,
  highlightPriority: 0.6
} as const
/** An even picture's luminances. */
const evenly = (luminance: number): MeteredLuminance => ({
  mean: luminance,
  light: luminance,
  bright: luminance,
  seen: 1
})

/** Samples of which parts, from the first on, have values. */
function samples(...parts: readonly [part: number, log: number][]): Float64Array {
  const logs = new Float64Array(COUNT)
  let start = 0
  for (const [part, log] of parts) {
    const end = start + part * COUNT
    logs.fill(log, Math.round(start), Math.round(end))
    start = end
  }
  return logs
}

const mean = (logs: ArrayLike<number>, low = 0, high = 1, weights = even): number =>
  meteredLogLuminance(logs, weights, [low, high]).mean

describe('metered luminance', () => {
  it('is that of an even picture, whatever the weights and percentiles', () => {
    fc.assert(
      fc.property(
        number(-23.9, 16),
        number(0, 1),
        number(0, 0.49),
        number(0.51, 1),
        (log, middle, low, high) => {
          const logs = new Float64Array(COUNT).fill(log)
          const metered = meteredLogLuminance(logs, cellWeights(middle), [low, high])
          expect(metered.mean).toBeCloseTo(log, 9)
          expect(metered.light).toBeCloseTo(log, 9)
          expect(metered.bright).toBeCloseTo(log, 9)
        }
      ),
      { ...runs, numRuns: 50 }
    )
  })

  it('is the mean in stops between percentiles, which cut within a bin', () => {
    const logs = samples([0.2, -1], [0.5, 1], [0.2, 4], [0.1, 6])
    expect(mean(logs, 0, 0.9)).toBeCloseTo((-0.2 + 0.5 + 0.8) / 0.9, 2)
    expect(mean(logs, 0.1, 0.9)).toBeCloseTo((-0.1 + 0.5 + 0.8) / 0.8, 2)
    expect(mean(logs, 0.2, 0.7)).toBeCloseTo(1, 2)
    expect(mean(logs, 0.3, 0.8)).toBeCloseTo((0.4 + 0.4) / 0.5, 2)
  })

  it('leaves out black, what is no number, and what is 12 stops darker than the bright', () => {
    expect(mean(samples([0.5, -24], [0.5, 2]))).toBe(2)
    expect(mean(samples([0.5, NaN], [0.5, 2]))).toBe(2)
    expect(mean(samples([0.5, -10], [0.5, 2]))).toBe(2)
    expect(mean(samples([0.5, -8], [0.5, 2]))).toBeCloseTo((2 - 8 * 0.5) / 1.5, 9)
    expect(mean(samples([0.5, -6], [0.5, 2]))).toBeCloseTo(-2, 9)
    expect(mean(new Float64Array(COUNT).fill(-24))).toBe(meterForm.darkest)
    expect(mean(new Float64Array(COUNT).fill(NaN))).toBe(meterForm.darkest)
  })

  it('knows what part of the picture is seen', () => {
    const seen = (...parts: readonly [part: number, log: number][]): number =>
      meteredLogLuminance(samples(...parts), even, [0.1, 0.97]).seen
    expect(seen([1, 3])).toBe(1)
    expect(seen([0.25, -24], [0.75, 2])).toBeCloseTo(0.75, 9)
    expect(seen([0.25, -10], [0.75, 2])).toBeCloseTo(0.75, 9)
    expect(seen([0.25, -8], [0.75, 2])).toBeCloseTo(0.875, 9)
    expect(seen([1, -24])).toBe(1)
  })

  it('gives no more weight to the sun than to any pixel', () => {
    const logs = new Float64Array(COUNT).fill(0)
    logs.fill(Infinity, 0, COUNT / 100)
    expect(mean(logs, 0.1, 0.97)).toBe(0)
    logs.fill(7, 0, COUNT / 100)
    expect(mean(logs)).toBeCloseTo(0.07, 2)
  })

  it('counts the middle more than the edges', () => {
    const [width, height] = meterForm.cells
    const inner = Array.from({ length: COUNT }, (_, i) => {
      const x = ((i >> 2) % width) / width
      const y = Math.floor((i >> 2) / width) / height
      return x >= 0.25 && x < 0.75 && y >= 0.25 && y < 0.75 ? 2 : 0
    })
    expect(mean(inner)).toBeCloseTo(0.5, 9)
    expect(mean(inner, 0, 1, cellWeights(0.5))).toBeGreaterThan(0.6)
    // The Gaussian's part within one standard deviation, over that within two, squared: 0.512.
    expect(mean(inner, 0, 1, cellWeights(1)) / 2).toBeCloseTo(0.512, 1)
  })
})

describe('exposed scale', () => {
  it('shows any light as middle grey, and compensation in stops', () => {
    fc.assert(
      fc.property(number(1e-6, 1e6), number(-5, 5), (luminance, compensation) => {
        const scale = exposedScale(evenly(luminance), { ...settings, compensation })
        expect(Math.log2((scale * luminance) / 0.17)).toBeCloseTo(compensation, 9)
      }),
      runs
    )
  })

  it('shows nights the darker the less light there is, unless told otherwise', () => {
    const shown = (luminance: number, darkNights: boolean): number =>
      luminance * exposedScale(evenly(luminance), { ...settings, darkNights })
    fc.assert(
      fc.property(number(-6, 4), number(0.1, 2), (log, step) => {
        expect(shown(10 ** log, true)).toBeLessThan(shown(10 ** (log + step), true))
        expect(shown(10 ** log, false)).toBeCloseTo(0.17, 9)
      }),
      runs
    )
    expect(shown(5000, true)).toBeCloseTo(0.17, 9)
    // Krawczyk's key where only rods see is 0.03.
    expect(shown(0.016, true)).toBeGreaterThan(0.02)
    expect(shown(0.016, true)).toBeLessThan(0.04)
  })

  it('keeps to its limits, and the bright below white', () => {
    const limited = { ...settings, limits: [1, 100] } as const
    expect(exposedScale(evenly(1e-3), limited)).toBe(exposedScale(evenly(1), limited))
    expect(exposedScale({ ...evenly(1e-3), seen: 0.1 }, limited)).toBe(
      exposedScale(evenly(1), limited)
    )
    expect(exposedScale(evenly(1e6), limited)).toBe(exposedScale(evenly(100), limited))
    expect(1e5 * exposedScale({ ...evenly(10), bright: 1e5 }, settings)).toBeCloseTo(8, 9)
  })

  it('gives way to a bright tenth by the part of its stops over 0.8 that it is told', () => {
    const land = { mean: 1, light: 16, bright: 20, seen: 1 }
    const shown = (highlightPriority: number): number =>
      exposedScale(land, { ...settings, highlightPriority })
    expect(shown(0)).toBeCloseTo(0.17, 9)
    expect(16 * shown(1)).toBeCloseTo(0.8, 9)
    expect(shown(0.5) ** 2).toBeCloseTo(shown(0) * shown(1), 9)
    // What is not over it changes nothing.
    const mild = { mean: 1, light: 4.7, bright: 5, seen: 1 }
    expect(exposedScale(mild, settings)).toBeCloseTo(0.17, 9)
    const logs = samples([0.85, -3], [0.15, 1])
    expect(meteredLogLuminance(logs, even, [0.1, 0.97])).toMatchObject({ light: 1, bright: 1 })
    const few = samples([0.95, -3], [0.05, 1])
    expect(meteredLogLuminance(few, even, [0.1, 0.97])).toMatchObject({ light: -3, bright: 1 })
  })

  it('shows what is beside black brighter: its brightest tenth at 0.6 at most, and nights stay night', () => {
    const planet = { mean: 1, light: 1.5, bright: 2, seen: 0.7 }
    const shown = (changes: Partial<MeteredLuminance>, darkNights = false): number =>
      exposedScale({ ...planet, ...changes }, { ...settings, darkNights })
    // The mean light stays: 0.7 of the picture at 0.17 / 0.7.
    expect(0.7 * shown({})).toBeCloseTo(0.17, 9)
    expect(1.5 * shown({ seen: 0.01 })).toBeCloseTo(0.6, 9)
    // A sun beside space is no reason for more.
    expect(shown({ light: 8, seen: 0.5 })).toBeCloseTo(shown({ light: 8, seen: 1 }), 9)
    const moonlit = { mean: 1e-3, light: 2e-3, bright: 3e-3 }
    const night = (seen: number): number => shown({ ...moonlit, seen }, true)
    expect(night(0.01) / night(1)).toBeCloseTo(0.6 / 0.17 / 2, 9)
    fc.assert(
      fc.property(number(0.01, 1), number(0.01, 1), number(1, 50), (one, other, light) => {
        const [less, more] = [Math.min(one, other), Math.max(one, other)]
        expect(shown({ light, seen: less })).toBeGreaterThanOrEqual(shown({ light, seen: more }))
      }),
      runs
    )
  })

  it('takes 63 % of the stops in its time, however that is cut into steps', () => {
    expect(Math.log2(adaptedScale(1, 2 ** 10, 0.4, 0.4))).toBeCloseTo(10 * (1 - 1 / Math.E), 9)
    expect(adaptedScale(1, 3, 0, 0.4)).toBe(1)
    expect(adaptedScale(1, 3, 0, 0)).toBe(3)
    fc.assert(
      fc.property(
        number(1e-6, 1e6),
        number(1e-6, 1e6),
        number(0.01, 5),
        fc.integer({ min: 1, max: 30 }),
        (from, to, time, steps) => {
          let scale = from
          for (let i = 0; i < steps; i++) scale = adaptedScale(scale, to, time / steps, 0.7)
          expect(scale / adaptedScale(from, to, time, 0.7)).toBeCloseTo(1, 9)
        }
      ),
      runs
    )
  })
})

/** An exposure before a renderer that draws nothing, and whose reads end when the test says so. */
function stage(options?: AutoExposureOptions) {
  const reads: { resolve: (pixels: Uint16Array) => void; reject: (error: Error) => void }[] = []
  const known: Record<string, unknown> = {
    isRenderer: true,
    readRenderTargetPixelsAsync: () =>
      new Promise((resolve, reject) => {
        reads.push({ resolve, reject })
      })
  }
  const renderer = new Proxy(known, {
    get: (target, name) => target[name as string] ?? (() => undefined)
  }) as unknown as Renderer
  const atmosphere = new Atmosphere()
  const picture = texture(new DataTexture(new Uint8Array(4), 1, 1))
  const exposure = autoExposure(picture, atmosphere, { darkNights: false, ...options })
  return {
    atmosphere,
    exposure,
    reads,
    draw: () => exposure.updateBefore({ renderer } as NodeFrame),
    /** Ends the oldest read with an even picture. */
    answer: async (value: number) => {
      const half = DataUtils.toHalfFloat(Math.log2(value))
      reads.shift()!.resolve(new Uint16Array(COUNT).fill(half))
      await new Promise(resolve => setTimeout(resolve, 0))
    }
  }
}

describe('AutoExposureNode', () => {
  it('knows with which scale the picture was drawn that comes back', async () => {
    const { atmosphere, exposure, draw, answer } = stage()
    atmosphere.luminanceScale = 1e-3
    draw()
    atmosphere.luminanceScale = 1
    await answer(0.25)
    expect(exposure.luminance).toBeCloseTo(250, 9)
    draw()
    atmosphere.luminanceScale = 7
    await answer(0.5)
    expect(exposure.luminance).toBeCloseTo(0.5, 9)
  })

  it('has one read under way at a time', async () => {
    const { draw, reads, answer } = stage()
    draw()
    draw()
    expect(reads).toHaveLength(1)
    await answer(1)
    draw()
    expect(reads).toHaveLength(1)
  })

  it('takes its first reading at once and later ones in their times', async () => {
    const { atmosphere, exposure, draw, answer } = stage({ lightSeconds: 0.5, darkSeconds: 2 })
    exposure.adapt(1)
    expect(atmosphere.luminanceScale).toBe(1e-4)
    draw()
    await answer(0.5)
    exposure.adapt(0)
    expect(atmosphere.luminanceScale * 5000).toBeCloseTo(0.17, 9)

    const stops = (): number => Math.log2(atmosphere.luminanceScale / (0.17 / 5000))
    draw()
    await answer(0.17 / 16)
    exposure.adapt(0.5)
    expect(stops()).toBeCloseTo(4 * (1 - Math.exp(-0.25)), 2)
    exposure.adapt(1.5)
    expect(stops()).toBeCloseTo(4 * (1 - Math.exp(-1)), 2)
    atmosphere.luminanceScale = 0.17 / 5000
    draw()
    await answer(0.17 * 16)
    exposure.adapt(0.5)
    expect(stops()).toBeCloseTo(-4 * (1 - Math.exp(-1)), 2)
  })

  it('settles at once, and waits for the first light', async () => {
    const { atmosphere, exposure, draw, answer } = stage({ limits: [1, 1e5] })
    draw()
    await answer(2 ** -24)
    exposure.adapt(1)
    expect(atmosphere.luminanceScale).toBeGreaterThan(0.1)
    draw()
    await answer(1000 * atmosphere.luminanceScale)
    exposure.adapt(1e-3)
    expect(atmosphere.luminanceScale * 1000).toBeCloseTo(0.17, 2)
    draw()
    await answer(50 * atmosphere.luminanceScale)
    await exposure.settle()
    expect(atmosphere.luminanceScale * 50).toBeCloseTo(0.17, 2)
  })

  it('meters the last picture anew with other percentiles, weights and limits', async () => {
    const { exposure, draw, answer } = stage()
    draw()
    await answer(0.5)
    exposure.set({ percentiles: [0.3, 0.6], centerWeight: 1, limits: [1e4, 1e5] })
    expect(exposure.luminance).toBeCloseTo(5000, 6)
    expect(exposure.targetScale! * 1e4).toBeCloseTo(0.17, 9)
    expect(() => exposure.set({ compensation: 3, percentiles: [0.5, 0.5] })).toThrow('rise')
    expect([exposure.compensation, exposure.percentiles]).toEqual([0, [0.3, 0.6]])
  })

  it('drops what was read before it was disposed of, and tells who waits of errors', async () => {
    const { atmosphere, exposure, draw, answer, reads } = stage()
    draw()
    exposure.dispose()
    await answer(0.5)
    expect([exposure.luminance, exposure.targetScale]).toEqual([null, null])
    draw()
    reads.shift()!.reject(new Error('device lost'))
    await expect(exposure.settle()).rejects.toThrow('device lost')
    expect(atmosphere.luminanceScale).toBe(1e-4)
    draw()
    await answer(0.5)
    expect(exposure.luminance).toBeCloseTo(5000, 6)
  })

  it('waits for skies that are baked in steps', () => {
    const { atmosphere, draw, reads } = stage()
    atmosphere.bakeStepsPerFrame = 2
    draw()
    expect(reads).toHaveLength(0)
  })

  it('sets the exposure of a cycle of the day', async () => {
    const { atmosphere, exposure, draw, answer } = stage({ lightSeconds: 1 })
    const cycle = new DayCycle(atmosphere, { autoExposure: exposure })
    draw()
    await answer(0.5)
    cycle.update(0.1, new PerspectiveCamera())
    expect(atmosphere.luminanceScale * 5000).toBeCloseTo(0.17, 9)
    expect(cycle.exposure).toBeCloseTo(0.34, 9)
    draw()
    await answer(0.34)
    cycle.update(-1)
    expect(Math.log2(cycle.exposure / 0.34)).toBeCloseTo(-(1 - 1 / Math.E), 2)
  })
})

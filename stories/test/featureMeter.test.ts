import { expect, it } from 'vitest'
import { FeatureMeter, type MeteredFeature } from '../src/valley/FeatureMeter'
import { meteredFeatures } from '../src/valley/meteredFeatures'
import { openingState } from '../src/valley/openingState'
import { featureText } from '../src/valley/shares'
import type { ValleyState } from '../src/valley/Valley'

interface Off {
  off?: string
}

/** GPU time of each feature of a scene that takes 4 ms besides [ms]. */
const costs: Readonly<Record<string, number>> = { clouds: 2.5, trees: 1.25, haze: 0 }
const features: readonly MeteredFeature<Off>[] = Object.keys(costs).map(name => ({
  name,
  off: { off: name }
}))

/** Frames until a time is read, and frames that are read at once. */
const LATE = 5
const TOGETHER = 4

/** A scene on a clock of its own, drawn at 60 frames a second. */
function sceneOf({ drift = 0, compiling = 0, every8th = 0 } = {}) {
  const switched: (string | undefined)[] = []
  let [off, seconds, since]: [string | undefined, number, number] = [undefined, 0, 0]
  const times: number[] = []
  const meter = new FeatureMeter<Off>(changes => {
    off = changes?.off
    since = seconds
    switched.push(off)
  })
  const run = (duration: number): void => {
    for (let frame = 0; frame < duration * 60; frame++) {
      seconds += 1 / 60
      const on = Object.entries(costs).filter(([name]) => name !== off)
      const spent = on.reduce((sum, [, cost]) => sum + cost, 4 + drift * seconds)
      // The first frames after a switch take longer.
      const first = seconds - since < compiling ? 50 : 0
      times.push(spent + first + (times.length % 8 === 0 ? every8th : 0))
      if (times.length % TOGETHER === 0 && times.length > LATE) {
        const read = times.slice(-LATE - TOGETHER, -LATE)
        const sum = read.reduce((total, time) => total + time, 0)
        meter.take(sum, read.length)
      }
      meter.update(1 / 60)
    }
  }
  return { meter, switched, run }
}

const round = (meter: FeatureMeter<Off>) =>
  Object.fromEntries(meter.shares.map(({ name, milliseconds }) => [name, milliseconds]))

it('finds what each feature takes, and leaves all on', () => {
  const { meter, switched, run } = sceneOf({ compiling: 0.5 })
  run(1)
  expect(switched).toEqual([])
  meter.start(features)
  expect(meter.isMeasuring).toBe(true)
  run(20)
  expect(meter.isMeasuring).toBe(false)
  for (const [name, cost] of Object.entries(costs)) {
    expect([name, round(meter)[name]]).toEqual([name, expect.closeTo(cost, 6)])
  }
  expect(switched).toEqual(['clouds', undefined, 'trees', undefined, 'haze', undefined])
})

it('is not misled by a scene that grows heavier', () => {
  const { meter, run } = sceneOf({ drift: 0.5 })
  meter.start(features)
  run(20)
  for (const [name, cost] of Object.entries(costs)) {
    expect(Math.abs(round(meter)[name] - cost)).toBeLessThan(0.05)
  }
})

it('is not misled by work of every eighth frame', () => {
  const { meter, run } = sceneOf({ every8th: 4 })
  meter.start(features)
  run(20)
  for (const [name, cost] of Object.entries(costs)) {
    expect(Math.abs(round(meter)[name] - cost)).toBeLessThan(0.1)
  }
})

it('ends at once, with all on', () => {
  const { meter, switched, run } = sceneOf()
  meter.start(features)
  run(2)
  expect([meter.current, switched]).toEqual(['clouds', ['clouds']])
  meter.stop()
  expect(switched).toEqual(['clouds', undefined])
  run(5)
  expect(switched).toHaveLength(2)
  expect(meter.shares).toEqual([])
  meter.stop()
  expect(switched).toHaveLength(2)
})

it('waits for times: without, nothing is switched', () => {
  const switched: unknown[] = []
  const meter = new FeatureMeter<Off>(off => switched.push(off))
  meter.start(features)
  for (let i = 0; i < 600; i++) meter.update(1 / 60)
  expect(switched).toEqual([])
  expect(meter.isMeasuring).toBe(true)
})

it('measures what is on, each by its own switch', () => {
  const state: ValleyState = { ...openingState, bloom: false, stars: false }
  const metered = meteredFeatures(state)
  const names = metered.map(({ name }) => name)
  expect(new Set(names).size).toBe(names.length)
  for (const name of ['all clouds', 'light shafts', 'haze', 'Milky Way', 'moon', 'airglow']) {
    expect(names).toContain(name)
  }
  for (const name of ['trees', 'village', 'lake', 'rain and snow', 'smooth edges']) {
    expect(names).toContain(name)
  }
  expect(names).not.toContain('bloom')
  expect(names).not.toContain('stars')
  for (const { name, off } of metered) {
    const changed = Object.entries(off).filter(
      ([key, value]) => state[key as keyof ValleyState] !== value
    )
    expect([name, changed.length]).toEqual([name, 1])
  }
})

it('has a share for every switch of the panel, but for what sets the clock and the exposure', () => {
  const switches = Object.entries(openingState).filter(([, value]) => typeof value === 'boolean')
  const keys = switches.map(([key]) => key)
  const state: ValleyState = {
    ...openingState,
    ...Object.fromEntries(keys.map(key => [key, true]))
  }
  const metered = new Set(meteredFeatures(state).flatMap(({ off }) => Object.keys(off)))
  expect(keys.filter(key => !metered.has(key))).toEqual(['paused', 'autoExposure'])
})

it('lists the longest first', () => {
  expect(featureText([])).toBe('')
  const shares = [
    { name: 'haze', milliseconds: 0.004 },
    { name: 'all clouds', milliseconds: 2.5 }
  ]
  expect(featureText(shares)).toBe('\n\nless without:\nall clouds 2.50\nhaze 0.00')
})

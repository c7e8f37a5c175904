import fc from 'fast-check'
import { expect, it } from 'vitest'
import { isKnown, predict, type FeatureName, type Part, type Range } from '../gpu/harness/predict'

/** A feature's part of a pixel: light that it adds, and what it lets through of the light behind it. */
interface Layer {
  name: FeatureName
  light: number
  passes: number
}

/** Light of a pixel of the sky, far before near. */
const through = (sky: number, layers: readonly Layer[]): number =>
  layers.reduce((behind, { light, passes }) => behind * passes + light, sky)

/** The layers one by one; what covers has been measured to pass what it does. */
const alone = (sky: number, layers: readonly Layer[], isMeasured: boolean): Part[] =>
  layers.map(layer => ({
    name: layer.name,
    value: through(sky, [layer]),
    ...(isMeasured && { passes: [layer.passes, layer.passes] as const })
  }))

const number = fc.double({ min: 0, max: 4, noNaN: true })
const share = fc.double({ min: 0, max: 1, noNaN: true })
const none: fc.Arbitrary<number> = fc.constant(1)
const layer = (name: FeatureName, passes = none): fc.Arbitrary<Layer> =>
  fc.record({ name: fc.constant(name), light: number, passes })
const opaque = new Set<FeatureName>(['moon', 'heightFog', 'distanceFog', 'clouds', 'drops'])
type Three<T> = [T, T, T]
const layersOf = (names: Readonly<Three<FeatureName>>): Three<fc.Arbitrary<Layer>> =>
  names.map(name => layer(name, opaque.has(name) ? share : none)) as Three<fc.Arbitrary<Layer>>

it.each([
  [['stars', 'airglow', 'drops']],
  [['stars', 'moon', 'distanceFog']],
  [['starsOverlay', 'heightFog', 'clouds']],
  [['heightFog', 'distanceFog', 'clouds']],
  [['milkyWay', 'clouds', 'drops']],
  [['airglow', 'lightning', 'drops']],
  [['moon', 'clouds', 'lightning']]
] satisfies [Three<FeatureName>][])('has what layered light amounts to in its range: %s', names => {
  fc.assert(
    fc.property(number, fc.boolean(), ...layersOf(names), (sky, isMeasured, ...chosen) => {
      const range = predict(sky, alone(sky, chosen, isMeasured), 1e-12)!
      const total = through(sky, chosen)
      expect(total).toBeGreaterThanOrEqual(range[0] - 1e-9)
      expect(total).toBeLessThanOrEqual(range[1] + 1e-9)
    })
  )
})

it.each([
  [['stars', 'airglow', 'drops']],
  [['stars', 'milkyWay', 'clouds']],
  [['starsOverlay', 'airglow', 'heightFog']],
  [['nightLight', 'moonlight', 'heightFog']],
  [['milkyWay', 'clouds', 'drops']]
] satisfies [Three<FeatureName>][])('tells a value where what covers is measured: %s', names => {
  fc.assert(
    fc.property(number, ...layersOf(names), (sky, ...chosen) => {
      const range = predict(sky, alone(sky, chosen, true), 1e-12)
      expect(isKnown(range, 1e-9)).toBe(true)
      expect(range![0]).toBeCloseTo(through(sky, chosen), 6)
      expect(range![1]).toBeCloseTo(through(sky, chosen), 6)
    })
  )
})

/** Clouds and fogs over a sky of 1, and what they pass. */
const cover = [
  ['clouds', 0.8, 0],
  ['clouds', 0.8, 0.02],
  ['clouds', 3, 0.3],
  ['heightFog', 1.2, 0.1],
  ['drops', 0.9, 0.5]
] as const

it.each(cover)('finds stars painted last over %s of %d that passes %d', (name, value, passes) => {
  for (const stars of ['starsOverlay', 'stars', 'milkyWay', 'moon'] as const) {
    const parts: Part[] = [
      { name: stars, value: 50, scattered: 0 },
      { name, value, passes: [passes, passes] }
    ]
    const range = predict(1, parts, 1e-6)!
    expect(isKnown(range, 1e-6)).toBe(true)
    expect(range[1]).toBeCloseTo(value + 49 * passes, 9)
    expect(range[1]).toBeLessThan(value + 49 - 0.03 * 50)
  }
})

it.each<[string, Range | null, boolean]>([
  ['nothing', null, false],
  ['any light', [0, Infinity], false],
  ['light of 3 or more', [3, Infinity], false],
  ['all that there may be', [Infinity, Infinity], false],
  ['from a tenth of a star to all of it', [5, 50], false],
  ['a third more or less', [2, 4], false],
  ['a seventh more or less', [1.75, 2.25], true],
  ['a value', [2, 2], true],
  ['black', [0, 1e-7], true]
])('takes %s for known or not', (_, range, isOne) => {
  expect(isKnown(range, 1e-6)).toBe(isOne)
})

it.each([
  // Without, alone, what is wrong: far before near.
  [
    'stars that shine through fog as before',
    1,
    [
      ['stars', 3],
      ['heightFog', 0.5]
    ],
    2.6
  ],
  [
    'stars before hills',
    1,
    [
      ['stars', 3],
      ['terrain', 0.4]
    ],
    2.4
  ],
  [
    'a flash that is twice as bright with stars',
    1,
    [
      ['stars', 2],
      ['lightning', 3]
    ],
    6
  ],
  [
    'moonlight that is dimmed where no corner is',
    1,
    [
      ['moonlight', 2],
      ['occlusion', 1]
    ],
    0.9
  ],
  [
    'two fogs that are less than either',
    1,
    [
      ['heightFog', 2],
      ['distanceFog', 3]
    ],
    1.5
  ],
  [
    'shade that does not follow stars',
    1,
    [
      ['stars', 2],
      ['shafts', 0.7]
    ],
    2
  ],
  [
    'rain that hides more than all',
    1,
    [
      ['nightLight', 2],
      ['drops', 0.8]
    ],
    0.7
  ]
] as const)('leaves out %s', (_, none, parts, wrong) => {
  const range = predict(
    none,
    parts.map(([name, value]) => ({ name, value })),
    1e-6
  )
  expect(range).not.toBeNull()
  expect(wrong < range![0] - 1e-3 || wrong > range![1] + 1e-3).toBe(true)
})

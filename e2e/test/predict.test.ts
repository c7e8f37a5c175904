import fc from 'fast-check'
import { expect, it } from 'vitest'
import { predict, type FeatureName, type Part } from '../gpu/harness/predict'

/** A feature's part of a pixel: light that it adds, and what it lets through of the light behind it. */
interface Layer {
  name: FeatureName
  light: number
  passes: number
}

/** Light of a pixel of the sky, far before near. */
const through = (sky: number, layers: readonly Layer[]): number =>
  layers.reduce((behind, { light, passes }) => behind * passes + light, sky)

const alone = (sky: number, layers: readonly Layer[]): Part[] =>
  layers.map(layer => ({ name: layer.name, value: through(sky, [layer]) }))

const number = fc.double({ min: 0, max: 4, noNaN: true })
const share = fc.double({ min: 0, max: 1, noNaN: true })
const none: fc.Arbitrary<number> = fc.constant(1)
const layer = (name: FeatureName, passes = none): fc.Arbitrary<Layer> =>
  fc.record({ name: fc.constant(name), light: number, passes })

it('has what layered light amounts to in its range', () => {
  const sets = [
    ['stars', 'airglow', 'drops'],
    ['stars', 'moon', 'distanceFog'],
    ['milkyWay', 'clouds', 'drops'],
    ['airglow', 'lightning', 'drops'],
    ['moon', 'clouds', 'lightning']
  ] as const
  const opaque = new Set<FeatureName>(['moon', 'distanceFog', 'clouds', 'drops'])
  for (const names of sets) {
    const layers = names.map(name => layer(name, opaque.has(name) ? share : none)) as [
      fc.Arbitrary<Layer>,
      fc.Arbitrary<Layer>,
      fc.Arbitrary<Layer>
    ]
    fc.assert(
      fc.property(number, ...layers, (sky, ...chosen) => {
        const range = predict(sky, alone(sky, chosen), 1e-9)
        if (range === null) return
        const total = through(sky, chosen)
        expect(total).toBeGreaterThanOrEqual(range[0] - 1e-9)
        expect(total).toBeLessThanOrEqual(range[1] + 1e-9)
      })
    )
  }
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

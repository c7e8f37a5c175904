import { CloudLayers, cloudQualities } from '@welkin/clouds'
import { expect, it } from 'vitest'
import { groundHeight } from '../src/valley/ground'
import { VIEWS } from '../src/valley/views'
import { valleyLayers, WeatherBlend, weathers } from '../src/valley/weather'

const qualityIn = (name: 'fair' | 'mist' | 'overcast'): (typeof cloudQualities)['medium'] => {
  const quality = new WeatherBlend(name).qualityOf('medium', true)
  return typeof quality === 'string' ? cloudQualities[quality] : quality
}

it('banks of fog take fewer steps than clouds, decks as many through their layer', () => {
  const { medium } = cloudQualities
  expect(qualityIn('fair')).toEqual(medium)
  expect(qualityIn('mist').layerSteps).toBeLessThan(0.5 * medium.layerSteps)
  expect(qualityIn('mist').layerSteps).toBeGreaterThan(4)
  expect(qualityIn('overcast').layerSteps).toBe(medium.layerSteps)
})

it('cumulus comes down while a low deck comes over it', () => {
  const blend = new WeatherBlend('fair')
  const layers = new CloudLayers(valleyLayers)
  const base = (): number => {
    blend.apply(layers, true, true, true, true)
    return layers.at(0).parameters.baseAltitude
  }
  const [fair, deck] = [base(), layers.at(1).parameters.baseAltitude]
  blend.set('overcast', false)
  blend.update(5)
  const between = base()
  blend.update(10)
  const low = base()
  expect(fair).toBeGreaterThan(between)
  expect(between).toBeGreaterThan(low)
  expect(layers.at(0).parameters.topAltitude).toBeLessThanOrEqual(deck)
})

it('the level at which snow melts comes down while a shower turns to snow, without a leap', () => {
  const blend = new WeatherBlend('shower')
  const layers = new CloudLayers(valleyLayers)
  blend.set('snow', false)
  const levels = Array.from({ length: 400 }, () => {
    blend.update(0.05)
    blend.apply(layers, true, true, true, true)
    return layers.at(1).parameters.precipitation?.freezingLevel ?? NaN
  }).filter(level => !Number.isNaN(level))
  const steps = levels.slice(1).map((level, i) => levels[i] - level)
  expect(Math.max(...steps)).toBeLessThan(100)
  expect(Math.min(...steps)).toBeGreaterThanOrEqual(0)
  expect(levels.at(-1)).toBe(0)
})

it.each([
  ['fair', 'overcast'],
  ['overcast', 'mist'],
  ['mist', 'storm']
] as const)('from %s to %s the march goes over to other steps bit by bit', (from, to) => {
  const blend = new WeatherBlend(from)
  const quality = (): typeof cloudQualities.medium => {
    const now = blend.qualityOf('medium', true)
    return typeof now === 'string' ? cloudQualities[now] : now
  }
  const before = quality()
  blend.set(to, false)
  const all = [before]
  while (blend.update(0.05)) all.push(quality())
  const leaps = (key: 'lightSteps' | 'depthStep' | 'layerSteps'): number =>
    Math.max(...all.slice(1).map((each, i) => Math.abs(each[key] - all[i][key])))
  expect(leaps('lightSteps')).toBeLessThanOrEqual(1)
  expect(leaps('layerSteps')).toBeLessThanOrEqual(1)
  expect(leaps('depthStep')).toBeLessThan(0.1)
  expect(new WeatherBlend(to).qualityOf('medium', true)).toEqual(all.at(-1))
  expect(all.at(-1)).not.toEqual(before)
})

it('clouds of a broken sky are over most of the mountains, and cumulus below the deck', () => {
  const layers = new CloudLayers(valleyLayers)
  new WeatherBlend('broken').apply(layers, true, true, true, true)
  const [cumulus, deck] = [0, 1].map(i => layers.at(i).parameters)
  let [above, all] = [0, 0]
  for (let x = -9000; x <= 9000; x += 450) {
    for (let z = -12_000; z <= 6000; z += 450) {
      all++
      if (600 + groundHeight(x, z) > cumulus.baseAltitude) above++
    }
  }
  expect(above / all).toBeLessThan(0.25)
  expect(cumulus.topAltitude).toBeLessThanOrEqual(deck.baseAltitude)
})

it('a storm goes dark bit by bit, below a deck without gaps, and rains from its towers', () => {
  const blend = new WeatherBlend('fair')
  const layers = new CloudLayers(valleyLayers)
  blend.set('storm', false)
  const exposures: number[] = []
  const densities: number[] = []
  do {
    blend.apply(layers, true, true, true, true)
    exposures.push(blend.current.exposure)
    densities.push(layers.at(1).parameters.density)
  } while (blend.update(0.1))
  blend.apply(layers, true, true, true, true)
  const steps = (values: number[]): number[] => values.slice(1).map((each, i) => each - values[i])
  expect(Math.max(...steps(exposures))).toBeLessThanOrEqual(0)
  expect(Math.min(...steps(exposures))).toBeGreaterThan(-0.05)
  expect(Math.min(...steps(densities))).toBeGreaterThanOrEqual(0)
  const [tower, deck] = [0, 1].map(i => layers.at(i).parameters)
  expect(exposures.at(-1)).toBeLessThan(-0.5)
  expect(deck.coverage).toBeGreaterThan(0.8)
  const rates = [tower, deck].map(({ precipitation }) => precipitation?.rate ?? 0)
  expect(rates[0]).toBeGreaterThan(5 * rates[1])
})

it('the view above the clouds is over those of fair weather', () => {
  const layers = new CloudLayers(valleyLayers)
  new WeatherBlend('fair').apply(layers, true, true, true, true)
  const [x, y, z] = VIEWS.above.position
  expect(600 + y).toBeGreaterThan(layers.at(0).parameters.topAltitude + 100)
  expect(y - groundHeight(x, z)).toBeGreaterThan(1000)
})

/** Display value of a grey by `photographicToneMapping`: AgX, then its S-curve, in sRGB. */
function shownGrey(light: number): number {
  const x = (Math.log2(light) + 12.47393) / 16.5
  const curve = [15.5, -40.14, 31.96, -6.868, 0.4298, 0.1191, -0.00232]
  const code = curve.reduce((sum, factor) => sum * x + factor, 0)
  const steep = code ** 1.5 / (code ** 1.5 + (1 - code) ** 1.5)
  const linear = (steep + 0.6 * (1 - code) * (code - steep)) ** 2.2
  return 1.055 * linear ** (1 / 2.4) - 0.055
}

it('an even picture, as of snow, is shown neither white nor dark in any weather', () => {
  for (const { exposure } of Object.values(weathers)) {
    const mean = shownGrey(0.17 * 2 ** exposure)
    expect(mean).toBeGreaterThan(0.2)
    expect(mean).toBeLessThan(0.5)
  }
})

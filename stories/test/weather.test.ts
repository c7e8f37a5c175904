import { cloudQualities } from '@welkin/clouds'
import { expect, it } from 'vitest'
import { WeatherBlend } from '../src/valley/weather'

const qualityIn = (name: 'fair' | 'mist' | 'overcast'): (typeof cloudQualities)['medium'] => {
  const quality = new WeatherBlend(name).qualityOf('medium', true)
  return typeof quality === 'string' ? cloudQualities[quality] : quality
}

it('banks of fog take fewer steps than clouds, decks as many through their layer', () => {
  const { medium } = cloudQualities
  expect(qualityIn('fair')).toEqual(medium)
  expect(qualityIn('mist').layerSteps).toBeLessThan(0.7 * medium.layerSteps)
  expect(qualityIn('mist').layerSteps).toBeGreaterThan(4)
  expect(qualityIn('overcast').layerSteps).toBe(medium.layerSteps)
})

import { expect, it } from 'vitest'
import { gpuText, lastFeature, sharesOf } from '../src/valley/shares'

const none = { antialiasing: 'none', bloom: false, motionBlur: false } as const

it('adds up the passes of a feature, the longest first', () => {
  const passes = [
    ['Welkin.CloudsMarch', 1],
    ['Welkin.CloudsShade', 0.5],
    ['output', 2],
    ['canvas', 0.1],
    ['Render Pipeline', 0.1]
  ] as const
  expect(sharesOf(passes, none)).toEqual([
    ['land, trees, village and lake, lit', 2],
    ['clouds and mist', 1.5],
    ['tone mapping', 0.2]
  ])
})

it('gives each post effect a share of its own, and leaves a pass that it does not know its name', () => {
  // Names as three r187 and `PictureFinish` give them.
  const features = {
    AO: 'ambient occlusion',
    Occlusion: 'ambient occlusion',
    'TRAA [ RTT ]': 'TRAA',
    TRAA: 'TRAA',
    'TAAU [ RTT ]': 'TAAU',
    'TAAU.seed': 'TAAU',
    'DoF [ RTT ]': 'depth of field',
    'DoF [ CoC Blur ]': 'depth of field',
    'SMAANode.weights': 'SMAA',
    'MotionBlur [ RTT ]': 'motion blur',
    'Motion [ RTT ]': 'velocity of sky and clouds',
    'Bloom [ High Pass ]': 'bloom',
    'Shown [ RTT ]': 'tone mapping',
    'Welkin.CloudFogLight': 'light of the mist',
    SkyLightMap: 'light of the sky on the land',
    'Welkin.CloudsUpscale': 'clouds and mist',
    'Welkin.CloudsFall': 'rain and snow under clouds',
    'Welkin.CloudsFallSpread': 'rain and snow under clouds',
    'Welkin.Precipitation.0': 'rain and snow around the camera',
    'Welkin.LightningGlow': 'lightning',
    'Welkin.PrecipitationSkylight.0': 'light of rain and snow',
    Else: 'Else'
  }
  for (const [pass, feature] of Object.entries(features)) {
    expect([pass, ...sharesOf([[pass, 1]], none)[0]]).toEqual([pass, feature, 1])
  }
})

it('names the last pass for what it draws', () => {
  expect(lastFeature(none)).toBe('tone mapping')
  expect(lastFeature({ ...none, antialiasing: 'smaa' })).toBe('SMAA')
  expect(lastFeature({ ...none, antialiasing: 'fxaa', motionBlur: true })).toBe('FXAA')
  expect(lastFeature({ ...none, motionBlur: true })).toBe('motion blur and tone mapping')
  // Bloom reads the blurred picture, which then has a pass of its own.
  expect(lastFeature({ ...none, motionBlur: true, bloom: true })).toBe('tone mapping')
})

it('says how long frames take, by feature, or that the browser keeps no times once that is known', () => {
  const passes = [
    ['output', 3],
    ['Welkin.CloudsMarch', 1]
  ] as const
  const shares = 'land, trees, village and lake, lit 1.50\nclouds and mist 0.50'
  expect(gpuText(passes, 2, 9, none)).toBe(` · GPU 2.0 ms\n${shares}`)
  expect(gpuText([], 0, 1, none)).toBe('')
  expect(gpuText([], 0, 9, none)).toContain('no GPU times')
})

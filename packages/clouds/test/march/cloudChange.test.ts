import { Atmosphere, type AtmosphereView } from '@welkin/atmosphere'
import { Matrix3, PerspectiveCamera, Vector3 } from 'three'
import { float, vec4 } from 'three/tsl'
import { expect, test } from 'vitest'
import { cloudPreset, CloudLayers, clouds } from '../../src'
import { FrameUniforms } from '../../src/march/FrameUniforms'

/** Frames of layers that may be changed between them: whether they have history, and its tolerance. */
function framesOf(
  layers: CloudLayers,
  up = new Vector3(0, 0, 1),
  frames = new FrameUniforms()
): () => { hasHistory: number; steadiness: number } {
  const atmosphere = new Atmosphere()
  const camera = new PerspectiveCamera()
  // Clouds that need no noise are there at once.
  const extinction = () => float(0)
  const { field } = clouds(vec4(0), float(0), camera, atmosphere, layers, { extinction })
  const view = {
    atmosphere,
    camera,
    height: 2,
    up,
    lightDirection: new Vector3(0, 0, 1),
    viewToMapped: new Matrix3()
  } as unknown as AtmosphereView
  return () => {
    field.update(view, 0)
    frames.next(camera, view, field, 5, true)
    return { hasHistory: frames.hasHistory.value, steadiness: frames.steadiness.value }
  }
}

test('weather that is changed at once leaves no history, and what follows has its whole tolerance', () => {
  const changes: ((layers: CloudLayers) => void)[] = [
    layers => layers.copy(cloudPreset('cumulonimbus')),
    layers => layers.copy(cloudPreset('cirrus')),
    layers => layers.at(0).set({ coverage: 0.6 }),
    layers => layers.at(0).set({ baseAltitude: 1500 }),
    layers => layers.at(0).set({ density: 0.01 }),
    layers => layers.at(0).set({ shapeAmount: 0.1 })
  ]
  for (const change of changes) {
    const layers = new CloudLayers([...cloudPreset('fairWeather')], 2)
    const next = framesOf(layers)
    next()
    expect(next()).toEqual({ hasHistory: 1, steadiness: 1 })
    change(layers)
    expect(next().hasHistory).toBe(0)
    expect(next()).toEqual({ hasHistory: 1, steadiness: 1 })
  }
})

test('weather that changes slowly keeps its history, and nearly all of its tolerance', () => {
  const layers = cloudPreset('fairWeather')
  const next = framesOf(layers)
  next()
  // Half of the sky in half a minute: a second of it.
  for (let frame = 1; frame <= 60; frame++) {
    layers.at(0).set({ coverage: 0.3 + frame / 3600 })
    const { hasHistory, steadiness } = next()
    expect(hasHistory).toBe(1)
    expect(steadiness).toBeGreaterThan(0.9)
  }
  // A hand on a control, which would go from end to end in a second, and then rests.
  for (let frame = 1; frame <= 20; frame++) {
    layers.at(0).set({ coverage: 0.32 + frame / 60 })
    expect(next().hasHistory).toBe(1)
  }
  expect(next().steadiness).toBeLessThan(0.1)
  for (let frame = 0; frame < 100; frame++) next()
  expect(next().steadiness).toBeGreaterThan(0.9)
})

test('layers that cover nothing may become anything', () => {
  const layers = new CloudLayers([{}, { coverage: 0 }])
  const next = framesOf(layers)
  next()
  layers.at(1).set({ baseAltitude: 9000, topAltitude: 10_000, density: 0.001 })
  expect(next()).toEqual({ hasHistory: 1, steadiness: 1 })
})

test('history is whole again as soon as the camera rests, but not after a change of the clouds', () => {
  const layers = cloudPreset('fairWeather')
  const up = new Vector3(0, 0, 1)
  const frames = new FrameUniforms()
  const next = framesOf(layers, up, frames)
  for (let frame = 0; frame < 9; frame++) next()
  const still = frames.maxSamples.value
  up.set(1e-6, 0, 1).normalize()
  next()
  expect(frames.maxSamples.value).toBeLessThan(still / 9)
  next()
  expect(frames.maxSamples.value).toBe(still)
  layers.at(0).set({ density: 0.0999 })
  for (let frame = 0; frame < 9; frame++) next()
  expect(frames.maxSamples.value).toBeLessThan(still / 9)
})

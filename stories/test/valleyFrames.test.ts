import { SurfaceWater } from '@welkin/atmosphere'
import type { WebGPURenderer } from 'three/webgpu'
import { expect, it, vi } from 'vitest'
import { LakeMirror } from '../src/valley/LakeMirror'
import { litOf } from '../src/valley/litLights'
import { LocalExposure } from '../src/valley/LocalExposure'
import { openingState } from '../src/valley/openingState'
import { SkyLightMap } from '../src/valley/SkyLightMap'
import { StreetLamps } from '../src/valley/StreetLamps'
import { Valley, type ValleyState } from '../src/valley/Valley'

// Frames that draw nothing: switches that take effect with the next one.
const renderer = { initRenderTarget: () => undefined } as unknown as WebGPURenderer
const mirror = vi.spyOn(LakeMirror.prototype, 'scaleTo')
const isMirrorOn = (): boolean => (mirror.mock.contexts[0] as LakeMirror).isOn
const lamps = vi.spyOn(StreetLamps.prototype, 'light')
const lampsNow = (): number => lamps.mock.lastCall![0]
const water = vi.spyOn(SurfaceWater.prototype, 'update')
const groundCover = (): number => (water.mock.contexts[0] as SurfaceWater).snow
vi.spyOn(LocalExposure.prototype, 'update').mockReturnValue(undefined)
vi.spyOn(SkyLightMap.prototype, 'update').mockReturnValue(undefined)
vi.spyOn(LakeMirror.prototype, 'update').mockReturnValue(undefined)
const valley = new Valley(renderer, { ...openingState, quality: 'low' })
const { air, atmosphere, pipeline } = valley
pipeline.render = () => {}
// As of a picture that is darker than the last.
air.exposure.adapt = () => void (atmosphere.luminanceScale *= 1.5)

/** Shares of moon, lamps, shadows and exposure as frames have them, by night. */
function frameOf(changes: Partial<ValleyState>) {
  const date = Date.UTC(2026, 8, 26) // a full moon
  valley.set({ ...openingState, quality: 'low', date, hour: 23, ...changes }, true)
  const scale = atmosphere.luminanceScale
  valley.render(0)
  const [, moonlight] = air.directLights
  return {
    moonlight: litOf(moonlight).value,
    shadows: moonlight.shadow.intensity,
    lamps: lampsNow(),
    autoExposure: Number(atmosphere.luminanceScale !== scale),
    reflections: Number(isMirrorOn())
  }
}

it.each(['moonlight', 'shadows', 'lamps', 'autoExposure', 'reflections'] as const)(
  '%s of a night: frames are without, and with it again',
  name => {
    expect(frameOf({ [name]: true })[name]).toBe(1)
    expect(frameOf({ [name]: false })[name]).toBe(0)
    expect(frameOf({ [name]: true })[name]).toBe(1)
  }
)

it('has lightning in storms, where it was asked for', () => {
  const isStruck = (changes: Partial<ValleyState>): boolean => {
    valley.set({ ...openingState, flashes: true, quality: 'low', ...changes }, true)
    return valley.storm.enabled
  }
  expect(isStruck({ weather: 'fair' })).toBe(false)
  expect(isStruck({ weather: 'storm' })).toBe(true)
  expect(isStruck({ weather: 'storm', clouds: false })).toBe(false)
  // Switched while it is shown.
  expect(isStruck({ weather: 'storm', flashes: false })).toBe(false)
  expect(isStruck({ weather: 'storm' })).toBe(true)
})

it('has the ground wet or white only where that is on', () => {
  const cover = (wetGround: boolean): number => {
    valley.set({ ...openingState, quality: 'low', weather: 'snow', wetGround }, true)
    return groundCover()
  }
  expect(cover(true)).toBeGreaterThan(0)
  expect(cover(false)).toBe(0)
  expect(cover(true)).toBeGreaterThan(0)
})

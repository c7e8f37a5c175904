import { Atmosphere, moon, NIGHT_ILLUMINANCE, SkyLightProbe } from '@welkin/atmosphere'
import type { AtmosphereView } from '@welkin/atmosphere'
import { Matrix3, PerspectiveCamera, Vector3 } from 'three'
import { float, vec4 } from 'three/tsl'
import type { Renderer } from 'three/webgpu'
import { describe, expect, test, vi } from 'vitest'
import {
  CloudField,
  cloudEnvironment,
  CloudLayers,
  clouds,
  cloudShadow,
  cloudSkyLight
} from '../../src'
import { FrameUniforms } from '../../src/march/FrameUniforms'
import { NightLight, nightGain } from '../../src/light/NightLight'

const atmosphere = new Atmosphere()
const camera = new PerspectiveCamera()
const node = clouds(vec4(0), float(0), camera, atmosphere, new CloudLayers())
const radius = atmosphere.parameters.bottomRadius
const degrees = Math.PI / 180

/** View as the night needs it, with the sun at an elevation [°]. */
const viewAt = (elevation: number, height = 2, world = atmosphere): AtmosphereView => {
  const angle = elevation * degrees
  const view: Partial<AtmosphereView> = {
    atmosphere: world,
    camera,
    height,
    up: new Vector3(0, 0, 1),
    lightDirection: new Vector3(Math.cos(angle), 0, Math.sin(angle))
  }
  return view as AtmosphereView
}

describe('NightLight', () => {
  test('is left out while no place that can be seen is dark', () => {
    const night = new NightLight()
    const isSeen = (elevation: number, height: number): boolean => {
      night.update(viewAt(elevation, height))
      return night.isVisible.value === 1
    }
    expect(isSeen(1, 2)).toBe(false)
    expect(isSeen(-7, 2)).toBe(true)
    // 400 km up the horizon is 20° down, and clouds beyond it another 5.6°.
    expect(isSeen(18, 4e5)).toBe(true)
    expect(isSeen(22, 4e5)).toBe(false)
    expect(isSeen(80, 3.6e7)).toBe(true)
  })

  test('sets in where the sun’s light reaches no cloud, on small planets too', () => {
    const night = new NightLight()
    night.update(viewAt(-20))
    expect(Math.asin(night.nightfall.value) / degrees).toBeCloseTo(-6, 6)
    expect(Math.asin(night.deepNight.value) / degrees).toBeCloseTo(-8, 6)
    // Of the highest clouds, and half of the sun's disc.
    const lowest = -Math.acos(radius / (radius + 30_000)) - atmosphere.parameters.sunAngularRadius
    expect(Math.asin(night.nightfall.value)).toBeLessThan(lowest)
  })

  test('takes moonlight from a moon that was added, and none by day', () => {
    const world = new Atmosphere()
    const luna = moon({ direction: new Vector3(0, 1, 0), phase: 0.5 }).attach(world)
    const night = new NightLight()
    night.update(viewAt(-20, 2, world))
    expect(night.source).toBe(null)
    expect(night.moonIrradiance.value.length()).toBe(0)
    world.add(luna)
    night.update(viewAt(-20, 2, world))
    expect(night.source).toBe(luna.source)
    expect(night.moonIrradiance.value.toArray()).toEqual([
      ...luna.source.irradianceAt(new Vector3())
    ])
    expect(night.isMoonlitAt(viewAt(-20, 2, world))).toBe(true)
    expect(night.isMoonlitAt(viewAt(-5, 2, world))).toBe(false)
    night.update(viewAt(20, 2, world))
    expect(night.moonIrradiance.value.length()).toBe(0)
    expect(night.isMoonlitAt(viewAt(20, 2, world))).toBe(false)
  })
})

test('clouds grow when their noise was drawn over frames, and are there when it was drawn at once', () => {
  const layers = new CloudLayers([{ coverage: 0.6 }])
  const view = viewAt(50)
  for (const [slices, shares] of [
    [24, [1 / 48, 2 / 48, 48 / 48, 1]],
    [Infinity, [1, 1, 1, 1]]
  ] as const) {
    const field = new CloudField(atmosphere, layers)
    const isReady = vi.spyOn(field.noise, 'isReady', 'get').mockReturnValue(false)
    vi.spyOn(field.noise, 'update').mockReturnValue(true)
    const coverageAfter = (frames: number): number => {
      for (let i = 0; i < frames; i++) {
        field.bake({} as Renderer, slices)
        field.update(view, 0)
      }
      return field.values[0].z
    }
    expect(coverageAfter(3)).toBe(0)
    isReady.mockReturnValue(true)
    const grown = [1, 1, 46, 5].map(coverageAfter)
    grown.forEach((coverage, i) => expect(coverage).toBeCloseTo(0.6 * shares[i], 9))
    expect(grown[3]).toBe(0.6)
    field.dispose()
  }
})

test('light is raised as deep as night is at the lightest place in sight', () => {
  expect(nightGain(viewAt(30), radius)).toBe(1)
  expect(nightGain(viewAt(-40), radius)).toBeCloseTo(1e5, 3)
  // From 400 km the terminator is seen 20° away.
  expect(nightGain(viewAt(-15, 4e5), radius)).toBe(1)
  expect(nightGain(viewAt(-60, 4e5), radius)).toBeCloseTo(1e5, 3)
})

test('a picture forgets the light of before at motion’s pace, then rests; another light starts anew', () => {
  const frames = new FrameUniforms()
  node.field.radius.value = radius
  const next = (elevation: number): { samples: number; hasHistory: number } => {
    const view = Object.assign(viewAt(elevation), { viewToMapped: new Matrix3() })
    node.field.night.update(view)
    frames.next(camera, view, node.field, 2, true)
    return { samples: frames.maxSamples.value, hasHistory: frames.hasHistory.value }
  }
  expect(next(50).hasHistory).toBe(0)
  const rest = next(50)
  expect(rest.hasHistory).toBe(1)
  expect(next(40).samples).toBeLessThan(rest.samples / 10)
  // Twelve samples of each of four pixels.
  for (let frame = 1; frame < 48; frame++) expect(next(40).samples).toBeLessThan(rest.samples / 10)
  expect(next(40)).toEqual(rest)
  expect(next(-40).hasHistory).toBe(0)
  expect(next(-40)).toEqual(rest)
})

test('nightIlluminance is that of the night’s probe, and may be set', () => {
  expect(node.nightIlluminance).toBe(NIGHT_ILLUMINANCE)
  expect(() => (node.nightIlluminance = NaN)).toThrow(
    'CloudsNode: nightIlluminance must be finite and ≥ 0, got NaN'
  )
  node.nightIlluminance = 0
  expect(node.nightIlluminance).toBe(0)
})

describe('cloudSkyLight', () => {
  test('refuses what is missing or of the wrong kind', () => {
    const probe = new SkyLightProbe(atmosphere)
    expect(() => cloudSkyLight(null as never, node)).toThrow('CloudSkyLight: probe must be')
    expect(() => cloudSkyLight(probe, {} as never)).toThrow('CloudSkyLight: clouds must be')
    expect(() => cloudSkyLight(new SkyLightProbe(new Atmosphere()), node)).toThrow(
      "CloudSkyLight: clouds must be in the probe's atmosphere"
    )
  })

  test('leaves the probe as it was', () => {
    const probe = new SkyLightProbe(atmosphere)
    const light = cloudSkyLight(probe, node)
    expect(probe.overcast).not.toBe(null)
    expect(() => (light.strength = 2)).toThrow('CloudSkyLight: strength must be in [0, 1]')
    light.dispose()
    expect(probe.overcast).toBe(null)
    expect(light.strength).toBe(0)
  })
})

describe('cloudEnvironment', () => {
  test('refuses what is missing or out of range', () => {
    expect(() => cloudEnvironment(null as never)).toThrow(
      'CloudEnvironment: clouds must be a CloudsNode'
    )
    expect(() => cloudEnvironment(node, { size: 8 })).toThrow('CloudEnvironment: size must be')
    expect(() => cloudEnvironment(node, { drift: 0 })).toThrow(
      'CloudEnvironment: drift must be positive'
    )
    expect(() => cloudEnvironment(node, { quality: 'best' as never })).toThrow(
      /quality must be 'low', .* got 'best'/
    )
  })

  test('has nothing drawn at first', () => {
    const overlay = cloudEnvironment(node)
    expect(overlay.version).toBe(1)
    expect(overlay.version).toBe(1)
    overlay.dispose()
  })
})

test('shadows of moonlight need a source of light', () => {
  expect(() => cloudShadow(node, null, {} as never)).toThrow(
    'CloudShadowNode: source must be a LightSource'
  )
  const luna = moon().attach(atmosphere)
  expect(cloudShadow(node, null, luna.source).source).toBe(luna.source)
  expect(cloudShadow(node).source).toBe(atmosphere.sun)
})

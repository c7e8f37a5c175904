import {
  airglow,
  Atmosphere,
  exposureFor,
  milkyWay,
  moon,
  MoonDirectionalLight,
  NightLightProbe,
  SkyLightProbe,
  stars
} from '@welkin/atmosphere'
import { CloudCover, cloudPreset, clouds, CloudShadowNode } from '@welkin/clouds'
import { Ellipsoid } from '@welkin/geo'
import { PerspectiveCamera } from 'three'
import { expect, it } from 'vitest'
import { float, vec4 } from 'three/tsl'
import { townShares } from '../src/globe/cityLights'
import { GlobeNight, type Night } from '../src/globe/GlobeNight'
import { shadeNight, showClouds } from '../src/globe/worldClouds'
import type { GlobeArgs } from '../src/globe.scene'
import * as stories from '../src/globe.stories'

/** Sky and lights of a night. */
function nightOf(atmosphere: Atmosphere): Night {
  const luna = moon()
  return {
    sky: [milkyWay(), stars(), luna, airglow()],
    lights: [
      new MoonDirectionalLight(atmosphere, luna),
      new SkyLightProbe(atmosphere, luna.source),
      new NightLightProbe(atmosphere)
    ]
  }
}

/** A camera in the middle of a town [m]. */
function cameraAt(height: number): PerspectiveCamera {
  const camera = new PerspectiveCamera()
  Ellipsoid.WGS84.geodeticToECEF({ longitude: 0, latitude: 30, height }, camera.position)
  camera.updateMatrixWorld()
  return camera
}

it('has stars, moon and airglow in a night as they were switched before it fell, and after', () => {
  const atmosphere = new Atmosphere({ frame: 'ecef' })
  const camera = cameraAt(10)
  const { sky, lights } = nightOf(atmosphere)
  let nights = 0
  const night = new GlobeNight(atmosphere, () => {
    nights++
    return { sky, lights }
  })
  const strengths = (): number[] => {
    const [galaxy, starlight, luna, glow] = sky
    return [galaxy.intensity, starlight.intensity, luna.strength, glow.intensity]
  }
  night.show({ stars: false, moon: false, airglow: true })
  atmosphere.date = new Date('2026-06-21T12:00:00Z')
  night.update(camera)
  expect(nights).toBe(0)
  atmosphere.date = new Date('2026-06-21T23:59:00Z')
  night.update(camera)
  night.update(camera)
  expect(nights).toBe(1)
  expect(strengths()).toEqual([0, 0, 0, 1])
  night.show({ stars: true, moon: true, airglow: false })
  expect(strengths()).toEqual([1, 1, 1, 0])
  night.dispose()
  atmosphere.dispose()
})

it('falls earlier under clouds', () => {
  const atmosphere = new Atmosphere({ frame: 'ecef' })
  const camera = cameraAt(10)
  /** Minutes after 18:00 at which it falls. */
  const dusk = (cover: CloudCover | null): number => {
    let isNight = false
    const fall = (): Night => {
      isNight = true
      return nightOf(atmosphere)
    }
    const night = new GlobeNight(atmosphere, fall, cover)
    for (let minute = 0; minute < 180; minute++) {
      atmosphere.date = new Date(Date.UTC(2026, 5, 21, 18, minute))
      night.update(camera)
      if (isNight) return minute
    }
    return Infinity
  }
  const clear = dusk(null)
  // The sun sets there at 19:03.
  expect(clear).toBeGreaterThan(45)
  expect(clear).toBeLessThan(75)
  expect(dusk(new CloudCover(cloudPreset('overcast')))).toBeLessThan(clear)
  atmosphere.dispose()
})

it('has clouds that go and come while the scene runs, and are not there for exposure then', () => {
  const layers = cloudPreset('mixed')
  const coverages = [...layers].map(({ coverage }) => coverage)
  const cover = new CloudCover(layers)
  const atmosphere = new Atmosphere({ frame: 'ecef' })
  atmosphere.date = new Date('2026-06-21T12:00:00Z')
  const exposure = () => exposureFor(atmosphere, cameraAt(10), { clouds: cover })
  const clouded = exposure()
  showClouds(layers, coverages, false)
  expect([...layers].map(({ coverage }) => coverage)).toEqual([0, 0, 0])
  expect(exposure()).toBeCloseTo(exposureFor(atmosphere, cameraAt(10)), 6)
  showClouds(layers, coverages, true)
  expect([...layers].map(({ coverage }) => coverage)).toEqual(coverages)
  expect(exposure()).toBe(clouded)
  atmosphere.dispose()
})

it('has clouds in all stories of nights, on the path that makes no new scene for them', () => {
  const nights = Object.entries(stories).filter(([name]) => name.startsWith('Night'))
  expect(nights).toHaveLength(4)
  for (const [, { args }] of nights as [string, { args: GlobeArgs }][]) {
    expect(args).toMatchObject({ clouds: true, path: 'post' })
  }
})

it('has its moonlight and the light of its sky dimmed by clouds', () => {
  const atmosphere = new Atmosphere({ frame: 'ecef' })
  const node = clouds(vec4(0), float(1), cameraAt(10), atmosphere, cloudPreset('mixed'))
  const { lights } = nightOf(atmosphere)
  shadeNight(node, lights)
  const [moonlight, ...probes] = lights
  const { shadowNode } = moonlight.shadow as unknown as { shadowNode: CloudShadowNode }
  expect(moonlight.castShadow).toBe(true)
  expect(shadowNode).toBeInstanceOf(CloudShadowNode)
  expect(shadowNode.source).toBe(moonlight.source)
  expect(shadowNode.shadowNode).toBeNull()
  for (const { overcast } of probes) expect(overcast).not.toBeNull()
  node.dispose()
  atmosphere.dispose()
})

it('has towns where a picture of the night is yellow, not where it is blue', () => {
  const [black, sea, desert, town, city] = [
    [0, 0, 0],
    [4, 18, 48],
    [30, 60, 84],
    [120, 90, 60],
    [255, 230, 190]
  ].map(([r, g, b]) => townShares([r, g, b, 255])[0])
  expect([black, sea, desert]).toEqual([0, 0, 0])
  expect(town).toBeGreaterThan(20)
  expect(city).toBeGreaterThan(2 * town)
})

import {
  airglow,
  Atmosphere,
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
import { GlobeNight, type Night } from '../src/globe/GlobeNight'
import { shadeNight } from '../src/globe/worldClouds'

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

it('is exposed for what clouds let through', () => {
  const atmosphere = new Atmosphere({ frame: 'ecef' })
  atmosphere.date = new Date('2026-06-21T18:58:00Z')
  const camera = cameraAt(10)
  const scaleUnder = (cover: CloudCover | null): number => {
    const night = new GlobeNight(atmosphere, () => nightOf(atmosphere), cover)
    night.update(camera)
    night.dispose()
    return atmosphere.luminanceScale
  }
  const clear = scaleUnder(null)
  expect(clear).toBeGreaterThan(1e-4)
  expect(scaleUnder(new CloudCover(cloudPreset('overcast')))).toBeGreaterThan(1.5 * clear)
  atmosphere.dispose()
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

import {
  aerialPerspectiveFog,
  Atmosphere,
  skyBackground,
  SkyLightProbe,
  SunDirectionalLight
} from '@welkin/atmosphere'
import type { Scene } from 'three'

/** Sky, haze, sunlight and sky light for a scene: what {@link quickStart} made. */
export interface QuickStart {
  atmosphere: Atmosphere
  sun: SunDirectionalLight
  sky: SkyLightProbe
}

/** The lines of the README's quick start that give a scene its air; a test holds the two together. */
export function quickStart(scene: Scene): QuickStart {
  // #region quick start
  const atmosphere = new Atmosphere() // the Earth's, for a Y-up scene in metres
  atmosphere.place({ longitude: 139.77, latitude: 35.68 }) // degrees
  atmosphere.date = new Date('2026-06-21T07:00:00Z') // the sun follows

  const sun = new SunDirectionalLight(atmosphere, 50) // 50 m from its target
  const sky = new SkyLightProbe(atmosphere)
  sun.castShadow = true
  scene.add(sun, sun.target, sky)
  scene.backgroundNode = skyBackground(atmosphere)
  scene.fogNode = aerialPerspectiveFog(atmosphere)
  // #endregion
  return { atmosphere, sun, sky }
}

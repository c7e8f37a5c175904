import {
  airglow,
  milkyWay,
  moon,
  MoonDirectionalLight,
  NightLightProbe,
  SkyLightProbe,
  stars,
  sunFlare,
  type Atmosphere
} from '@welkin/atmosphere'
import { cloudSkyLight, type CloudsNode } from '@welkin/clouds'
import type { Scene } from 'three'

/**
 * Adds stars, Milky Way, moon and airglow with their light, and the sun's halo.
 *
 * @param clouds - Clouds that dim that light.
 * @returns Lights, to be freed with the scene.
 */
export function addNightSky(
  scene: Scene,
  atmosphere: Atmosphere,
  clouds?: CloudsNode
): readonly { dispose(): void }[] {
  // #region night
  const luna = moon()
  atmosphere.add(milkyWay(), stars(), luna, airglow(), sunFlare()) // far before near
  const moonlight = new MoonDirectionalLight(atmosphere, luna)
  const moonlitSky = new SkyLightProbe(atmosphere, luna.source)
  const night = new NightLightProbe(atmosphere)
  scene.add(moonlight, moonlight.target, moonlitSky, night)
  // #endregion
  if (clouds) for (const sky of [moonlitSky, night]) cloudSkyLight(sky, clouds)
  return [moonlight, moonlitSky, night]
}

import {
  aerialPerspective,
  Atmosphere,
  autoExposure,
  lightShafts,
  MoonDirectionalLight,
  NightLightProbe,
  SkyLightProbe,
  standardEarthParameters,
  sunFlare,
  SunDirectionalLight
} from '@welkin/atmosphere'
import type {
  Airglow,
  AutoExposureNode,
  LightShafts,
  MilkyWay,
  Moon,
  Stars,
  SunFlare
} from '@welkin/atmosphere'
import { cloudAirShadow, clouds, cloudShadow, cloudSkyLight } from '@welkin/clouds'
import type { CloudLayers, CloudQuality, CloudQualityName, CloudsNode } from '@welkin/clouds'
import type { PerspectiveCamera, Scene } from 'three'
import type { CSMShadowNode } from 'three/addons/csm/CSMShadowNode.js'
import { BasicShadowFilter, isBackgroundDepth, pass, shadow, vec4 } from 'three/tsl'
import type { Node, PassNode, TextureNode } from 'three/webgpu'
import { Cascades } from './valley/Cascades'
import { SKY_DEPTH } from './valley/LakeMirror'
import type { ValleyPrecipitation } from './valley/falling'
import { PictureNode } from './valley/PictureNode'

/** Sky, light, clouds and shadows of a scene, exposed. */
export interface ValleyAir {
  readonly atmosphere: Atmosphere
  /** The scene without air, and its depth. */
  readonly scenePass: PassNode
  readonly depth: TextureNode
  readonly clouds: CloudsNode
  readonly shafts: LightShafts
  readonly flare: SunFlare
  readonly cascades: CSMShadowNode
  /** Sunlight and moonlight. */
  readonly directLights: readonly [SunDirectionalLight, MoonDirectionalLight]
  /** Light of the sky in sunlight. */
  readonly daySky: SkyLightProbe
  /** Light of the sky in moonlight, and of stars and airglow. */
  readonly nightSky: readonly [SkyLightProbe, NightLightProbe]
  /** The finished picture, with the distance along the camera's axis in alpha. */
  readonly picture: PictureNode
  /** The finished picture, exposed. */
  readonly exposure: AutoExposureNode
  /** Frees the lights and their shadows. */
  dispose(): void
}

/** Draws a picture to a texture, with the distance along the camera's axis in alpha: of the sky, the greatest. */
export function withDepth(picture: Node, scenePass: PassNode): PictureNode {
  const depth = scenePass.getViewZNode().negate().min(SKY_DEPTH)
  return new PictureNode('Picture', vec4((picture as Node<'vec4'>).rgb, depth))
}

/** Colour of a pass where it has drawn, elsewhere nothing: its texture need not be cleared, which would cost each pixel. */
export function drawnOf(scenePass: PassNode): Node<'vec4'> {
  const color = scenePass.getTextureNode() as unknown as Node<'vec4'>
  const { r } = scenePass.getTextureNode('depth') as unknown as Node<'vec4'>
  return isBackgroundDepth(r).select(vec4(0), color)
}

/** All of the sky by day and night, with clouds that cast shadows on the ground and in the air. */
export function valleyAir(
  scene: Scene,
  camera: PerspectiveCamera,
  layers: CloudLayers,
  quality: CloudQualityName | CloudQuality,
  [galaxy, starlight, glow, luna]: readonly [MilkyWay, Stars, Airglow, Moon],
  falling: ValleyPrecipitation
): ValleyAir {
  // #region sky and light
  // #shown import { airglow, milkyWay, moon, stars } from '@welkin/atmosphere'
  // #shown const [galaxy, starlight, glow, luna] = [milkyWay(), stars(), airglow(), moon()]
  const atmosphere = new Atmosphere({ parameters: standardEarthParameters() })
  const flare = sunFlare()
  atmosphere.add(galaxy, starlight, luna, glow, flare) // far before near
  const sun = new SunDirectionalLight(atmosphere, 6000) // 6 km from its target: over the mountains
  const sky = new SkyLightProbe(atmosphere)
  const moonlight = new MoonDirectionalLight(atmosphere, luna, 6000)
  const moonlitSky = new SkyLightProbe(atmosphere, luna.source)
  const night = new NightLightProbe(atmosphere)
  scene.add(sun, sun.target, sky, moonlight, moonlight.target, moonlitSky, night)
  sun.castShadow = moonlight.castShadow = true
  // #endregion
  sun.shadow.mapSize.setScalar(2048)
  sun.shadow.camera.far = 40_000 // as deep as cascades are wide, and the mountains before them

  const cascades = new Cascades(sun, {
    cascades: 3,
    maxFar: 9000,
    lightMargin: 8000,
    mode: 'custom',
    customSplitsCallback: (_cascades, _near, _far, breaks) => void breaks.push(0.03, 0.17, 1)
  })

  // #region everything
  // #shown import { cloudPreset, precipitationShafts } from '@welkin/clouds'
  // #shown import { RenderPipeline } from 'three/webgpu'
  // #shown const layers = cloudPreset('fairWeather')
  const scenePass = pass(scene, camera, { samples: 0 })
  const depth = scenePass.getTextureNode('depth')
  const shafts = lightShafts(atmosphere, camera, sun)
  // #shown const color = scenePass.getTextureNode()
  const color = drawnOf(scenePass) // #hidden
  const air = aerialPerspective(color, depth, camera, atmosphere, { shafts })
  // #shown const precipitation = precipitationShafts() // rain and snow under clouds
  const precipitation = falling.shafts // #hidden
  // #shown const node = clouds(air, depth, camera, atmosphere, layers, { precipitation })
  const node = clouds(air, depth, camera, atmosphere, layers, { quality, precipitation }) // #hidden
  // #shown Object.assign(sun.shadow, { shadowNode: cloudShadow(node, shadow(sun)) })
  Object.assign(sun.shadow, { shadowNode: cloudShadow(node, cascades) }) // #hidden
  const ofMoon = cloudShadow(node, shadow(moonlight), luna.source)
  Object.assign(moonlight.shadow, { shadowNode: ofMoon, filterNode: BasicShadowFilter })
  for (const each of [sky, moonlitSky, night]) cloudSkyLight(each, node)
  shafts.add(cloudAirShadow(node)) // clouds cast their shadows into the air
  // #shown const exposure = autoExposure(node, atmosphere) // as bright as what the camera sees
  // #shown const pipeline = new RenderPipeline(renderer)
  // #shown pipeline.outputNode = exposure
  // #endregion
  const lights = [sun, sky, moonlight, moonlitSky, night]
  const around = falling.over(node, depth, camera, atmosphere, lights)
  const picture = withDepth(around, scenePass) // drawn once, for exposure and the lake's mirror
  const exposure = autoExposure(picture, atmosphere)
  return {
    atmosphere,
    scenePass,
    depth,
    clouds: node,
    shafts,
    flare,
    cascades,
    directLights: [sun, moonlight],
    daySky: sky,
    nightSky: [moonlitSky, night],
    picture,
    exposure,
    dispose() {
      for (const light of lights) light.dispose()
      picture.dispose()
      cascades.dispose()
    }
  }
}

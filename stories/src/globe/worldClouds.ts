import type { MoonDirectionalLight, NightLightProbe, SkyLightProbe } from '@welkin/atmosphere'
import {
  CloudCover,
  cloudPreset,
  cloudQualities,
  clouds,
  cloudShadow,
  cloudSkyLight,
  cloudWorldMap
} from '@welkin/clouds'
import type { CloudLayers, CloudsNode } from '@welkin/clouds'
import { shadow } from 'three/tsl'
import { cloudCover } from '../clouds/cloudCover'
import { STILL_QUALITY } from '../clouds/still'
import type { Land } from './land'

/** Lights of a night: of the moon, of the sky that it lights, and of all else in the sky. */
type NightLights = readonly [MoonDirectionalLight, SkyLightProbe, NightLightProbe]

/** The world's clouds, and what they do to light. */
interface WorldClouds {
  /** The picture with clouds. */
  readonly node: CloudsNode
  /** Clears the sky, or has it as it was; nothing is compiled. */
  show(areShown: boolean): void
  /** Their mean, for exposure. */
  readonly cover: CloudCover
  /** Dims the lights of a night; before these first light anything. */
  shade(lights: NightLights): void
  dispose(): void
}

/** Has clouds dim the lights of a night: they cast no other shadows, whose maps would be of all that is in sight. */
export function shadeNight(node: CloudsNode, [moonlight, ...probes]: NightLights): void {
  moonlight.castShadow = true
  Object.assign(moonlight.shadow, { shadowNode: cloudShadow(node, null, moonlight.source) })
  for (const probe of probes) cloudSkyLight(probe, node)
}

/** Shows clouds of layers that cover their share of the sky, or none; nothing is compiled. */
export function showClouds(
  layers: CloudLayers,
  coverages: readonly number[],
  areShown: boolean
): void {
  for (const [i, coverage] of coverages.entries()) {
    layers.at(i).coverage = areShown ? coverage : 0
  }
}

/**
 * The world's clouds over the land, which has its air as a post effect.
 *
 * @param isStill - True for a single frame.
 */
export async function worldClouds(isStill: boolean): Promise<(land: Land) => WorldClouds> {
  const picture = await cloudCover()
  return ({ renderer, camera, air: { atmosphere, post, sun, sky } }) => {
    if (post === undefined) throw new Error('worldClouds: there must be a post effect')
    const { color, depth } = post
    const worldMap = cloudWorldMap(picture)
    const layers = cloudPreset('mixed')
    const coverages = [...layers].map(({ coverage }) => coverage)
    const quality = isStill ? STILL_QUALITY : cloudQualities.medium
    const node = clouds(color, depth, camera, atmosphere, layers, { quality, worldMap })
    if (isStill) {
      node.field.bake(renderer)
      node.time = 0
    }
    Object.assign(sun.shadow, { shadowNode: cloudShadow(node, shadow(sun)) })
    cloudSkyLight(sky, node)
    return {
      node,
      show: areShown => showClouds(layers, coverages, areShown),
      cover: new CloudCover(layers, { light: node.light }),
      shade: lights => shadeNight(node, lights),
      dispose() {
        node.dispose()
        picture.dispose()
      }
    }
  }
}

import { renderGroup, uniform } from 'three/tsl'
import type { UniformNode } from 'three/webgpu'
import { checkChoice, checkOptions } from '@welkin/geo'
import { checkRanges, named } from '../check'
import { number } from '../uniforms'

/** Fineness of the march. All may be changed at any time; nothing is recompiled. */
export interface CloudQuality {
  /**
   * Most steps of a ray, in [1, 1024]. Fewer: rays end early, and clouds thin out towards the horizon
   * (*Cumulus*).
   */
  readonly steps: number
  /**
   * Length of a step in clouds per distance from the camera, in [0.0001, 1]. Greater: grain on far clouds
   * (*Cockpit*).
   */
  readonly stepGrowth: number
  /** Shortest step in clouds [m], in [0.1, 1000]. Greater: near edges lose their detail (*Inside a cloud*). */
  readonly shortestStep: number
  /**
   * Scaled optical depth of a step in clouds, in [0.01, 10]: parts of a mean free path. Greater: flat
   * shading, soft edges (*Cumulus*).
   */
  readonly depthStep: number
  /**
   * Least number of steps through a layer, in [1, 256]. Fewer: small clouds are missed by some rays, as grain
   * (*Cirrus*).
   */
  readonly layerSteps: number
  /**
   * Samples of the clouds towards sun or moon, near each shaded place, in [1, 16]. Fewer: billows cast no
   * shadows on each other (*Storm*).
   */
  readonly lightSteps: number
  /**
   * Edge of the blocks of which a frame marches one pixel each, 1 to 6; history has the rest. Greater:
   * coarse clouds while one turns or flies (*Cockpit*).
   */
  readonly block: number
}

/** Names of {@link cloudQualities}. */
export type CloudQualityName = 'low' | 'medium' | 'high' | 'ultra'

/** Well-tried qualities. */
export const cloudQualities: Readonly<Record<CloudQualityName, CloudQuality>> = {
  low: {
    steps: 160,
    stepGrowth: 0.008,
    shortestStep: 20,
    depthStep: 1,
    layerSteps: 8,
    lightSteps: 1,
    block: 6
  },
  medium: {
    steps: 512,
    stepGrowth: 0.004,
    shortestStep: 4,
    depthStep: 0.3,
    layerSteps: 18,
    lightSteps: 4,
    block: 6
  },
  high: {
    steps: 640,
    stepGrowth: 0.003,
    shortestStep: 4,
    depthStep: 0.3,
    layerSteps: 18,
    lightSteps: 4,
    block: 5
  },
  ultra: {
    steps: 960,
    stepGrowth: 0.002,
    shortestStep: 3,
    depthStep: 0.2,
    layerSteps: 24,
    lightSteps: 4,
    block: 2
  }
}

const ranges = {
  steps: [1, 1024],
  stepGrowth: [1e-4, 1],
  shortestStep: [0.1, 1000],
  depthStep: [0.01, 10],
  layerSteps: [1, 256],
  lightSteps: [1, 16]
} as const satisfies Record<Exclude<keyof CloudQuality, 'block'>, readonly [number, number]>

/**
 * The quality of a name, or the given one.
 *
 * @throws Error naming the parameter and its value when one is out of its range.
 */
export function resolveQuality(
  where: string,
  quality: CloudQualityName | CloudQuality
): CloudQuality {
  if (typeof quality === 'string') {
    return named(where, 'quality', cloudQualities, quality)
  }
  const name = `${where}.quality`
  checkOptions(name, quality, ...(Object.keys(cloudQualities.high) as (keyof CloudQuality)[]))
  checkRanges(name, quality, ranges)
  checkChoice(name, 'block', quality.block, [1, 2, 3, 4, 5, 6])
  return Object.freeze({ ...quality })
}

const whole = (): UniformNode<'int', number> => uniform(1, 'int').setGroup(renderGroup)

/** A {@link CloudQuality} as shader uniforms. */
export class QualityUniforms {
  /** Most pairs of samples: half as many as steps. */
  readonly pairs = whole()
  readonly stepGrowth = number()
  readonly shortestStep = number()
  readonly depthStep = number()
  readonly layerSteps = number()
  readonly lightSteps = whole()

  set(quality: CloudQuality): void {
    this.pairs.value = Math.ceil(quality.steps / 2)
    for (const name of ['stepGrowth', 'shortestStep', 'depthStep', 'layerSteps'] as const) {
      this[name].value = quality[name]
    }
    this.lightSteps.value = Math.round(quality.lightSteps)
  }
}

import { renderGroup, uniform } from 'three/tsl'
import type { UniformNode } from 'three/webgpu'

/** How finely clouds are marched. All may be changed at any time; nothing is recompiled. */
export interface CloudQuality {
  /** Most steps of a ray, in [1, 1024]. Rays that need more end early, with too little cloud. */
  readonly steps: number
  /** Length of a step per distance from the camera, in (0, 1]. */
  readonly stepGrowth: number
  /** Shortest step [m], in [0.1, 1000]. */
  readonly shortestStep: number
  /** Least number of steps through a layer, in [1, 256]. */
  readonly layerSteps: number
  /** Samples of the march towards the sun, in [1, 16]. */
  readonly sunSteps: number
}

/** Names of {@link cloudQualities}. */
export type CloudQualityName = 'low' | 'medium' | 'high' | 'ultra'

/** Well-tried qualities. */
export const cloudQualities: Readonly<Record<CloudQualityName, CloudQuality>> = {
  low: { steps: 64, stepGrowth: 0.05, shortestStep: 40, layerSteps: 8, sunSteps: 3 },
  medium: { steps: 96, stepGrowth: 0.035, shortestStep: 30, layerSteps: 12, sunSteps: 4 },
  high: { steps: 160, stepGrowth: 0.022, shortestStep: 20, layerSteps: 20, sunSteps: 5 },
  ultra: { steps: 320, stepGrowth: 0.01, shortestStep: 10, layerSteps: 40, sunSteps: 7 }
}

const ranges: Record<keyof CloudQuality, readonly [number, number]> = {
  steps: [1, 1024],
  stepGrowth: [1e-3, 1],
  shortestStep: [0.1, 1000],
  layerSteps: [1, 256],
  sunSteps: [1, 16]
}

/**
 * The quality of a name, or the given one.
 *
 * @throws Error naming the parameter and its value when one is out of its range.
 */
export function resolveQuality(quality: CloudQualityName | CloudQuality): CloudQuality {
  if (typeof quality === 'string') {
    if (Object.hasOwn(cloudQualities, quality)) return cloudQualities[quality]
    const names = Object.keys(cloudQualities).join(', ')
    throw new Error(`CloudsNode: quality must be one of ${names}, got ${quality}`)
  }
  for (const [name, [lowest, highest]] of Object.entries(ranges)) {
    const value: unknown = quality?.[name as keyof CloudQuality]
    if (typeof value === 'number' && value >= lowest && value <= highest) continue
    throw new Error(
      `CloudsNode: quality.${name} must be a number in [${lowest}, ${highest}], got ${String(value)}`
    )
  }
  return Object.freeze({ ...quality })
}

const whole = (): UniformNode<'int', number> => uniform(1, 'int').setGroup(renderGroup)
const number = (): UniformNode<'float', number> => uniform(1).setGroup(renderGroup)

/** A {@link CloudQuality} as shader uniforms. */
export class QualityUniforms {
  readonly steps = whole()
  readonly stepGrowth = number()
  readonly shortestStep = number()
  readonly layerSteps = number()
  readonly sunSteps = whole()

  set(quality: CloudQuality): void {
    this.steps.value = Math.round(quality.steps)
    this.stepGrowth.value = quality.stepGrowth
    this.shortestStep.value = quality.shortestStep
    this.layerSteps.value = quality.layerSteps
    this.sunSteps.value = Math.round(quality.sunSteps)
  }
}

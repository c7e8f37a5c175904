import { CloudLightTable, type CloudPhaseParameters } from '@welkin/clouds'
import { Fn, Loop, float, vec4 } from 'three/tsl'
import type { Node } from 'three/webgpu'
import type { CloudLight } from '../../../packages/clouds/src/light/CloudLightTable'
import { cloudSource } from '../../../packages/clouds/src/light/tsl/cloudLight'
import type { Float, Vec4 } from '../../../packages/clouds/src/tsl-types'
import { createContext } from '../../gpu/harness/context'
import { evaluateOnGpu } from '../../gpu/harness/evaluate'
import type { Backend } from '../../harness/backend'

export type Shape = 'slab' | 'sphere'

export interface CloudRequest {
  backend: Backend
  phases: Record<string, CloudPhaseParameters>
  /**
   * Rays into clouds: optical thickness, cosines of sun and view with the normal and between both; or
   * optical diameter, cosine between view and sun, and the ray's impact point in radii, sunward and
   * aside.
   */
  rays: { shape: Shape; phase: string; input: [number, number, number, number] }[]
}

declare global {
  interface Window {
    welkinClouds: (request: CloudRequest) => Promise<number[]>
  }
}

/** Steps of a march; what is deeper than `DEEPEST` along a ray is not seen. */
const STEPS = 256
const DEEPEST = 30

/** ∫ S e^{−τ′} dτ′ along a ray, the source being constant within a step. */
function march(length: Float, source: (depth: Float) => Float): Float {
  const radiance = float(0).toVar()
  const step = length.min(DEEPEST).div(STEPS).toConst()
  const weight = step.negate().exp().oneMinus().toConst()
  Loop(STEPS, ({ i }) => {
    const start = step.mul(float(i)).toConst()
    const light = source(start.add(step.mul(0.5)))
    radiance.addAssign(light.mul(start.negate().exp()).mul(weight))
  })
  return radiance
}

function slabRadiance(light: CloudLight, input: Vec4): Float {
  const thickness = input.x.mul(light.depthScale).toConst()
  const [cosLight, cosView, cosViewLight] = [input.y, input.z, input.w]
  const slope = cosView.abs().toConst()
  return march(thickness.div(slope), depthToCamera => {
    const below = depthToCamera.mul(slope)
    const depth = cosView.greaterThan(0).select(thickness.sub(below), below)
    return cloudSource(light, {
      depthToLight: depth.div(cosLight),
      depthThrough: thickness.div(cosLight),
      depthAcross: float(0),
      depthToCamera,
      layered: float(1),
      cosLight,
      cosView,
      cosViewLight
    })
  })
}

function sphereRadiance(light: CloudLight, input: Vec4): Float {
  const radius = input.x.mul(light.depthScale).mul(0.5).toConst()
  const cosine = input.y
  const sine = cosine.mul(cosine).oneMinus().max(0).sqrt().toConst()
  const sunward = input.z.mul(radius).toConst()
  const aside = input.w.mul(radius).toConst()
  const square = radius.mul(radius).toConst()
  const offAxis = sunward.mul(sunward).add(aside.mul(aside)).toConst()
  const half = square.sub(offAxis).max(0).sqrt().toConst()
  return march(half.mul(2), depthToCamera => {
    const z = depthToCamera.sub(half).toConst()
    const towardsSun = sunward.mul(sine).add(z.mul(cosine)).toConst()
    const fromAxis = offAxis.add(z.mul(z)).sub(towardsSun.mul(towardsSun))
    const chord = square.sub(fromAxis).max(0).sqrt().toConst()
    return cloudSource(light, {
      depthToLight: chord.sub(towardsSun).max(0),
      depthThrough: chord.mul(2),
      depthAcross: radius.mul(2),
      depthToCamera,
      viewChord: [depthToCamera, half.mul(2).sub(depthToCamera)],
      layered: float(0),
      // There is no up.
      cosLight: float(1),
      cosView: cosine,
      cosViewLight: cosine
    })
  })
}

window.welkinClouds = async ({ backend, phases, rays }) => {
  const { context, finish } = createContext(backend)
  const radiances = rays.map(() => NaN)
  let messages: string[]
  try {
    const renderer = await context.createRenderer()
    for (const [phase, parameters] of Object.entries(phases)) {
      const light = new CloudLightTable(parameters)
      light.bake()
      for (const shape of ['slab', 'sphere'] as const) {
        const chosen = rays.flatMap((ray, i) =>
          ray.shape === shape && ray.phase === phase ? [i] : []
        )
        if (chosen.length === 0) continue
        const radiance = shape === 'slab' ? slabRadiance : sphereRadiance
        const results = await evaluateOnGpu(
          renderer,
          chosen.map(i => rays[i].input),
          (input: Node<'vec4'>) => Fn(() => vec4(radiance(light.nodes, input.toConst())))()
        )
        chosen.forEach((ray, i) => (radiances[ray] = results[4 * i]))
      }
      light.dispose()
    }
  } finally {
    messages = (await finish()).messages
  }
  if (messages.length > 0) throw new Error(messages.join('\n'))
  return radiances
}

import { Atmosphere, AtmosphereParameters } from '@welkin/atmosphere'
import { Ellipsoid } from '@welkin/geo'
import { vec4 } from 'three/tsl'
import type { Node, WebGPURenderer } from 'three/webgpu'
import { eyeScalars } from '../../../packages/atmosphere/src/view/cpu/eye'
import { groundIrradiance } from '../../../packages/atmosphere/src/diffuseLight/tsl/diffuseLight'
import { marchedAir, marchedSky } from '../../../packages/atmosphere/src/scattering/tsl/marchedAir'
import {
  rayLimits,
  rayTargets,
  aimAt,
  sampleSky,
  sampleVolume
} from '../../../packages/atmosphere/src/skyVolume/tsl/skyVolume'
import { sunTransmittance } from '../../../packages/atmosphere/src/transmittance/tsl/transmittance'
import type { Float, Vec4 } from '../../../packages/atmosphere/src/tsl-types'
import { viewNodes, type ViewNodes } from '../../../packages/atmosphere/src/view/ViewNodes'
import { createContext } from '../../gpu/harness/context'
import { evaluateOnGpu } from '../../gpu/harness/evaluate'
import type { EvaluationRequest, EvaluationResult, EyePlace, Path, RayRequest } from '../request'
import { RayBatch, type RayNodes } from './RayBatch'
import './clouds'
import './cloud-field'

declare global {
  interface Window {
    welkinEvaluate: (request: EvaluationRequest) => Promise<EvaluationResult>
  }
}

/** Steps of the marched path. */
const MARCH_STEPS = 12

function skyRadiance({ air, eye, volume }: ViewNodes, path: Path, ray: RayNodes): Vec4 {
  const { cosView, cosViewSun } = ray
  const { uniforms } = air
  if (path === 'volume') {
    const { hitsGround, meetsAir } = rayTargets(eye, cosView)
    const light = sampleSky(uniforms, volume, eye, aimAt(eye, cosView, hitsGround), cosViewSun)
    return light.mul(meetsAir.select(1, 0))
  }
  const limits = rayLimits(eye, cosView)
  return marchedSky(air, eye, cosView, cosViewSun, limits, MARCH_STEPS)
}

function airInSegment({ air, eye, volume }: ViewNodes, path: Path, ray: RayNodes) {
  const { cosView, cosViewSun, distance } = ray
  const limits = rayLimits(eye, cosView)
  return path === 'volume'
    ? sampleVolume(air.uniforms, volume, eye, cosView, cosViewSun, limits, distance)
    : marchedAir(air, eye, cosView, cosViewSun, limits, distance, MARCH_STEPS)
}

/** The eyes of rays, each once, with the numbers of the eyes of all rays. */
function distinctEyes(rays: EyePlace[]): { eyes: EyePlace[]; eyeOf: (ray: EyePlace) => number } {
  const key = (ray: EyePlace): string => `${ray.altitude} ${ray.cosSun}`
  const eyes = [...new Map(rays.map(ray => [key(ray), ray])).values()]
  const numbers = new Map(eyes.map((eye, i) => [key(eye), i]))
  return { eyes, eyeOf: ray => numbers.get(key(ray))! }
}

/** Evaluates rays from many eyes: a volume is computed once for all the rays of an eye. */
async function evaluateRays(
  renderer: WebGPURenderer,
  atmosphere: Atmosphere,
  { path, sky, segments }: EvaluationRequest
): Promise<Pick<EvaluationResult, 'sky' | 'inscatter' | 'transmittance'>> {
  const { parameters, tables } = atmosphere
  const view = viewNodes(atmosphere)
  const { eyes, eyeOf } = distinctEyes([...sky, ...segments])
  const batch = (rays: RayRequest[], body: (ray: RayNodes) => Vec4): RayBatch =>
    new RayBatch(
      rays.map(ray => ({ ...ray, eye: eyeOf(ray) })),
      body
    )
  const batches = {
    sky: batch(sky, ray => skyRadiance(view, path, ray)),
    inscatter: batch(segments, ray => airInSegment(view, path, ray).radiance),
    transmittance: batch(segments, ray => airInSegment(view, path, ray).depth.negate().exp())
  }
  eyes.forEach(({ altitude, cosSun }, i) => {
    const scalars = eyeScalars(parameters, altitude, cosSun)
    const volume =
      path === 'volume' ? tables.volumes.volumeFor(renderer, scalars, tables.version) : null
    view.eye.set(scalars, volume)
    for (const part of Object.values(batches)) part.render(renderer, i)
  })
  return {
    sky: await batches.sky.read(renderer),
    inscatter: await batches.inscatter.read(renderer),
    transmittance: await batches.transmittance.read(renderer)
  }
}

async function evaluateGrounds(
  renderer: WebGPURenderer,
  atmosphere: Atmosphere,
  cosines: number[]
): Promise<Pick<EvaluationResult, 'skyIrradiance' | 'sunIrradiance'>> {
  if (cosines.length === 0) return { skyIrradiance: [], sunIrradiance: [] }
  const { uniforms, transmittance, diffuse } = viewNodes(atmosphere).air
  const evaluate = async (body: (cosSun: Float) => Vec4): Promise<number[]> => {
    const run = (input: Node<'vec4'>): Node => body(input.x)
    const inputs = cosines.map(cosine => [cosine])
    return [...(await evaluateOnGpu(renderer, inputs, run))]
  }
  const ground = vec4(0).x as Float
  return {
    skyIrradiance: await evaluate(cosSun => groundIrradiance(uniforms, diffuse!, cosSun)),
    sunIrradiance: await evaluate(cosSun =>
      sunTransmittance(uniforms, transmittance, ground, cosSun).mul(cosSun.max(0))
    )
  }
}

window.welkinEvaluate = async request => {
  const { context, finish } = createContext(request.backend)
  const parameters = new AtmosphereParameters(request.parameters)
  const ellipsoid = new Ellipsoid(parameters.bottomRadius)
  const atmosphere = new Atmosphere({ parameters, ellipsoid })
  let result: EvaluationResult
  let messages: string[]
  try {
    const renderer = await context.createRenderer()
    await atmosphere.bake(renderer)
    result = {
      ...(await evaluateRays(renderer, atmosphere, request)),
      ...(await evaluateGrounds(renderer, atmosphere, request.grounds))
    }
  } finally {
    atmosphere.dispose()
    messages = (await finish()).messages
  }
  if (messages.length > 0) throw new Error(messages.join('\n'))
  return result
}

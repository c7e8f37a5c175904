import { Atmosphere, AtmosphereParameters } from '@welkin/atmosphere'
import { Ellipsoid } from '@welkin/geo'
import { vec4 } from 'three/tsl'
import type { Node, WebGPURenderer } from 'three/webgpu'
import { viewpointScalars } from '../../../packages/atmosphere/src/view/cpu/viewpoint'
import { groundIrradiance } from '../../../packages/atmosphere/src/diffuseLight/tsl/diffuseLight'
import { marchedAir, marchedSky } from '../../../packages/atmosphere/src/scattering/tsl/marchedAir'
import { rayLimits, rayTargets } from '../../../packages/atmosphere/src/skyVolume/tsl/rayLimits'
import { sampleSky, sampleVolume } from '../../../packages/atmosphere/src/skyVolume/tsl/skyVolume'
import { viewRay } from '../../../packages/atmosphere/src/skyVolume/tsl/viewRay'
import { lightTransmittance } from '../../../packages/atmosphere/src/transmittance/tsl/transmittance'
import type { Float, Vec4 } from '../../../packages/atmosphere/src/tsl-types'
import { viewNodes, type ViewNodes } from '../../../packages/atmosphere/src/view/ViewNodes'
import { createContext } from '../../gpu/harness/context'
import { evaluateOnGpu } from '../../gpu/harness/evaluate'
import { loadTexels } from '../../gpu/harness/kept-texels'
import { keepTables, reuseTables } from '../../gpu/harness/reuse-tables'
import { requestOffscreenFrames } from '../../harness/offscreenFrames'
import type { EvaluationRequest, EvaluationResult, Viewpoint, Path, RayRequest } from '../request'
import { RayBatch, type RayNodes } from './RayBatch'
import './clouds'
import './cloud-field'
import './cloud-light'
import './shafts'

declare global {
  interface Window {
    welkinEvaluate: (request: EvaluationRequest) => Promise<EvaluationResult>
  }
}

requestOffscreenFrames()
reuseTables(true)

/** Steps of the marched path. */
const MARCH_STEPS = 12

function skyRadiance({ air, viewpoint, volume }: ViewNodes, path: Path, ray: RayNodes): Vec4 {
  const { cosView, cosViewLight } = ray
  const { uniforms } = air
  if (path === 'volume') {
    const { hitsGround, meetsAir } = rayTargets(viewpoint, cosView)
    const light = sampleSky(
      uniforms,
      volume,
      viewpoint,
      viewRay(viewpoint, cosView, hitsGround),
      cosViewLight
    )
    return light.mul(meetsAir.select(1, 0))
  }
  const limits = rayLimits(viewpoint, cosView)
  return marchedSky(air, viewpoint, cosView, cosViewLight, limits, MARCH_STEPS)
}

function airInSegment({ air, viewpoint, volume }: ViewNodes, path: Path, ray: RayNodes) {
  const { cosView, cosViewLight, distance } = ray
  const limits = rayLimits(viewpoint, cosView)
  return path === 'volume'
    ? sampleVolume(air.uniforms, volume, viewpoint, cosView, cosViewLight, limits, distance)
    : marchedAir(air, viewpoint, cosView, cosViewLight, limits, distance, MARCH_STEPS)
}

/** The viewpoints of rays, each once, with the numbers of the viewpoints of all rays. */
function distinctViewpoints(rays: Viewpoint[]): {
  viewpoints: Viewpoint[]
  viewpointOf: (ray: Viewpoint) => number
} {
  const key = (ray: Viewpoint): string => `${ray.altitude} ${ray.cosLight}`
  const viewpoints = [...new Map(rays.map(ray => [key(ray), ray])).values()]
  const numbers = new Map(viewpoints.map((viewpoint, i) => [key(viewpoint), i]))
  return { viewpoints, viewpointOf: ray => numbers.get(key(ray))! }
}

/** Evaluates rays from many viewpoints: a volume is computed once for all the rays of a viewpoint. */
async function evaluateRays(
  renderer: WebGPURenderer,
  atmosphere: Atmosphere,
  { path, sky, segments }: EvaluationRequest
): Promise<Pick<EvaluationResult, 'sky' | 'inscatter' | 'transmittance'>> {
  const { parameters, tables } = atmosphere
  const view = viewNodes(atmosphere)
  const { viewpoints, viewpointOf } = distinctViewpoints([...sky, ...segments])
  const batch = (rays: RayRequest[], body: (ray: RayNodes) => Vec4): RayBatch =>
    new RayBatch(
      rays.map(ray => ({ ...ray, viewpoint: viewpointOf(ray) })),
      body
    )
  const batches = {
    sky: batch(sky, ray => skyRadiance(view, path, ray)),
    inscatter: batch(segments, ray => airInSegment(view, path, ray).radiance),
    transmittance: batch(segments, ray => airInSegment(view, path, ray).depth.negate().exp())
  }
  viewpoints.forEach(({ altitude, cosLight }, i) => {
    const scalars = viewpointScalars(parameters, altitude, cosLight)
    const volume =
      path === 'volume' ? tables.volumes.volumeFor(renderer, scalars, tables.version) : null
    view.viewpoint.set(scalars, volume)
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
  const evaluate = async (body: (cosLight: Float) => Vec4): Promise<number[]> => {
    const run = (input: Node<'vec4'>): Node => body(input.x)
    const inputs = cosines.map(cosine => [cosine])
    return [...(await evaluateOnGpu(renderer, inputs, run))]
  }
  const ground = vec4(0).x as Float
  return {
    skyIrradiance: await evaluate(cosLight => groundIrradiance(uniforms, diffuse!, cosLight)),
    sunIrradiance: await evaluate(cosLight =>
      lightTransmittance(uniforms, transmittance, ground, cosLight).mul(cosLight.max(0))
    )
  }
}

window.welkinEvaluate = async request => {
  await loadTexels()
  const { context, finish } = createContext(request.backend)
  const parameters = new AtmosphereParameters(request.parameters)
  const ellipsoid = new Ellipsoid(parameters.bottomRadius)
  const atmosphere = new Atmosphere({ parameters, ellipsoid })
  let result: EvaluationResult
  let messages: string[]
  try {
    const renderer = await context.createRenderer()
    await atmosphere.bake(renderer)
    await keepTables()
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

import { Break, If, float, int, vec3 } from 'three/tsl'
import type { CloudField } from '../../density/CloudField'
import { loop, type Float, type Int, type Vec2, type Vec3 } from '../../tsl-types'
import { rayWeather } from '../../density/tsl/rayWeather'
import { samplePair } from '../../density/tsl/sampler'
import type { CloudSample } from '../../density/tsl/sample'
import { LEAST_TRANSMITTANCE, sourceAt } from '../../light/tsl/lighting'
import type { ShadingContext } from '../../light/tsl/shadingContext'
import { FAR_AWAY, layersAt, nextLayerBoundary } from './layerBoundaries'
import { addPair, rayLight, seenClouds, seenOf, shadePassing, type SeenClouds } from './rayLight'
import { advance, enterSteps, nextSteps, stepState } from './steps'

/** A ray from the camera, in the mapped space. */
export interface CloudRay {
  /** Unit length. */
  direction: Vec3
  /** Distance where it ends, at the ground at the latest [m]. */
  end: Float
  /** Noise that shifts the steps of the ray, in [0, 1). */
  jitter: Float
}

/** Clouds on a ray. */
export interface MarchedClouds extends SeenClouds {
  /** Steps that were taken. */
  steps: Float
}

/** The stretch of a ray between two layer boundaries. */
type Segment = ReturnType<typeof segmentState>

/** No segment yet: the next step enters one. */
const segmentState = () => ({
  /** Distance where it ends [m]. */
  end: float(0).toVar(),
  base: float(0).toVar(),
  top: float(0).toVar(),
  layered: float(0).toVar(),
  range: { first: int(0).toVar() as Int, last: int(0).toVar() as Int }
})

/**
 * Enters the next segment.
 *
 * @param altitude - In the middle of it [m].
 * @returns Greatest extinction of a layer there [1/m].
 */
function enterSegment(field: CloudField, segment: Segment, end: Float, altitude: Float): Float {
  segment.end.assign(end)
  const { base, top, layered, density, range } = layersAt(field, altitude)
  segment.base.assign(base)
  segment.top.assign(top)
  segment.layered.assign(layered)
  segment.range.first.assign(range.first)
  segment.range.last.assign(range.last)
  return density
}

/**
 * Marches a ray through all layers, from boundary to boundary: jumps where no layer is, goes by likely
 * distances through clear air, and ends where nothing more is seen. Steps go in pairs that share light.
 *
 * To be called inside of a shader function.
 */
export function marchClouds(context: ShadingContext, ray: CloudRay): MarchedClouds {
  const { field, light, quality } = context
  const { direction, end, jitter } = ray
  const { view } = field
  const cosView = direction.dot(view.up).clamp(-1, 1).toConst() as Float
  const sampleAt = (distance: Float): CloudSample => {
    const at = distance.toConst() as Float
    const offset = direction.mul(at).toConst() as Vec3
    return { offset, ...view.localCoordinates(offset), distance: at }
  }
  const sum = rayLight()
  const state = stepState(jitter)
  const segment = segmentState()
  const weatherAlong = rayWeather()
  const steps = float(0).toVar()
  const position = float(0).toVar()
  /** Distance of the first layer; 0 before. */
  const entry = float(0).toVar()

  loop('cloudPair', quality.pairs, () => {
    If(position.greaterThanEqual(end).or(sum.transmittance.lessThan(LEAST_TRANSMITTANCE)), () => {
      Break()
    })
    steps.addAssign(2)
    If(position.greaterThanEqual(segment.end), () => {
      shadePassing(field, sum, sampleAt)
      const boundary = nextLayerBoundary(field, cosView, position.mul(1 + 1e-6).add(0.01))
        .min(end)
        .toConst() as Float
      const { altitude } = view.localCoordinates(direction.mul(position.add(boundary).mul(0.5)))
      const density = enterSegment(field, segment, boundary, altitude).mul(light.depthScale)
      enterSteps(state, field, quality, density, position, boundary)
      If(segment.base.greaterThan(segment.top), () => {
        position.assign(boundary)
      }).ElseIf(entry.equal(0), () => {
        entry.assign(position.max(1))
      })
    }).Else(() => {
      const pair = nextSteps(state, quality, position, segment.end)
      const { length } = pair
      const places = [0.5, 1.5].map(at => position.add(length.mul(at)).toConst() as Float)
      const samples = [sampleAt(places[0]), sampleAt(places[1])] as const
      const middle = position.add(length).toConst() as Float
      const { range } = segment
      const clouds = samplePair(field, weatherAlong, middle, samples, sampleAt, direction, range)
      const addLight = (): void => {
        const depth = clouds.extinction.mul(light.depthScale).mul(length).toConst() as Vec2
        addPair(sum, seenOf(sum, depth), places, distance => {
          const sample = sampleAt(distance)
          const { weather } = clouds
          const { transmittance } = sum
          const lit = { sample, weather, direction, transmittance, dither: jitter, layers: segment }
          const { direct, sky, ground } = sourceAt(context, lit)
          return vec3(direct, sky, ground)
        })
      }
      const found = { ...clouds, greatest: clouds.greatest.mul(light.depthScale) }
      position.addAssign(advance(state, pair, quality, found, addLight))
    })
  })
  shadePassing(field, sum, sampleAt)
  const nothing = entry.greaterThan(0).select(entry, end.min(FAR_AWAY)) as Float
  return { ...seenClouds(sum, nothing), steps }
}

import { Vector3 } from 'three'
import type { HeightSample } from '../heights/HeightSource'
import { sampleGround } from '../heights/sampleGround'
import { figureOf, isFlat } from '../tiles/cpu/figure'
import { waterLevel, type Ground } from './Ground'

/** Precision of a hit along the ray [m]. */
const PRECISION = 1e-4

/** Shortest step [m], and per distance from the ray's start: what is thinner may be missed. */
const LEAST_STEP = 1e-3
const LEAST_SHARE = 1e-8

/** Steps after which the shortest one has doubled: a ray that skims the ground for long shall end. */
const PATIENCE = 1000

/** Factor on distances along the ellipsoid, for ground that lies below it. */
const DEPTH = 1.01

const position = new Vector3()
const up = new Vector3()
const sample: HeightSample = { height: 0, gradient: new Vector3() }

/** Point of a ray. */
interface Probe {
  /** Above the ellipsoid [m]. */
  height: number
  /** Height above the ground, or above the highest ground if that is less [m]. */
  clearance: number
  /** Cosine between the ray and up. */
  cosUp: number
}

/** Height, clearance and inclination of a ray at a distance [m]. */
function probe(
  ground: Ground,
  highest: number,
  origin: Vector3,
  direction: Vector3,
  distance: number,
  target: Probe
): Probe {
  position.copy(origin).addScaledVector(direction, distance)
  const figure = figureOf(ground.atmosphere)
  const { radii } = figure
  figure.surfaceNormal(position, up)
  const support = isFlat(figure) ? 0 : Math.hypot(radii.x * up.x, radii.y * up.y, radii.z * up.z)
  target.height = position.dot(up) - support
  target.cosUp = direction.dot(up)
  target.clearance = target.height - highest
  if (target.clearance > 0) return target
  sampleGround(ground.source, position.addScaledVector(up, -target.height), sample)
  target.clearance = target.height - Math.max(sample.height, waterLevel(ground, position))
  return target
}

/**
 * Distance along a ray to where it enters the ground or water. A ray that begins below the surface leaves it first.
 *
 * Height above the ellipsoid is convex along a ray, because the ellipsoid is: a tangent of it stays below, so that Newton's
 * method comes down to the highest ground from outside without overshooting. From there steps are as long as
 * `HeightSource.variation` excludes a hit, and what crosses the surface is bisected to 0.1 mm. Steps are no shorter than
 * 1 mm or 1e-8 of the distance: a ray may pass through what is thinner than that.
 *
 * @param origin - ECEF [m].
 * @param direction - Unit vector.
 * @param near - Distance at which the ray begins, ≥ 0 [m].
 * @param far - Distance at which it ends; may be infinite [m].
 * @returns [m], or null if the ray misses.
 */
export function distanceToGround(
  ground: Ground,
  origin: Vector3,
  direction: Vector3,
  near: number,
  far: number
): number | null {
  const { source, seaLevel, lakes = [] } = ground
  const { minimumRadius, maximumRadius } = figureOf(ground.atmosphere)
  const highest = Math.max(source.highest, seaLevel, ...lakes.map(({ level }) => level))
  const lowest = Math.max(source.lowest, seaLevel)
  // Smallest radius of curvature of the ellipsoid: up turns no faster.
  const curvature = maximumRadius / minimumRadius ** 2
  const state: Probe = { height: 0, clearance: 0, cosUp: 0 }
  const look = (at: number): Probe => probe(ground, highest, origin, direction, at, state)

  let distance = near
  look(distance)
  let isInside = state.clearance <= 0
  let last = 0
  for (let steps = 0; distance < far; steps++) {
    const { height, clearance, cosUp } = state
    const least = Math.max(LEAST_STEP, LEAST_SHARE * (distance - near)) * 2 ** (steps / PATIENCE)
    let step: number
    if (height > highest) {
      if (cosUp >= 0) return null
      // A ray that is level has passed the planet after that.
      step = Math.min(clearance / -cosUp, 2 * maximumRadius + height)
    } else if (isInside && height < lowest) return null
    else {
      const fall = isInside ? 1 : -cosUp
      const sinUp = isInside ? 1 : Math.sqrt(Math.max(1 - cosUp ** 2, 0))
      const margin = Math.abs(clearance)
      const isSafe = (way: number): boolean => {
        const along = DEPTH * way * Math.min(sinUp + way * curvature, 1)
        return margin > way * fall + source.variation(along)
      }
      step = Math.min(fall > 0 ? margin / fall : maximumRadius, 4 * Math.max(last, margin))
      while (step > least && !isSafe(step)) step /= 2
    }
    last = step
    const next = Math.min(distance + Math.max(step, least), far)
    look(next)
    if (state.clearance > 0) isInside = false
    else if (!isInside) return bisect(at => look(at).clearance, distance, next)
    distance = next
  }
  return null
}

/** Place where a value falls to 0, between one where it is above and one where it is not. */
function bisect(valueAt: (place: number) => number, above: number, below: number): number {
  let [from, to] = [above, below]
  while (to - from > PRECISION) {
    const middle = (from + to) / 2
    if (middle <= from || middle >= to) break
    if (valueAt(middle) > 0) from = middle
    else to = middle
  }
  return (from + to) / 2
}

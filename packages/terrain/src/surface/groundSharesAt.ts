import { Vector3 } from 'three'
import { checkVector, fail } from '@welkin/geo'
import type { HeightSample } from '../heights/HeightSource'
import { fractalSum } from '../noise/cpu/fractalSum'
import type { Terrain } from '../Terrain'
import { sampleGround } from '../heights/sampleGround'
import { figureOf, poleOf, worldToGround } from '../tiles/cpu/figure'
import { groundShares, type SharesOnCPU } from './cpu/groundRules'
import { BROAD, BROAD_PATCHES, CLIMATE, PATCHES } from './cpu/surfaceNoise'

/** Shares of materials of the ground at a place [–], each in [0, 1], with a sum of 1. */
export interface GroundShares extends SharesOnCPU {
  /** Noise about 0, from 32 km to 64 m, by which one material gives way to another. */
  readonly patch: number
  /** Noise about 0, from 1,050 km to 16 km: wet country below, dry country above. */
  readonly climate: number
}

const place = new Vector3()
const up = new Vector3()
const pole = new Vector3()
const sample: HeightSample = { height: 0, gradient: new Vector3() }
const sum = { x: 0, y: 0, z: 0, value: 0 }

/**
 * Shares of the ground's materials at a place, by the rules that it is drawn by, for what stands on it: trees, steps, wheels. Single stones, the
 * shade of hollows, masks and maps are left out.
 *
 * @param terrain - Ground, with heights that the CPU knows.
 * @param position - Above or below the place, world [units].
 * @returns Shares of `rock`, `scree`, `grass`, `forest`, `sand` (at the shore), `desert` and `snow`; below the sea it is sand,
 *   but for rock on steep slopes and snow near the poles.
 * @throws If a component of the position is not finite, or the terrain is none.
 */
export function groundSharesAt(terrain: Terrain, position: Vector3): GroundShares {
  if (!(terrain?.atmosphere && terrain.source)) {
    fail('groundSharesAt', 'terrain must be a Terrain', terrain)
  }
  checkVector('groundSharesAt', 'position', position)
  const { atmosphere, source, seaLevel } = terrain
  const figure = figureOf(atmosphere)
  figure.footPoint(place.copy(position).applyMatrix4(worldToGround(atmosphere)), place)
  figure.surfaceNormal(place, up)
  poleOf(atmosphere, pole)
  const { x, y, z } = place
  const seed = source.seed ?? 0
  const broad = fractalSum(x, y, z, BROAD_PATCHES, seed, sum).value
  const patch = fractalSum(x, y, z, PATCHES, seed, sum).value + BROAD * broad
  const climate = fractalSum(x, y, z, CLIMATE, seed, sum).value
  const { height, gradient } = sampleGround(source, place, sample)
  gradient.addScaledVector(up, -gradient.dot(up))
  const cosSlope = 1 / Math.sqrt(1 + gradient.lengthSq())
  const sinLatitude = up.dot(pole)
  const sinNormal = (sinLatitude - gradient.dot(pole)) * cosSlope
  const overSea = height - seaLevel
  const shares = groundShares({ height, overSea, patch, climate, sinLatitude, sinNormal, cosSlope })
  return { ...shares, patch, climate }
}

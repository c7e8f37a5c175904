import { MathUtils, Vector3 } from 'three'
import {
  beltForm,
  cyclones,
  frontForm,
  SOUTHERN_TURN,
  systemsStatistics
} from '../../src/density/systemsForm'
import type { Vec3Array } from './noise'

const bump = (x: number): number => Math.max(1 - x * x, 0) ** 2

/** The cyclone around a place: `CycloneAround` of tsl/weatherSystems.ts. */
export interface CycloneAround {
  readonly displacement: Vector3
  /** Place that its air has come from, east and north of the middle [–]. */
  readonly from: readonly [number, number]
  /** Angle to the middle's chord, squared; share; azimuth of the cold front [rad]. */
  readonly square: number
  readonly share: number
  readonly front: number
}

const POLE = new Vector3(0, 0, 1)

/** A place of the southern half as its mirror image in the northern one, and back. */
const mirrored = (v: Vector3, isSouth: boolean, turn: number): Vector3 =>
  isSouth ? v.clone().setZ(-v.z).applyAxisAngle(POLE, turn) : v.clone()

/** Float64 twin of `cycloneAround`, by three's rotation about an axis. */
export function cycloneAround(zenith: Vector3): CycloneAround {
  const isSouth = zenith.z < 0
  const here = mirrored(zenith, isSouth, SOUTHERN_TURN)
  const away = (each: (typeof cyclones)[number]): number =>
    new Vector3(...each.centre).distanceTo(here)
  const nearest = cyclones.reduce((a, b) => (away(b) < away(a) ? b : a))
  const { radius, turn, front } = nearest
  const centre = new Vector3(...nearest.centre)
  const square = centre.distanceToSquared(here)
  const share = Math.max(1 - square / radius ** 2, 0)
  const source = here.clone().applyAxisAngle(centre, -turn * share ** 2)
  const east = POLE.clone().cross(centre).normalize()
  const north = centre.clone().cross(east)
  return {
    displacement: mirrored(source.clone().sub(here), isSouth, -SOUTHERN_TURN),
    from: [source.dot(east), source.dot(north)],
    square,
    share,
    front
  }
}

/** Float64 twin of `frontsAndBelts`. */
export function frontsAndBelts(
  zenith: Vector3,
  waves: Vec3Array,
  regions: readonly number[],
  { from, square, share, front }: CycloneAround
): number {
  const { cold, warm, between, dry, head, ragged } = frontForm
  const place = from.map((x, axis) => x + ragged * regions[axis])
  const frontAt = (
    azimuth: number,
    { reach, ahead, behind }: { reach: number; ahead: number; behind: number }
  ) => {
    const angle = Math.atan2(place[1], place[0]) - azimuth
    const distance = Math.hypot(...place)
    const [along, side] = [distance * Math.cos(angle), distance * Math.sin(angle)]
    const length =
      MathUtils.smoothstep(along, -0.03, 0.05) *
      (1 - MathUtils.smoothstep(along, 0.3 * reach, reach))
    return { length, side, clouds: length * bump(side / (side > 0 ? ahead : behind)) }
  }
  const coldFront = frontAt(front, cold)
  const warmFront = frontAt(front + between, warm)
  const clouds = Math.max(
    coldFront.clouds,
    frontForm.warmStrength * warmFront.clouds,
    frontForm.headStrength * bump(Math.sqrt(square) / head)
  )
  const clear = coldFront.length * bump((coldFront.side + dry.behind) / dry.width)
  const ofCyclone =
    Math.min(frontForm.rim * share, 1) * (frontForm.strength * clouds - dry.strength * clear)

  const { convergence, patches, sinking, decks, westerlies } = beltForm
  const north = Math.abs(zenith.z)
  const bent =
    zenith.z +
    beltForm.waves[0] * waves[0] +
    beltForm.waves[1] * waves[1] +
    beltForm.ragged * regions[1]
  const patch = MathUtils.clamp(
    patches.mean + patches.regions * regions[2] + patches.wave * waves[2],
    patches.least,
    patches.most
  )
  const zones = convergence.reduce(
    (sum, [latitude, width, strength]) => sum + strength * bump((bent - latitude) / width),
    0
  )
  const sinks =
    MathUtils.smoothstep(Math.abs(bent), ...sinking.from) *
    (1 - MathUtils.smoothstep(Math.abs(bent), ...sinking.to))
  const deck =
    MathUtils.smoothstep(0.6 * waves[1] + 0.4 * waves[0], ...decks.from) *
    bump((north - decks.latitude) / decks.width)
  const [mean, deviation] = systemsStatistics
  return (
    (zones * patch -
      sinking.strength * sinks +
      westerlies.strength * MathUtils.smoothstep(north, ...westerlies.from) +
      decks.strength * deck +
      ofCyclone -
      mean) /
    deviation
  )
}

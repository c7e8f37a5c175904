import { float, smoothstep, vec2, vec3, vec4 } from 'three/tsl'
import { select } from '../../select'
import { beltForm, cyclones, frontForm, SOUTHERN_TURN, systemsStatistics } from '../systemsForm'
import type { Float, Vec2, Vec3, Vec4 } from '../../tsl-types'
import { sine } from './planetWaves'

// Weather of whole regions, as smooth functions of the place: cyclones that wind fronts up, and belts of latitude.

/** A bump of height 1 and half width 1: (1 − x²)², 0 beyond. */
const bump = (x: Float): Float => {
  const rest = x.mul(x).oneMinus().max(0).toConst()
  return rest.mul(rest)
}

/** The cyclone around a place. */
export interface CycloneAround {
  /** Displacement to where the air there has come from [–]. */
  readonly displacement: Vec3
  /** That place east and north of the cyclone's middle, north being towards the pole of its half [–]. */
  readonly from: Vec2
  /** Squared distance from the middle [–]; share of the cyclone, in [0, 1]; direction of its cold front. */
  readonly square: Float
  readonly share: Float
  readonly front: Vec2
}

/**
 * The cyclone around a place, and what it has done: air in a vortex is turned the more the nearer to its middle, which winds
 * fronts up into spirals and commas.
 *
 * To be called inside of a shader function.
 *
 * @param zenith - In the frame that drifts with the weather, unit length.
 * @see Doswell 1984, "A kinematic analysis of frontogenesis associated with a nondivergent vortex", J. Atmos. Sci. 41, pp. 1242–1248. Twin:
 *   test/twins/weatherSystems.ts
 */
export function cycloneAround(zenith: Vec3): CycloneAround {
  const isSouth = zenith.z.lessThan(0).toConst()
  const side = select(isSouth, float(-1), float(1)).toConst() as Float
  const cos = select(isSouth, float(Math.cos(SOUTHERN_TURN)), float(1)).toConst() as Float
  const sin = select(isSouth, float(Math.sin(SOUTHERN_TURN)), float(0)).toConst() as Float
  const here = vec3(
    zenith.x.mul(cos).sub(zenith.y.mul(sin)),
    zenith.x.mul(sin).add(zenith.y.mul(cos)),
    zenith.z.abs()
  ).toConst() as Vec3
  // The nearest one: centre, and 1/radius², turn and front.
  const nearest = vec4(0, 0, 1, -2).toVar() as Vec4
  const form = vec4(0).toVar() as Vec4
  for (const { centre, radius, turn, front } of cyclones) {
    const cosine = here.dot(vec3(...centre)).toConst() as Float
    const isNearer = cosine.greaterThan(nearest.w).toConst()
    nearest.assign(select(isNearer, vec4(...centre, cosine), nearest))
    const own = vec4(1 / radius ** 2, turn, Math.cos(front), Math.sin(front))
    form.assign(select(isNearer, own, form))
  }
  const centre = nearest.xyz.toConst() as Vec3
  const fromMiddle = here.sub(centre).toConst() as Vec3
  const square = fromMiddle.dot(fromMiddle).toConst() as Float
  const share = square.mul(form.x).oneMinus().max(0).toConst() as Float
  const angle = share.mul(share).mul(form.y).toConst() as Float
  // Back to where it came from: clockwise where cyclones turn against the clock.
  const turned = sine(vec3(angle, angle.add(Math.PI / 2), 0)).toConst() as Vec3
  const drift = fromMiddle
    .mul(turned.y.sub(1))
    .sub(centre.cross(fromMiddle).mul(turned.x))
    .add(centre.mul(centre.dot(fromMiddle).mul(turned.y.oneMinus())))
    .toConst() as Vec3
  const source = fromMiddle.add(drift).toConst() as Vec3
  const across = centre.xy.length().toConst() as Float
  const east = source.y.mul(centre.x).sub(source.x.mul(centre.y)).div(across)
  const north = source.z
    .mul(across)
    .sub(source.x.mul(centre.x).add(source.y.mul(centre.y)).mul(centre.z).div(across))
  const displacement = vec3(
    drift.x.mul(cos).add(drift.y.mul(sin)),
    drift.y.mul(cos).sub(drift.x.mul(sin)),
    drift.z.mul(side)
  )
  return {
    displacement: displacement.toConst(),
    from: vec2(east, north).toConst(),
    square,
    share,
    front: form.zw.toConst()
  }
}

/** Clouds of a front, and distance from it, positive against the clock of its direction [–]. */
function frontAt(
  place: Vec2,
  direction: Vec2,
  { reach, ahead, behind }: { reach: number; ahead: number; behind: number }
): { clouds: Float; side: Float; length: Float } {
  const along = place.dot(direction).toConst() as Float
  const side = place.y.mul(direction.x).sub(place.x.mul(direction.y)).toConst() as Float
  const length = smoothstep(-0.03, 0.05, along)
    .mul(smoothstep(0.3 * reach, reach, along).oneMinus())
    .toConst() as Float
  const width = select(side.greaterThan(0), float(1 / ahead), float(1 / behind)) as Float
  return { clouds: length.mul(bump(side.mul(width))), side, length }
}

/** Clouds of a cyclone, 0 away from it: its fronts, the head about its middle, the dry air behind the cold front. */
function cycloneClouds({ from, square, share, front }: CycloneAround, regions: Vec4): Float {
  const { cold, warm, between, dry, head, ragged } = frontForm
  const { strength, warmStrength, headStrength, rim } = frontForm
  const place = from.add(regions.xy.mul(ragged)).toConst() as Vec2
  const [cos, sin] = [Math.cos(between), Math.sin(between)]
  const ahead = vec2(
    front.x.mul(cos).sub(front.y.mul(sin)),
    front.x.mul(sin).add(front.y.mul(cos))
  ).toConst() as Vec2
  const coldFront = frontAt(place, front, cold)
  const warmFront = frontAt(place, ahead, warm)
  const middle = square
    .div(head ** 2)
    .oneMinus()
    .max(0)
    .toConst() as Float
  const clouds = coldFront.clouds
    .max(warmFront.clouds.mul(warmStrength))
    .max(middle.mul(middle).mul(headStrength))
  const clear = coldFront.length.mul(bump(coldFront.side.add(dry.behind).div(dry.width)))
  return clouds.mul(strength).sub(clear.mul(dry.strength)).mul(share.mul(rim).min(1))
}

/** Clouds of the belts of latitude: convergence zones, clear subtropics with decks in them, westerlies. */
function beltClouds(sine_: Float, waves: Vec3, regions: Vec4): Float {
  const { convergence, patches, sinking, decks, westerlies, ragged } = beltForm
  const north = sine_.abs().toConst() as Float
  const bent = sine_
    .add(waves.x.mul(beltForm.waves[0]))
    .add(waves.y.mul(beltForm.waves[1]))
    .add(regions.y.mul(ragged))
    .toConst() as Float
  const patch = regions.z
    .mul(patches.regions)
    .add(waves.z.mul(patches.wave))
    .add(patches.mean)
    .clamp(patches.least, patches.most)
  const zones = convergence
    .map(([latitude, width, strength]) => bump(bent.sub(latitude).div(width)).mul(strength))
    .reduce((sum, zone) => sum.add(zone))
  const [from, to] = [sinking.from, sinking.to].map(edges =>
    smoothstep(edges[0], edges[1], bent.abs())
  )
  const deck = smoothstep(...decks.from, waves.y.mul(0.6).add(waves.x.mul(0.4))).mul(
    bump(north.sub(decks.latitude).div(decks.width))
  )
  return zones
    .mul(patch)
    .sub((from as Float).mul((to as Float).oneMinus()).mul(sinking.strength))
    .add(smoothstep(...westerlies.from, north).mul(westerlies.strength))
    .add(deck.mul(decks.strength))
}

/**
 * Weather of fronts and belts at a place, of mean 0 and a variance of about 1 over the planet.
 *
 * @param zenith - In the frame that drifts with the weather, unit length.
 * @param waves - `planetWaves` there.
 * @param regions - Noise of the regions where its air has come from, each in [−½, ½]: makes edges ragged.
 */
export function frontsAndBelts(
  zenith: Vec3,
  waves: Vec3,
  regions: Vec4,
  cyclone: CycloneAround
): Float {
  const [mean, deviation] = systemsStatistics
  return beltClouds(zenith.z, waves, regions)
    .add(cycloneClouds(cyclone, regions))
    .sub(mean)
    .div(deviation)
    .toConst()
}

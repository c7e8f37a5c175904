import { horizontalIrradiance, transmittanceToLight } from '@welkin/atmosphere'
import type { SkyLitPlane, ViewUniforms } from '@welkin/atmosphere'
import { float, vec4 } from 'three/tsl'
import type { CloudField } from '../../density/CloudField'
import type { CloudLight } from '../../light/CloudLightTable'
import type { Float, Vec3, Vec4 } from '../../tsl-types'
import { decksAround, type CloudDeckNodes, type Decks, type FallingDecks } from './decks'

/** Light about a plane: see `ClearLight` of cpu/overcast.ts. */
export interface ClearLightNodes {
  direct: { above: Vec4; below: Vec4 }
  sky: { here: Vec4; below: Vec4 }
  ground: Vec4
  plane: Vec4
  albedo: Vec4
}

/**
 * Irradiance of a plane among clouds: of sky and ground, with the direct light that clouds have scattered,
 * but without what arrives unscattered. Light to and fro between clouds and ground is summed as
 * geometric series. Twins: cpu/overcast.ts, test/twins/overcast.ts
 *
 * @param cosNormal - The plane's normal against the zenith.
 */
export function cloudyIrradiance(
  { direct, sky, ground, plane, albedo }: ClearLightNodes,
  above: CloudDeckNodes,
  below: CloudDeckNodes,
  cosNormal: Float
): Vec4 {
  const reflected = below.diffuse.oneMinus().toConst() as Float
  /** Part of the light on the ground that leaves the clouds over it. */
  const escaping = albedo.mul(reflected).oneMinus().reciprocal().mul(below.diffuse)
  const whiteness = albedo.mul(escaping).mul(below.diffuse).add(reflected)
  const passing = direct.above.mul(above.direct).add(sky.here.mul(above.diffuse))
  const bounced = passing.div(whiteness.mul(above.diffuse.oneMinus()).oneMinus())
  const more = bounced
    .sub(direct.above.mul(above.beam))
    .sub(sky.here.mul(above.diffuse))
    .toConst() as Vec4
  const beam = direct.below.mul(above.beam).toConst() as Vec4
  const diffuse = sky.below.mul(above.diffuse).add(more).toConst() as Vec4
  const onGround = beam.mul(below.direct).add(diffuse.mul(below.diffuse)).mul(escaping)
  const clouds = beam.mul(below.direct.oneMinus()).add(diffuse.mul(reflected))
  const part = onGround.div(direct.below.add(sky.below).max(1e-20))
  const lower = ground.mul(part.sub(above.diffuse)).add(clouds)
  return plane
    .mul(above.diffuse)
    .add(more.mul(cosNormal.mul(0.5).add(0.5)))
    .add(lower.mul(cosNormal.mul(-0.5).add(0.5)))
    .max(0)
}

/**
 * Irradiance of a plane by sky and ground under and over clouds, for unit irradiance of the source of
 * light, sun or moon.
 *
 * @param offset - Displacement from the field's camera, in the mapped space [m].
 * @param clear - Irradiance without clouds.
 * @param falling - Rain and snow under them; undefined for none.
 */
export function overcastIrradiance(
  field: CloudField,
  light: CloudLight,
  { view, altitude, up, cosLight, cosNormal, isNight }: SkyLitPlane,
  offset: Vec3,
  clear: Vec4,
  falling?: FallingDecks
): Vec4 {
  const decks = decksAround(field, light, offset, altitude, up, cosLight, falling)
  const lights = isNight ? evenLights(view) : lightsAbout(view, decks, altitude, cosLight).lights
  return cloudyIrradiance({ ...lights, plane: clear }, decks.above, decks.below, cosNormal)
}

/** Light without clouds under an even sky, for unit irradiance of level ground. */
function evenLights({ air }: ViewUniforms): Omit<ClearLightNodes, 'plane'> {
  const albedo = air.uniforms.groundAlbedo as unknown as Vec4
  const [none, all] = [vec4(0), vec4(1)]
  const [direct, sky] = [
    { above: none, below: none },
    { here: all, below: all }
  ]
  return { direct, sky, ground: albedo, albedo }
}

/** Light without clouds at an altitude and on the decks about it, for unit irradiance of the source. */
function lightsAbout(
  { air }: ViewUniforms,
  { above, below }: Decks,
  altitude: Float,
  cosLight: Float
): { lights: Omit<ClearLightNodes, 'plane'>; here: { up: Vec4; down: Vec4 } } {
  const { uniforms, transmittance, diffuse } = air
  const directAt = (height: Float): Vec4 =>
    transmittanceToLight(uniforms, transmittance, height, cosLight).mul(cosLight.max(0)).toConst()
  const { up, down } = horizontalIrradiance(uniforms, diffuse!, altitude, cosLight)
  const here = { up: up.toConst() as Vec4, down: down.toConst() as Vec4 }
  const onClouds = horizontalIrradiance(uniforms, diffuse!, below.top, cosLight)
  const lights = {
    direct: { above: directAt(above.top), below: directAt(below.top) },
    sky: { here: here.up, below: onClouds.up.toConst() as Vec4 },
    ground: here.down,
    albedo: uniforms.groundAlbedo as unknown as Vec4
  }
  return { lights, here }
}

/** Greatest ratio of diffuse light among clouds to that without clouds: at dusk there is next to none without. */
export const MOST_DIFFUSE = 10

/**
 * Diffuse light from above and below among clouds, over that without clouds [–].
 *
 * @param view - View of the source's light.
 * @param decks - About the altitude.
 */
export function diffuseRatio(
  view: ViewUniforms,
  decks: Decks,
  altitude: Float,
  cosLight: Float
): Vec4 {
  const { lights, here } = lightsAbout(view, decks, altitude, cosLight)
  const facing = (plane: Vec4, cosNormal: number): Vec4 =>
    cloudyIrradiance({ ...lights, plane }, decks.above, decks.below, float(cosNormal))
  const cloudy = facing(here.up, 1).add(facing(here.down, -1))
  return cloudy.div(here.up.add(here.down).max(1e-20)).min(MOST_DIFFUSE)
}

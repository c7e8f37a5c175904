import { horizontalIrradiance, transmittanceToLight } from '@welkin/atmosphere'
import type { SkyLitPlane, ViewUniforms } from '@welkin/atmosphere'
import { If, float, vec3 } from 'three/tsl'
import type { CloudField } from '../../density/CloudField'
import type { CloudLight } from '../../light/CloudLightTable'
import type { Float, Vec3, Vec4 } from '../../tsl-types'
import { forLayers, layerAt, type LayerNodes } from '../../density/tsl/layer'
import { subpointOffset } from '../../density/tsl/sample'
import { columnDensityAt } from '../../density/tsl/unresolved'
import { filteredCoverageAt } from '../../density/tsl/weather'

/** Transmittances of the cloud decks on one side of a plane: parts of unit flux. Twin: test/twins/overcast.ts */
export interface CloudDeckNodes {
  /** Part of diffuse light that passes. */
  diffuse: Float
  /** Part of direct light that passes, scattered or not. */
  direct: Float
  /** Part of direct light that passes without scattering. */
  beam: Float
}

/** Clouds above or below a place, and the altitude of their tops; its own where there are none [m]. */
export type PlacedDeck = CloudDeckNodes & { top: Float }

/** Cosine of the lowest light; one below it counts as this. */
export const LOWEST_COSINE = 0.05

/**
 * Footprint on the clouds that light a plane: in heights of the clouds above it, and at least [m]. Smaller:
 * light under broken clouds changes with every gap (*Shadows*).
 */
const footprintForm = { heights: 2, least: 1500 } as const

/** Transmittances of a cloud by Eddington's approximation. Twin: test/twins/overcast.ts */
export function eddington(
  thickness: Float,
  cosLight: Float,
  oneMinusAsymmetry: Float
): { diffuse: Float; direct: Float; beam: Float } {
  const beam = thickness.div(cosLight).negate().exp().toConst() as Float
  const diffuse = oneMinusAsymmetry.mul(thickness).mul(0.75).add(1).reciprocal().toConst() as Float
  const direct = cosLight
    .mul(0.75)
    .add(0.5)
    .add(cosLight.mul(-0.75).add(0.5).mul(beam))
    .mul(diffuse)
    .toConst() as Float
  return { diffuse, direct, beam }
}

/** Clouds above and below a place. */
export interface Decks {
  above: PlacedDeck
  below: PlacedDeck
}

/**
 * Clouds above and below a place in the mean, from the weather about it.
 *
 * To be called inside of a shader function.
 *
 * @param offset - From the field's camera, in the mapped space [m].
 */
export function decksAround(
  field: CloudField,
  light: CloudLight,
  offset: Vec3,
  altitude: Float,
  up: Vec3,
  cosLight: Float
): Decks {
  const distance = offset.length().toConst() as Float
  return decksOf(field, light, altitude, cosLight, layer => {
    const rise = layer.baseAltitude.add(layer.thickness.mul(0.5)).sub(altitude).abs()
    const footprint = rise.mul(footprintForm.heights).max(footprintForm.least)
    const seen = distance.max(footprint.div(field.pixelAngle)).toConst() as Float
    const sample = { offset, altitude, up, distance: seen }
    const subpoint = subpointOffset(field, sample).toConst()
    return filteredCoverageAt(field, layer, subpoint, sample)
  })
}

/** Clouds above and below an altitude in the mean over all of a layer, without a look-up. */
export const meanDecks = (
  field: CloudField,
  light: CloudLight,
  altitude: Float,
  cosLight: Float
): Decks => decksOf(field, light, altitude, cosLight, layer => layer.coverage)

/** Clouds above and below an altitude, by the share of the sky that each layer covers. */
function decksOf(
  field: CloudField,
  light: CloudLight,
  altitude: Float,
  cosLight: Float,
  coverageOf: (layer: LayerNodes) => Float
): Decks {
  const mu = cosLight.max(LOWEST_COSINE).toConst() as Float
  /** Sums of 1/t − 1 for diffuse and for direct light, and of tops by the first. */
  const above = vec3(0).toVar() as Vec3
  const below = vec3(0).toVar() as Vec3
  const beam = float(1).toVar()
  forLayers(field, index => {
    const layer = layerAt(field, index)
    If(layer.shadow.mul(layer.coverage).greaterThan(0), () => {
      const filteredCoverage = coverageOf(layer)
      const top = layer.baseAltitude.add(layer.thickness).toConst() as Float
      const depth = layer.density
        .mul(columnDensityAt(layer, filteredCoverage))
        .mul(light.depthScale)
        .toConst() as Float
      const over = top.sub(altitude).clamp(0, layer.thickness).toConst() as Float
      const passing = (part: Float): Float => filteredCoverage.mul(part.sub(1)).add(1)
      const add = (sum: Vec3, length: Float, place: Float): Float => {
        const through = eddington(depth.mul(length), mu, light.oneMinusAsymmetry)
        const series = passing(through.diffuse).reciprocal().sub(1).toConst() as Float
        const direct = passing(through.direct).reciprocal().sub(1)
        sum.addAssign(vec3(series, direct, series.mul(place)))
        return passing(through.beam)
      }
      beam.mulAssign(add(above, over, top))
      add(below, layer.thickness.sub(over), top.min(altitude))
    })
  })
  const deck = (sum: Vec3, through: Float): PlacedDeck => ({
    diffuse: sum.x.add(1).reciprocal().toConst(),
    direct: sum.y.add(1).reciprocal().toConst(),
    beam: through,
    top: sum.x
      .greaterThan(1e-6)
      .select(sum.z.div(sum.x.max(1e-6)), altitude)
      .toConst()
  })
  return { above: deck(above, beam), below: deck(below, float(1)) }
}

/** Light about a plane: see `ClearLight` of test/twins/overcast.ts. */
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
 * geometric series. Twin: test/twins/overcast.ts
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
 * @param offset - From the field's camera, in the mapped space [m].
 * @param clear - What it is without clouds.
 */
export function overcastIrradiance(
  field: CloudField,
  light: CloudLight,
  { view, altitude, up, cosLight, cosNormal }: SkyLitPlane,
  offset: Vec3,
  clear: Vec4
): Vec4 {
  const decks = decksAround(field, light, offset, altitude, up, cosLight)
  const { lights } = lightsAbout(view, decks, altitude, cosLight)
  return cloudyIrradiance({ ...lights, plane: clear }, decks.above, decks.below, cosNormal)
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

/** Most times as bright as without clouds that diffuse light is taken to be: at dusk there is next to none. */
const MOST_DIFFUSE = 10

/**
 * Diffuse light from above and below among clouds, over that without clouds [–].
 *
 * @param view - Of the source's light.
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

import { If, float, mix, vec3 } from 'three/tsl'
import { select } from '../../select'
import type { CloudField } from '../../density/CloudField'
import type { CloudLight } from '../../light/CloudLightTable'
import type { Float, Int, Vec3 } from '../../tsl-types'
import { forLayers, layerAt, type LayerNodes } from '../../density/tsl/layer'
import { subpointOffset } from '../../density/tsl/sample'
import { columnDensityAt } from '../../density/tsl/unresolved'
import { filteredCoverageAt } from '../../density/tsl/weather'
import { footprintForm, LOWEST_COSINE } from '../cpu/decks'

/** Transmittances of the cloud decks on one side of a plane: parts of unit flux. Twin: cpu/decks.ts */
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

/** Transmittances of a cloud by Eddington's approximation. Twin: cpu/decks.ts */
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

/** Rain and snow under a layer, in the mean over the columns from which it falls: `FallColumn` of precipitation/cpu/fallColumn.ts. */
export interface DeckFallNodes {
  /** Share of the clouded columns. */
  share: Float
  /** Optical depths over and under a plane, as light gets through them. */
  over: Float
  under: Float
}

/** Rain and snow that light meets with the decks. */
export interface FallingDecks {
  deckFall(index: Int, altitude: Float): DeckFallNodes
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
 * @param offset - Displacement from the field's camera, in the mapped space [m].
 * @param falling - Rain and snow under them; undefined for none.
 */
export function decksAround(
  field: CloudField,
  light: CloudLight,
  offset: Vec3,
  altitude: Float,
  up: Vec3,
  cosLight: Float,
  falling?: FallingDecks
): Decks {
  const distance = offset.length().toConst() as Float
  return decksOf(field, light, altitude, cosLight, falling, layer => {
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
  cosLight: Float,
  falling?: FallingDecks
): Decks => decksOf(field, light, altitude, cosLight, falling, layer => layer.coverage)

/** Clouds above and below an altitude, by the share of the sky that each layer covers. */
function decksOf(
  field: CloudField,
  light: CloudLight,
  altitude: Float,
  cosLight: Float,
  falling: FallingDecks | undefined,
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
      const fall = falling?.deckFall(index, altitude)
      const passed = (thickness: Float): Vec3 => {
        const { diffuse, direct, beam } = eddington(thickness, mu, light.oneMinusAsymmetry)
        return vec3(diffuse, direct, beam)
      }
      const add = (sum: Vec3, length: Float, place: Float, falls?: Float): Float => {
        const clouds = depth.mul(length).toConst() as Float
        const through = throughFall(clouds, fall?.share, falls, passed)
        const series = passing(through.x).reciprocal().sub(1).toConst() as Float
        const direct = passing(through.y).reciprocal().sub(1)
        sum.addAssign(vec3(series, direct, series.mul(place)))
        return passing(through.z)
      }
      beam.mulAssign(add(above, over, top, fall?.over))
      add(below, layer.thickness.sub(over), top.min(altitude), fall?.under)
    })
  })
  const deck = (sum: Vec3, through: Float): PlacedDeck => ({
    diffuse: sum.x.add(1).reciprocal().toConst(),
    direct: sum.y.add(1).reciprocal().toConst(),
    beam: through,
    top: select(sum.x.greaterThan(1e-6), sum.z.div(sum.x.max(1e-6)), altitude).toConst()
  })
  return { above: deck(above, beam), below: deck(below, float(1)) }
}

/** Light that passes columns of cloud, under a share of which it rains. */
function throughFall(
  clouds: Float,
  share: Float | undefined,
  falls: Float | undefined,
  passed: (thickness: Float) => Vec3
): Vec3 {
  const through = passed(clouds)
  if (share === undefined || falls === undefined) return through.toConst()
  const both = through.toVar() as Vec3
  If(falls.greaterThan(0), () => {
    both.assign(mix(both, passed(clouds.add(falls)), share))
  })
  return both
}

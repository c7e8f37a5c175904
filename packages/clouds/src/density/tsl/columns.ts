import { If, float } from 'three/tsl'
import type { CloudField } from '../CloudField'
import type { Float, Vec3 } from '../../tsl-types'
import { slantCoverFactor, effectiveOpticalDepth } from './unresolved'
import { forLayers, layerAt, type LayerNodes } from './layer'
import { subpointOffset, type CloudSample } from './sample'
import { filteredCoverageAt } from './weather'

/**
 * Cosine of the lowest sun whose rays through a layer grow longer. Smaller: the ground beyond the shadow maps is
 * black at sunset (*World clouds*).
 */
const LOWEST_COSINE = 0.1

/**
 * Goes through layers that cast shadows: the part of each that light crosses on its way to an altitude, and the cosine by which
 * it does. Light from below the horizon comes down, passes its lowest point and climbs again: what it crosses twice counts twice.
 */
function forShadowingLayers(
  field: CloudField,
  altitude: Float,
  cosLight: Float,
  add: (layer: LayerNodes, crossed: Float, slope: Float) => void
): void {
  const slope = cosLight.abs().max(LOWEST_COSINE).toConst() as Float
  const square = cosLight.min(0).mul(cosLight).toConst() as Float
  // R (1 − √(1 − µ²)) without the difference of two that are nearly the same.
  const climb = altitude.add(field.radius).mul(square).div(square.oneMinus().sqrt().add(1))
  const lowest = altitude.sub(climb).toConst() as Float
  forLayers(field, index => {
    const layer = layerAt(field, index)
    const heightOf = (at: Float): Float =>
      at.sub(layer.baseAltitude).mul(layer.perThickness).clamp().toConst()
    const crossed = heightOf(altitude).sub(heightOf(lowest).mul(2)).add(1).toConst() as Float
    If(crossed.mul(layer.shadow).mul(layer.coverage).greaterThan(0), () => {
      add(layer, crossed, slope)
    })
  })
}

/**
 * Optical depth from a place to sun or moon of all clouds that cast shadows, from the weather alone: one
 * look-up a layer, where the ray crosses its middle.
 *
 * @param toLight - Direction to the source of light, in the mapped space.
 */
export function opticalDepthTowards(field: CloudField, sample: CloudSample, toLight: Vec3): Float {
  const { view } = field
  const sum = float(0).toVar()
  const cosLight = sample.up.dot(toLight).toConst() as Float
  forShadowingLayers(field, sample.altitude, cosLight, (layer, crossed, slope) => {
    const middle = layer.baseAltitude.add(layer.thickness.mul(0.5))
    const toMiddle = middle.sub(sample.altitude).mul(cosLight.sign()).max(0).div(slope)
    const offset = sample.offset.add(toLight.mul(toMiddle)).toConst() as Vec3
    const { altitude, up } = view.localCoordinates(offset)
    const there = { offset, altitude, up, distance: sample.distance }
    const subpoint = subpointOffset(field, there).toConst()
    const filteredCoverage = filteredCoverageAt(field, layer, subpoint, there)
    sum.addAssign(slantDepth(field, layer, filteredCoverage, slope).mul(crossed))
  })
  return sum
}

/** Optical depth from an altitude to sun or moon in the mean over clouds and gaps, without a look-up. */
export function meanDepthTowards(field: CloudField, altitude: Float, cosLight: Float): Float {
  const sum = float(0).toVar()
  forShadowingLayers(field, altitude, cosLight, (layer, crossed, slope) => {
    sum.addAssign(slantDepth(field, layer, layer.coverage, slope).mul(crossed))
  })
  return sum
}

/** Optical depth of a layer along a ray of light. */
const slantDepth = (
  field: CloudField,
  layer: LayerNodes,
  filteredCoverage: Float,
  slope: Float
): Float =>
  effectiveOpticalDepth(field, layer, filteredCoverage).mul(slantCoverFactor(layer, slope))

import { If, float, int, log2, smoothstep } from 'three/tsl'
import type { CloudField } from '../CloudField'
import { NOISE_SIZE } from '../noiseSizes'
import { latticeRotation } from '../lattice'
import { CURL_AMOUNT, CURL_PERIOD, densityShape, DETAIL_PERIOD } from '../layerUniforms'
import { CURL_SCALE } from '../noiseRecipes'
import { loop, type Float, type Vec3 } from '../tsl-types'
import { layerAt, rotate, type LayerNodes } from './layer'
import { footOffset, weatherAt, type CloudWeather } from './weather'

/** A place in the air, as seen from the field's camera. */
export interface CloudSample {
  /** From the camera, in the mapped space [m]. */
  offset: Vec3
  /** Above the sphere [m]: `ViewNodes.place(offset).altitude`. */
  altitude: Float
  /** Zenith there, unit length. */
  up: Vec3
  /** From the camera [m]: sets the level of detail. */
  distance: Float
}

const { carvedSharpness, erosion, farFill, leastCarving, smoothSharpness } = densityShape

/** 1 − (2 ĥ^t − 1)²: how much of a layer's air cloud may fill at a height. */
function heightProfile(layer: LayerNodes, height: Float): Float {
  const x = height.clamp(1e-4, 1).pow(layer.profileExponent).mul(2).sub(1)
  return x.mul(x).oneMinus().toConst()
}

/** How fast density grows from the edge of a cloud inwards. */
function sharpnessOf({ shapeAmount }: LayerNodes): Float {
  const carved = shapeAmount.mul(shapeAmount)
  return carved.mul(carvedSharpness - smoothSharpness).add(smoothSharpness)
}

/** Size of a texel below which its level 0 is read. */
const levelOf = (footprint: Float, texel: Float | number): Float =>
  log2(footprint.div(texel).max(1e-3)).max(0)

/** What shape and detail carve out of a filled part of a layer. */
function carving(
  field: CloudField,
  layer: LayerNodes,
  weather: CloudWeather,
  sample: CloudSample,
  height: Float,
  filled: Float,
  detail: boolean
): Float {
  const { shape, detail: frayed } = field.textures
  const turned = layer.turn(sample.offset).toConst()
  const footprint = sample.distance.mul(field.pixelAngle).toConst() as Float
  const place = rotate(latticeRotation.shape, turned.add(weather.shapeWarp)).mul(
    layer.perShapePeriod
  )
  const level = levelOf(footprint, float(1 / NOISE_SIZE.shape).div(layer.perShapePeriod))
  const noise = shape.sample(place.add(layer.shapeAnchor)).level(level).toConst()
  const heads = noise.x.add(noise.y.sub(0.5).mul(0.3))
  const left = filled
    .sub(layer.shapeAmount.mul(heads.oneMinus().max(leastCarving)))
    .toVar() as Float & { subAssign: (n: Float) => void }
  const most = layer.detailAmount.mul(erosion).toConst() as Float
  if (!detail) return left.sub(most.mul(0.5))
  // Deep inside, the most that detail takes away changes nothing.
  If(left.greaterThan(0).and(left.lessThan(most.add(sharpnessOf(layer).reciprocal()))), () => {
    const fine = rotate(latticeRotation.detail, turned.add(weather.detailWarp))
      .div(DETAIL_PERIOD)
      .add(layer.detailAnchor)
      .toConst()
    const fineLevel = levelOf(footprint, DETAIL_PERIOD / NOISE_SIZE.detail).toConst() as Float
    const curl = frayed.sample(fine.div(CURL_PERIOD)).level(fineLevel).yzw
    const stirred = fine.add(curl.sub(0.5).mul(CURL_AMOUNT / CURL_SCALE))
    const fray = frayed.sample(stirred).level(fineLevel).x.toConst() as Float
    // Wisps below, heads above.
    const wispy = smoothstep(0.1, 0.35, height)
    left.subAssign(most.mul(wispy.mix(fray, fray.oneMinus())))
  })
  return left
}

/** Share of a cell's light that its clouds take, as if they were spread evenly over it. */
export function spreadDensity(layer: LayerNodes, weather: CloudWeather): Float {
  const depth = layer.density.mul(layer.thickness).mul(farFill).max(1e-4).toConst() as Float
  const blocked = weather.cover.mul(depth.negate().exp().oneMinus())
  // Of thick clouds nothing comes through, in float32.
  return blocked.oneMinus().max(1e-30).log().negate().div(depth)
}

/** Calls back for each layer whose altitudes include the sample's. */
function eachLayer(
  field: CloudField,
  sample: CloudSample,
  body: (layer: LayerNodes, weather: CloudWeather, height: Float) => void
): void {
  const foot = footOffset(field, sample).toConst()
  loop('cloudLayer', field.layers.length, index => {
    const layer = layerAt(field, index)
    const height = sample.altitude
      .sub(layer.baseAltitude)
      .mul(layer.perThickness)
      .toConst() as Float
    const isInside = height
      .greaterThan(0)
      .and(height.lessThan(1))
      .and(layer.coverage.greaterThan(0))
    If(isInside, () => body(layer, weatherAt(field, layer, foot, sample), height))
  })
}

/**
 * Extinction of the clouds at a place: the one answer to where the clouds are.
 *
 * @param detail - Whether to fray the edges; without, clouds keep their mean size.
 * @returns [1/m], at least 0. Twin: cpu/density.ts
 */
export function cloudExtinction(field: CloudField, sample: CloudSample, detail: boolean): Float {
  const sum = float(0).toVar()
  eachLayer(field, sample, (layer, weather, height) => {
    const profile = heightProfile(layer, height)
    const filled = weather.fill.mul(profile).toConst() as Float
    const near = float(0).toVar()
    If(filled.greaterThan(layer.shapeAmount.mul(leastCarving)), () => {
      const left = carving(field, layer, weather, sample, height, filled, detail)
      near.assign(left.mul(sharpnessOf(layer)).clamp(0, 1))
    })
    const far = spreadDensity(layer, weather).mul(profile)
    sum.addAssign(layer.density.mul(weather.spread.mix(near, far)))
  })
  return sum
}

/**
 * Upper bound on how full of cloud a place is, from the weather alone: where it is 0 there is no cloud,
 * whatever the noise. One or two texture reads a layer.
 *
 * @returns In [0, 1].
 */
export function cloudBound(field: CloudField, sample: CloudSample): Float {
  const most = float(0).toVar()
  eachLayer(field, sample, (layer, weather, height) => {
    const filled = weather.fill.mul(heightProfile(layer, height))
    const near = filled.sub(layer.shapeAmount.mul(leastCarving)).mul(sharpnessOf(layer)).clamp(0, 1)
    const far = weather.spread.greaterThan(0).select(weather.cover, float(0))
    most.assign(most.max(near).max(far))
  })
  return most
}

/**
 * Vertical optical depth of all clouds above or below a place of the ground, from the weather alone.
 *
 * @param sample - Any altitude: that is not looked at, but `offset` must agree with it.
 */
export function cloudColumn(field: CloudField, sample: CloudSample): Float {
  const foot = footOffset(field, sample).toConst()
  const sum = float(0).toVar()
  loop('cloudColumnLayer', field.layers.length, index => {
    const layer = layerAt(field, int(index))
    const weather = weatherAt(field, layer, foot, sample)
    const depth = layer.density.mul(layer.thickness).mul(farFill)
    sum.addAssign(depth.mul(spreadDensity(layer, weather)))
  })
  return sum
}

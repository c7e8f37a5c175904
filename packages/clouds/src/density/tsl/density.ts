import { If, float, int, log2, smoothstep, vec2, vec3, vec4 } from 'three/tsl'
import type { CloudField } from '../CloudField'
import {
  anvilDensity,
  anvilFill,
  anvilMean,
  anvilReach,
  erosion,
  moreFibres,
  mostFibres,
  thinFibres,
  leastCarving,
  lostCarving,
  shapeBlur,
  solidFill,
  tallness
} from '../densityShape'
import { NOISE_SIZE } from '../../noise/noiseSizes'
import { latticeRotation } from '../lattice'
import { CURL_AMOUNT, CURL_PERIOD, DETAIL_PERIOD } from '../../layers/layerUniforms'
import { CURL_SCALE } from '../../noise/noiseRecipes'
import type { Bool, Float, Int, Vec2, Vec3, Vec4 } from '../../tsl-types'
import { forLayers, layerAt, rotate, type LayerNodes, type LayerRange } from './layer'
import { footOffset, type CloudSample } from './sample'
import { squared, weatherAt, type CloudWeather } from './weather'

/** Farther than any cloud [m]. */
const NOWHERE = 1e6

/**
 * Distances over which the fill of a layer changes by 1 at least: where its weather is steepest, in
 * periods of the weather, and where its shape is besides, in periods of the shape.
 */
const STEEPEST_WEATHER = 0.03
const STEEPEST_SHAPE = 0.05

/** Heights in a layer between which towers become anvils. */
const ANVIL = [0.62, 0.8] as const

/** How much of a layer's anvil is at a height, in [0, 1]. */
const anvilAt = (layer: LayerNodes, height: Float): Float =>
  layer.anvil.mul(smoothstep(...ANVIL, height)).toConst()

/** 1 − (2 ĥ^t − 1)²: how much of a layer's air cloud may fill at a height. Anvils are full up to the top. */
function heightProfile(layer: LayerNodes, height: Float, anvil: Float): Float {
  const x = height.clamp(1e-4, 1).pow(layer.profileExponent).mul(2).sub(1)
  return anvil.mix(x.mul(x).oneMinus(), smoothstep(1, 0.9, height)).toConst()
}

/** Size of a texel below which its level 0 is read. */
const levelOf = (footprint: Float, texel: Float | number): Float =>
  log2(footprint.div(texel).max(1e-3)).max(0)

/** What shape and detail leave of a filled part of a layer, and what the shape alone takes. */
function carving(
  field: CloudField,
  layer: LayerNodes,
  weather: Pick<CloudWeather, 'shapeWarp' | 'detailWarp'>,
  sample: CloudSample,
  height: Float,
  filled: Float,
  detail: boolean
): { left: Float; carved: Float } {
  const { shape, detail: frayed } = field.textures
  const stretch = vec3(layer.perStretch, layer.perStretch, 1)
  const turned = layer.turn(sample.offset).mul(stretch).toConst() as Vec3
  const footprint = sample.distance.mul(field.pixelAngle).toConst() as Float
  const place = rotate(
    latticeRotation.shape,
    turned.add(weather.shapeWarp.mul(layer.perStretch))
  ).mul(layer.perShapePeriod)
  const level = levelOf(footprint, float(1 / NOISE_SIZE.shape).div(layer.perShapePeriod))
  const noise = shape.sample(place.add(layer.shapeAnchor)).level(level).toConst()
  const heads = noise.x
    .add(noise.y.sub(0.5).mul(0.3))
    .add(smoothstep(0, shapeBlur, level).mul(lostCarving))
  const carved = layer.shapeAmount.mul(heads.oneMinus().max(leastCarving)).toConst() as Float
  const left = filled.sub(carved).toVar() as Float & { subAssign: (n: Float) => void }
  const most = layer.detailAmount.mul(erosion).toConst() as Float
  if (!detail) return { left: left.sub(most.mul(0.5)), carved }
  // Deep inside, the most that detail takes away changes nothing.
  If(left.greaterThan(0).and(left.lessThan(most.add(layer.sharpness.reciprocal()))), () => {
    const fine = rotate(
      latticeRotation.detail,
      turned.add(weather.detailWarp.mul(layer.perStretch))
    )
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
  return { left, carved }
}

/** Mean density of a cloudy column over the densest. */
export function columnFill(layer: LayerNodes, { cover }: Pick<CloudWeather, 'cover'>): Float {
  const square = squared(cover, 1)
  const fibres = square.mul(moreFibres).add(squared(square, 5).mul(mostFibres)).add(thinFibres)
  return layer.fibrous.mix(layer.anvil.mix(solidFill, anvilFill), fibres).toConst()
}

/** Optical depth of a cloud from top to base, as it counts in the light that comes through. */
const columnOf = (
  { depthScale }: CloudField,
  layer: LayerNodes,
  weather: Pick<CloudWeather, 'cover'>
): Float =>
  layer.density
    .mul(layer.thickness)
    .mul(columnFill(layer, weather))
    .mul(depthScale)
    .max(1e-4)
    .toConst()

/** Optical depth that takes as much light as the clouds of a cell do, were they spread evenly over it. */
export function spreadDepth(
  field: CloudField,
  layer: LayerNodes,
  weather: Pick<CloudWeather, 'cover'>
): Float {
  const blocked = weather.cover.mul(columnOf(field, layer, weather).negate().exp().oneMinus())
  // Of thick clouds nothing comes through, in float32.
  return blocked.oneMinus().max(1e-30).log().negate().div(field.depthScale).toConst()
}

/** Mean over a layer's heights of what clouds fill that are not seen one by one. */
function profileMean(layer: LayerNodes): Float {
  const e = layer.profileExponent
  return layer.anvil.mix(e.mul(4).div(e.add(1).mul(e.mul(2).add(1))), anvilMean)
}

/** Least cosine between a ray and the zenith by which clouds are taken to hide more. */
const LEAST_COSINE = 0.05

/**
 * How much more of the sky a layer's clouds hide along a ray than straight up, as a factor of the optical
 * depth that they have, spread evenly: tall ones are seen from the side as well, flat ones are not.
 */
export function asideFactor(layer: LayerNodes, cosine: Float): Float {
  const tall = layer.thickness.mul(layer.perWeatherPeriod).mul(tallness).min(1)
  return tall.mix(1, cosine.abs().max(LEAST_COSINE).reciprocal())
}

/** Between two densities, such that the light that columns of them let through is mixed. */
function mixedDensity(depth: Float, a: Float, b: Float, share: Float): Float {
  const through = share.mix(a.mul(depth).negate().exp(), b.mul(depth).negate().exp())
  return through.max(1e-30).log().negate().div(depth)
}

/** Height in a layer from 0 to 1. */
const heightIn = (layer: LayerNodes, altitude: Float): Float =>
  altitude.sub(layer.baseAltitude).mul(layer.perThickness).toConst()

/** Whether clouds of a layer may be at a height in it. */
const mayHold = (layer: LayerNodes, height: Float): Bool =>
  height.greaterThan(0).and(height.lessThan(1)).and(layer.coverage.greaterThan(0))

/** Calls back for each layer whose altitudes include the sample's. */
function eachLayer(
  field: CloudField,
  sample: CloudSample,
  body: (layer: LayerNodes, weather: CloudWeather, height: Float) => void
): void {
  const foot = footOffset(field, sample).toConst()
  forLayers(field, index => {
    const layer = layerAt(field, index)
    const height = heightIn(layer, sample.altitude)
    If(mayHold(layer, height), () => {
      body(layer, weatherAt(field, layer, foot, sample, 'where spread'), height)
    })
  })
}

/**
 * Fill of a layer at a height: below anvils, towers are narrower than what they cover.
 */
const fillAt = (layer: LayerNodes, { fill }: Pick<CloudWeather, 'fill'>, anvil: Float): Float =>
  fill.sub(layer.anvil.sub(anvil).mul(anvilReach)).clamp(0, 1.3)

/** Weather without what only the region has to say. */
type LocalWeather = Pick<CloudWeather, 'fill' | 'cover' | 'spread' | 'shapeWarp' | 'detailWarp'>

/** What there is of a layer at a place. */
interface CloudMatter {
  /** [1/m], at least 0. */
  readonly extinction: Float
  /** Distance in which there is nothing of the layer, within its altitudes; 0 in clouds [m]. */
  readonly clearance: Float
}

/** What clouds that are not seen one by one are to stand for. */
type Unseen =
  /** Their mean over the sky. */
  | 'mean'
  /** The inside of one. */
  | 'inside'

/** Whether there may be cloud of a layer in a weather, whatever the noise. */
const mayFill = (layer: LayerNodes, { fill, spread, cover }: LocalWeather): Bool =>
  fill.greaterThan(layer.shapeAmount.mul(leastCarving)).or(spread.mul(cover).greaterThan(0))

/** Distance in which the weather lets no cloud of a layer be, whatever the height: profiles are steep [m]. */
const clearanceIn = (layer: LayerNodes, { fill }: LocalWeather): Float =>
  layer.shapeAmount
    .mul(leastCarving)
    .sub(fill)
    .mul(STEEPEST_WEATHER)
    .div(layer.perWeatherPeriod)
    .max(0)

/**
 * Distance from a place in which no cloud is, whatever the noise [m].
 */
export function clearanceAt(field: CloudField, sample: CloudSample): Float {
  const clearance = float(NOWHERE).toVar()
  const foot = footOffset(field, sample).toConst()
  forLayers(field, index => {
    const layer = layerAt(field, index)
    If(layer.coverage.greaterThan(0), () => {
      const weather = weatherAt(field, layer, foot, sample, 'where spread')
      const isSeen = weather.spread.mul(weather.cover).equal(0)
      const { altitude } = sample
      const { baseAltitude, thickness } = layer
      const apart = baseAltitude.sub(altitude).max(altitude.sub(baseAltitude).sub(thickness))
      const clear = isSeen.select(clearanceIn(layer, weather), 0).max(apart)
      clearance.assign(clearance.min(clear))
    })
  })
  return clearance
}

/**
 * One layer in a given weather.
 *
 * @param height - In the layer, in (0, 1).
 * @param direction - Of the ray on which clouds are met, as far as they are not seen one by one; if it is
 *   left out, it goes straight up.
 */
function layerMatter(
  field: CloudField,
  layer: LayerNodes,
  weather: LocalWeather,
  sample: CloudSample,
  height: Float,
  detail: boolean,
  unseen: Unseen = 'mean',
  direction?: Vec3
): CloudMatter {
  const anvil = anvilAt(layer, height)
  const profile = heightProfile(layer, height, anvil)
  const { fill, spread, cover } = weather
  const filled = fillAt(layer, weather, anvil).mul(profile).toConst() as Float
  const density = float(0).toVar()
  const least = layer.shapeAmount.mul(leastCarving).toConst() as Float
  const clearance = clearanceIn(layer, weather).toVar() as Float
  If(filled.greaterThan(least), () => {
    const { left, carved } = carving(field, layer, weather, sample, height, filled, detail)
    density.assign(left.mul(layer.sharpness).clamp(0, 1))
    clearance.assign(carved.sub(fill).mul(STEEPEST_SHAPE).div(layer.perShapePeriod))
  })
  If(spread.mul(cover).greaterThan(0), () => {
    // Of towers with anvils, these are what is seen from afar.
    const hidden = profile.mul(layer.anvil.mix(1, smoothstep(...ANVIL, height)))
    const whole =
      unseen === 'mean'
        ? spreadDepth(field, layer, weather)
            .mul(layer.perThickness)
            .div(layer.density.mul(profileMean(layer)).max(1e-9))
        : columnFill(layer, weather).max(layer.anvil)
    const depth = columnOf(field, layer, weather)
    const cosine = direction?.dot(sample.up).toConst() as Float | undefined
    const aside = cosine === undefined ? float(1) : asideFactor(layer, cosine).mul(cosine.abs())
    density.assign(mixedDensity(depth, density, whole.mul(hidden).mul(aside).toConst(), spread))
    clearance.assign(float(0))
  })
  return {
    extinction: layer.density.mul(density).mul(anvil.mix(1, anvilDensity)).toConst(),
    clearance: clearance.max(0).toConst()
  }
}

/** The weather of a place, kept for places nearby: of the layer that is densest there. */
export interface KeptWeather {
  /** Fill, cover, spread, and the layer's index. */
  readonly values: Vec4
  readonly shapeWarp: Vec3
}

/** What a march learns of two places. */
export interface PairMatter {
  /** At the first and at the second place [1/m]. */
  readonly extinction: Vec2
  /** From the second, if there is no cloud at either: see `CloudMatter` [m]. */
  readonly clearance: Float
  readonly weather: KeptWeather
}

/**
 * Clouds at two places near each other, with detail, in the weather in the middle between them: looking
 * that up takes longer than the rest, and it is kilometres wide.
 *
 * @param middle - All three have to be within the altitudes of the same layers.
 * @param samples - Make the samples, where they are needed.
 * @param direction - Of the ray that both are on.
 * @param range - The layers that are looked at.
 */
export function pairMatter(
  field: CloudField,
  middle: CloudSample,
  samples: readonly (() => CloudSample)[],
  direction: Vec3,
  range: LayerRange
): PairMatter {
  const sum = vec2(0).toVar() as Vec2
  const clearance = float(NOWHERE).toVar()
  const values = vec4(0).toVar() as Vec4
  const shapeWarp = vec3(0).toVar() as Vec3
  const most = float(0).toVar()
  const foot = footOffset(field, middle).toConst()
  const look = (index: Int): void => {
    const layer = layerAt(field, index)
    If(mayHold(layer, heightIn(layer, middle.altitude)), () => {
      const weather = weatherAt(field, layer, foot, middle, 'where spread')
      const found = vec2(0).toVar() as Vec2
      const clear = clearanceIn(layer, weather).toVar() as Float
      If(mayFill(layer, weather), () => {
        samples.forEach((sampleAt, i) => {
          const sample = sampleAt()
          const height = heightIn(layer, sample.altitude)
          const matter = layerMatter(field, layer, weather, sample, height, true, 'mean', direction)
          found.addAssign(i === 0 ? vec2(matter.extinction, 0) : vec2(0, matter.extinction))
          if (i === 1) clear.assign(matter.clearance)
        })
      })
      clearance.assign(clearance.min(clear))
      sum.addAssign(found)
      const both = found.x.add(found.y).toConst() as Float
      If(both.greaterThan(most), () => {
        most.assign(both)
        values.assign(vec4(weather.fill, weather.cover, weather.spread, float(index)))
        shapeWarp.assign(weather.shapeWarp)
      })
    })
  }
  forLayers(field, look, range)
  return { extinction: sum, clearance, weather: { values, shapeWarp } }
}

/**
 * Extinction near a place whose weather was kept, of its densest layer, without detail [1/m]: a single
 * texture read. Good as far as the weather is the same. Of clouds that are not seen one by one, that inside
 * of them: what light meets there is not their mean.
 */
export function extinctionNearby(
  field: CloudField,
  { values, shapeWarp }: KeptWeather,
  sample: CloudSample
): Float {
  const isOne = field.layers.length === 1
  const layer = layerAt(field, isOne ? int(0) : values.w.toInt())
  const height = heightIn(layer, sample.altitude)
  const extinction = float(0).toVar()
  If(height.greaterThan(0).and(height.lessThan(1)), () => {
    const weather = {
      fill: values.x,
      cover: values.y,
      spread: values.z,
      shapeWarp,
      detailWarp: shapeWarp
    }
    extinction.assign(
      layerMatter(field, layer, weather, sample, height, false, 'inside').extinction
    )
  })
  return extinction
}

/**
 * Two samples of a layer near each other, without detail, in the weather in the middle between them.
 *
 * @param add - Takes each sample's extinction [1/m].
 */
export function layerPair(
  field: CloudField,
  layer: LayerNodes,
  middle: CloudSample,
  samples: readonly [CloudSample, CloudSample],
  add: (extinction: Float, index: number) => void
): void {
  const foot = footOffset(field, middle).toConst()
  const weather = weatherAt(field, layer, foot, middle, 'where spread')
  samples.forEach((sample, i) => {
    const height = heightIn(layer, sample.altitude)
    If(mayHold(layer, height), () => {
      add(layerMatter(field, layer, weather, sample, height, false).extinction, i)
    })
  })
}

/**
 * Extinction of the clouds at a place: the one answer to where the clouds are.
 *
 * @param detail - Whether to fray the edges; without, clouds keep their mean size.
 * @returns [1/m], at least 0. Twin: test/twins/density.ts
 */
export function cloudExtinction(field: CloudField, sample: CloudSample, detail: boolean): Float {
  const sum = float(0).toVar()
  eachLayer(field, sample, (layer, weather, height) => {
    sum.addAssign(layerMatter(field, layer, weather, sample, height, detail).extinction)
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
    const anvil = anvilAt(layer, height)
    const filled = fillAt(layer, weather, anvil).mul(heightProfile(layer, height, anvil))
    const near = filled.sub(layer.shapeAmount.mul(leastCarving)).mul(layer.sharpness).clamp(0, 1)
    const far = weather.spread.greaterThan(0).select(weather.cover, float(0))
    most.assign(most.max(near).max(far))
  })
  return most
}

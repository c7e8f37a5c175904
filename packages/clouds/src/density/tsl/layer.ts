import { int, vec3 } from 'three/tsl'
import { Matrix4, type Quaternion } from 'three'
import type { CloudField } from '../CloudField'
import { LAYER_STRIDE } from '../../layers/layerUniforms'
import { loop, type Bool, type Float, type Int, type Vec3, type Vec4 } from '../../tsl-types'

/** A vector turned by a constant rotation. */
export const rotate = (rotation: Quaternion, v: Vec3): Vec3 => {
  const { elements: e } = new Matrix4().makeRotationFromQuaternion(rotation)
  // Three builds constant matrices row by row, variable ones column by column.
  const [x, y, z] = [0, 1, 2].map(row => vec3(e[row], e[row + 4], e[row + 8]).dot(v))
  return vec3(x, y, z)
}

/** A layer's uniforms: names and units of `CloudLayerParameters` where they are the same. */
export interface LayerNodes {
  baseAltitude: Float
  /** 1 / (top − base) [1/m]. */
  perThickness: Float
  thickness: Float
  coverage: Float
  density: Float
  profileExponent: Float
  shapeAmount: Float
  detailAmount: Float
  densityGrowth: Float
  /** Share of an anvil, in [0, 1]. */
  anvil: Float
  /** 1 if the layer casts shadows, or 0. */
  shadow: Float
  /** Periods of the noise, as reciprocals [1/m]. */
  perShapePeriod: Float
  perDetailPeriod: Float
  perWeatherPeriod: Float
  /** Displacement of the weather's look-up by turbulence, for a curl of unit deviation [m]. */
  bend: Float
  /** Displacement of columns with height, for a height of 1 m, times `cross(·, zenith)` [m]. */
  shearAxis: Vec3
  /** `weatherScales`: of single clouds. */
  weights: Vec4
  /** Factors of the weather's other scales: `weatherScales`. */
  cells: Float
  regions: Float
  planet: Float
  cloudVariance: Float
  /** `layerForms`; the reciprocals of its stretch and its edge. */
  perStretch: Float
  fibrous: Float
  perEdge: Float
  coarseness: Float
  /** `meanColumn`. */
  columnDensity: Float
  insideDensity: Float
  profileMean: Float
  /** Anchors: the camera or its subpoint in the periods of the noise, in [0, 1). */
  weatherAnchor: Vec3
  fieldAnchor: Vec3
  regionAnchor: Vec3
  shapeAnchor: Vec3
  detailAnchor: Vec3
  /** Turns displacements in the mapped space into the frame that drifts with the layer. */
  mappedToLayer: (displacement: Vec3) => Vec3
}

/** Reads a layer; `CloudField` writes what this reads. */
export function layerAt(field: CloudField, index: Int): LayerNodes {
  const start = index.mul(int(LAYER_STRIDE)).toConst()
  const read = (slot: number): Vec4 => field.array.element(start.add(int(slot)))
  const once = (slot: number): Vec4 => read(slot).toConst() as Vec4
  const extent = once(0)
  const form = once(1)
  const weather = once(6)
  const region = once(7)
  const shape = once(8)
  const detail = once(9)
  const fields = once(10)
  const kind = once(11)
  const shear = once(12)
  const column = once(13)
  const edges = once(14)
  return {
    baseAltitude: extent.x,
    perThickness: extent.y,
    thickness: extent.y.reciprocal(),
    coverage: extent.z,
    density: extent.w,
    profileExponent: form.x,
    shapeAmount: form.y,
    detailAmount: form.z,
    perShapePeriod: form.w,
    weights: read(2),
    perEdge: read(3).w,
    coarseness: read(4).w,
    fibrous: read(5).w,
    weatherAnchor: weather.xyz,
    perWeatherPeriod: weather.w,
    regionAnchor: region.xyz,
    shadow: region.w,
    shapeAnchor: shape.xyz,
    perStretch: shape.w,
    detailAnchor: detail.xyz,
    perDetailPeriod: detail.w,
    fieldAnchor: fields.xyz,
    anvil: fields.w,
    cells: kind.x,
    regions: kind.y,
    planet: kind.z,
    cloudVariance: kind.w,
    shearAxis: shear.xyz,
    bend: shear.w,
    columnDensity: column.x,
    insideDensity: column.y,
    profileMean: column.z,
    densityGrowth: edges.x,
    mappedToLayer: v => {
      const [x, y, z] = [3, 4, 5].map(row => read(row).xyz.dot(v))
      return vec3(x, y, z)
    }
  }
}

/** Height in a layer, from 0 at its base to 1 at its top. */
export const heightIn = (layer: LayerNodes, altitude: Float): Float =>
  altitude.sub(layer.baseAltitude).mul(layer.perThickness).toConst()

/** True for heights within a layer that covers anything. */
export const isWithin = (layer: LayerNodes, height: Float): Bool =>
  height.greaterThan(0).and(height.lessThan(1)).and(layer.coverage.greaterThan(0))

/** Layers that follow each other: from the first one to before the last. */
export interface LayerRange {
  readonly first: Int
  readonly last: Int
}

/**
 * Calls back for each layer, with code for one if there is one. Not to be nested.
 *
 * @param range - Which ones; all if it is left out.
 */
export function forLayers(field: CloudField, body: (index: Int) => void, range?: LayerRange): void {
  const { length } = field.layers
  if (length === 1) body(int(0))
  else loop('layer', range?.last ?? length, body, range?.first)
}

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
  /** 1 if the layer casts shadows, or 0. */
  shadow: Float
  /** [1/m]. */
  perShapePeriod: Float
  /** [1/m]. */
  perWeatherPeriod: Float
  /** `weatherScales`: of single clouds. */
  weights: Vec4
  /** Factors of the weather's other scales: `weatherScales`. */
  cells: Float
  regions: Float
  planet: Float
  cloudVariance: Float
  /** `layerForms`; the reciprocal of its stretch. */
  perStretch: Float
  fibrous: Float
  steepness: Float
  sharpness: Float
  coarseness: Float
  anvil: Float
  /**
   * Where the eye and its foot point lie in the periods of the noise, in [0, 1); for detail in
   * [0, `CURL_PERIOD`), since the turbulence has that period.
   */
  weatherAnchor: Vec3
  fieldAnchor: Vec3
  regionAnchor: Vec3
  shapeAnchor: Vec3
  detailAnchor: Vec3
  /** Displacements in the mapped space to the frame that drifts with the layer. */
  mappedToLayer: (displacement: Vec3) => Vec3
}

/** Reads a layer; `CloudField` writes what this reads. */
export function layerAt(field: CloudField, index: Int): LayerNodes {
  const start = index.mul(int(LAYER_STRIDE)).toConst()
  const read = (slot: number): Vec4 => field.array.element(start.add(int(slot)))
  const extent = read(0).toConst() as Vec4
  const form = read(1).toConst() as Vec4
  const weather = read(6).toConst() as Vec4
  const fields = read(10).toConst() as Vec4
  const shape = read(8).toConst() as Vec4
  const detail = read(9).toConst() as Vec4
  const kind = read(11).toConst() as Vec4
  return {
    baseAltitude: extent.x,
    perThickness: extent.y,
    thickness: extent.y.reciprocal(),
    coverage: extent.z,
    density: extent.w,
    profileExponent: form.x,
    shapeAmount: form.y,
    detailAmount: form.z,
    shadow: read(7).w,
    perShapePeriod: form.w,
    weights: read(2),
    perWeatherPeriod: weather.w,
    weatherAnchor: weather.xyz,
    fieldAnchor: fields.xyz,
    regionAnchor: read(7).xyz,
    shapeAnchor: shape.xyz,
    detailAnchor: detail.xyz,
    cells: kind.x,
    regions: kind.y,
    planet: kind.z,
    cloudVariance: kind.w,
    perStretch: shape.w,
    fibrous: read(5).w,
    steepness: read(3).w,
    sharpness: read(4).w,
    coarseness: detail.w,
    anvil: fields.w,
    mappedToLayer: v => {
      const [x, y, z] = [3, 4, 5].map(row => read(row).xyz.dot(v))
      return vec3(x, y, z)
    }
  }
}

/** Height in a layer, from 0 at its base to 1 at its top. */
export const heightIn = (layer: LayerNodes, altitude: Float): Float =>
  altitude.sub(layer.baseAltitude).mul(layer.perThickness).toConst()

/** Whether a height is within a layer that covers anything. */
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

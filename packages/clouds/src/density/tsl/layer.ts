import { If, int, vec3, vec4 } from 'three/tsl'
import { Matrix4, type Quaternion } from 'three'
import type { CloudField } from '../CloudField'
import { hasStorms } from '../kinds'
import { latticeRotations, layerRotation } from '../lattice'
import { LAYER_STRIDE, MESOSCALE_PER_REGIONS, noisePeriods } from '../../layers/layerUniforms'
import { loop, type Bool, type Float, type Int, type Vec3, type Vec4 } from '../../tsl-types'

/** Place in a lattice of noise, in its periods, of a displacement in the mapped space [m]. */
export type Lattice = (displacement: Vec3) => Vec3

/** A layer's uniforms: names and units of `CloudLayerParameters` where they are the same. */
export interface LayerNodes {
  /** Index among the layers, from 0. */
  index: Int
  /** True for a layer of storms, false for others; undefined where the shader is to find out. */
  hasStorms: boolean | undefined
  baseAltitude: Float
  /** 1 / (top − base) [1/m]. */
  perThickness: Float
  thickness: Float
  coverage: Float
  density: Float
  profileExponent: Float
  /** Reciprocal of the height in the layer up to which bases rise, and strength needed at height 0 [–]. */
  perBaseRelief: Float
  relief: Float
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
  mesoscale: Float
  regions: Float
  planet: Float
  cloudVariance: Float
  /** `layerForms`; the reciprocal of its edge. */
  perEdge: Float
  coarseness: Float
  /** `meanColumn`. */
  columnDensity: Float
  fullDensity: Float
  insideDensity: Float
  profileMean: Float
  /** Lattices for displacements from the camera. */
  shapeLattice: Lattice
  detailLattice: Lattice
  /** Lattices for displacements from the camera's subpoint. */
  weatherLattice: Lattice
  fieldLattice: Lattice
  mesoscaleLattice: Lattice
  regionLattice: Lattice
  /** Turns displacements into the fields' lattice, in its periods [1/m]. */
  displacementInFields: (displacement: Vec3) => Vec3
  /** Turns directions into the fields' lattice, unit length. */
  directionInFields: (direction: Vec3) => Vec3
  /**
   * Turns directions into the frame that drifts with the weather of the first layer, and at first is the planet's; and
   * back.
   */
  directionInSystems: (direction: Vec3) => Vec3
  directionFromSystems: (direction: Vec3) => Vec3
}

/** Rotation from the frame of fronts and belts to the regions' lattice, of the first layer. */
const toRegions = /*#__PURE__*/ latticeRotations.region.clone().multiply(layerRotation(0))
const fromRegions = /*#__PURE__*/ toRegions.clone().invert()

/** A vector turned by a constant rotation. */
const rotate = (rotation: Quaternion, v: Vec3): Vec3 => {
  const { elements: e } = new Matrix4().makeRotationFromQuaternion(rotation)
  // Three builds constant matrices row by row, variable ones column by column.
  const [x, y, z] = [0, 1, 2].map(row => vec3(e[row], e[row + 4], e[row + 8]).dot(v))
  return vec3(x, y, z)
}

/** Reads a layer, by an index that the compiler may know; `CloudField` writes what this reads. */
export function layerAt(field: CloudField, index: Int, known?: number): LayerNodes {
  const start = index.mul(int(LAYER_STRIDE)).toConst()
  const read = (slot: number): Vec4 => field.array.element(start.add(int(slot)))
  const once = (slot: number): Vec4 => read(slot).toConst()
  const [extent, form, shear, kind, column, edges, periods] = [0, 1, 18, 19, 20, 21, 22].map(once)
  const bases = once(23)
  const lattice =
    (slot: number): Lattice =>
    v => {
      const point = vec4(v, 1).toConst()
      const [x, y, z] = [0, 1, 2].map(row => read(slot + row).dot(point))
      return vec3(x, y, z)
    }
  const turn = (slot: number, v: Vec3): Vec3 => {
    const [x, y, z] = [0, 1, 2].map(row => read(slot + row).xyz.dot(v))
    return vec3(x, y, z)
  }
  return {
    index,
    hasStorms: hasStorms(field, known),
    baseAltitude: extent.x,
    perThickness: extent.y,
    thickness: extent.y.reciprocal(),
    coverage: extent.z,
    density: extent.w,
    profileExponent: form.x,
    perBaseRelief: bases.x,
    relief: bases.y,
    shapeAmount: form.y,
    detailAmount: form.z,
    perShapePeriod: form.w,
    weights: read(2),
    shapeLattice: lattice(3),
    detailLattice: lattice(6),
    weatherLattice: lattice(9),
    fieldLattice: lattice(12),
    mesoscaleLattice: lattice(24),
    regionLattice: lattice(15),
    displacementInFields: v => turn(12, v),
    directionInFields: v => turn(12, v).normalize(),
    directionInSystems: v => rotate(fromRegions, turn(15, v).mul(noisePeriods.regions).toConst()),
    directionFromSystems: v => {
      const inRegions = rotate(toRegions, v).mul(noisePeriods.regions).toConst() as Vec3
      const [x, y, z] = [0, 1, 2].map(row =>
        read(15 + row).xyz.mul([inRegions.x, inRegions.y, inRegions.z][row])
      )
      return x.add(y).add(z)
    },
    shearAxis: shear.xyz,
    bend: shear.w,
    cells: kind.x,
    mesoscale: kind.y.mul(MESOSCALE_PER_REGIONS),
    regions: kind.y,
    planet: kind.z,
    cloudVariance: kind.w,
    columnDensity: column.x,
    insideDensity: column.y,
    profileMean: column.z,
    densityGrowth: column.w,
    perEdge: edges.x,
    coarseness: edges.y,
    anvil: edges.z,
    shadow: edges.w,
    perWeatherPeriod: periods.x,
    perDetailPeriod: periods.y,
    fullDensity: periods.z
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
 * @param range - Range of their indices; all if it is left out.
 */
export function forLayers(field: CloudField, body: (index: Int) => void, range?: LayerRange): void {
  const { length } = field.layers
  if (length === 1) body(int(0))
  else loop('layer', range?.last ?? length, body, range?.first)
}

/**
 * Layers that follow each other, each with code of its own, which reads its parameters as constants: faster than
 * `forLayers`, and longer.
 */
export function forLayersUnrolled(
  field: CloudField,
  body: (index: Int, known: number) => void,
  { first, last }: LayerRange
): void {
  const { length } = field.layers
  for (let i = 0; i < length; i++) {
    const index = int(i)
    if (length === 1) body(index, i)
    else If(first.lessThanEqual(index).and(last.greaterThan(index)), () => body(index, i))
  }
}

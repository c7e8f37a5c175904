import { If, log2 } from 'three/tsl'
import type { CloudField } from '../CloudField'
import { stormFibres } from '../stormForm'
import type { Float, Vec3 } from '../../tsl-types'
import { decoded } from './billows'
import type { LayerNodes } from './layer'

// Fibres at the rims of anvils, which noise at a place cannot make: they are in coordinates of their storm.

/** The anvil around a place: see `CloudWeather`. */
export interface AnvilAround {
  readonly stormDistance: Float
  readonly stormRadius: Float
  readonly fibrePlace: Vec3
  readonly fibreZenith: Vec3
  readonly fibreShare: Float
}

/**
 * Place in the noise that makes fibres, at the height of the layer's base [periods]. Twin: `stormAround` in
 * test/twins/storm.ts
 *
 * @param axis - Point of the axis of a storm's anvil, in the lattice of storms [cells].
 * @param fromTower - Displacement from its tower to the place [cells].
 * @param zenith - Zenith in the lattice.
 * @param cell - Length of a cell [m].
 */
export function fibrePlace(axis: Vec3, fromTower: Vec3, zenith: Vec3, cell: Float): Vec3 {
  const { around, core, outwards } = stormFibres
  const outward = fromTower.sub(zenith.mul(fromTower.dot(zenith))).toConst() as Vec3
  const distance = outward.length().toConst() as Float
  return (
    outward
      .div(distance.max(core).div(around))
      // Each storm has its own. Whole cells: the lattice may be wrapped.
      .add(axis)
      .add(zenith.mul(distance.mul(cell).div(outwards)))
      .toConst()
  )
}

/**
 * Distance from the axis of a storm's anvil with the fibres of its rim [m]: ice streams outwards from the tower and sinks. One
 * texture read near rims, none elsewhere. Twin: `frayedDistance` in test/twins/storm.ts
 *
 * @param ice - Share of ice there.
 * @param level - `Resolution.shapeLevel`.
 */
export function frayedDistance(
  field: CloudField,
  layer: LayerNodes,
  { stormDistance, stormRadius, fibrePlace, fibreZenith, fibreShare }: AnvilAround,
  ice: Float,
  height: Float,
  level: Float
): Float {
  const { upwards, weights, fray, mostFray, rim, around, sharper } = stormFibres
  const distance = stormDistance.toVar() as Float
  const inRadii = stormDistance.div(stormRadius.max(1)).toConst()
  If(ice.greaterThan(0).and(inRadii.greaterThan(rim[0])).and(inRadii.lessThan(rim[1])), () => {
    const rise = height.mul(layer.thickness).div(upwards)
    const point = fibrePlace.add(fibreZenith.mul(rise)).toConst() as Vec3
    // Their period is another than the shape's.
    const period = stormRadius.div(around).min(upwards).mul(layer.perShapePeriod)
    const own = level.sub(log2(period)).sub(sharper).max(0)
    const noise = decoded(field.textures.shape.sample(point).level(own))
    const fibres = noise.x.mul(weights[0]).add(noise.y.mul(weights[1]))
    const aside = fibres.mul(fray).clamp(-mostFray, mostFray).mul(ice.mul(fibreShare))
    distance.subAssign(aside.mul(stormRadius))
  })
  return distance
}

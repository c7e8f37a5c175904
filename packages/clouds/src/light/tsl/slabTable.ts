import { vec2, vec3 } from 'three/tsl'
import type { CloudLight } from '../CloudLightTable'
import { slabTableForm } from '../cpu/slabTableForm'
import type { Float, Vec2, Vec4 } from '../../tsl-types'

const { bend, layers, positions, thickest, thicknesses } = slabTableForm

const stretch = (depth: Float): Float => depth.div(bend).add(1).log()

/** Texture coordinates of a depth in a slab. Twins: `slabColumn` and `slabRow` */
export function slabCoordinates(depth: Float, thickness: Float): Vec2 {
  const whole = stretch(thickness.max(1e-4)).toConst()
  const difference = stretch(depth).sub(stretch(thickness.sub(depth)))
  const column = difference.div(whole).mul(0.5).add(0.5).clamp()
  const row = whole.div(Math.log1p(thickest / bend)).clamp()
  return vec2(
    column
      .mul(positions - 1)
      .add(0.5)
      .div(positions),
    row
      .mul(thicknesses - 1)
      .add(0.5)
      .div(thicknesses)
  )
}

/** Reads a layer of the table. */
export const readLayer = ({ table }: CloudLight, coordinates: Vec2, layer: Float): Vec4 =>
  table
    .sample(vec3(coordinates, layer.add(0.5).div(layers)))
    .level(0)
    .toConst()

/** Legendre series x + y μ + z (3μ² − 1)/2. */
export const legendreSeries = ({ x, y, z }: Vec4, cosine: Float): Float =>
  x.add(y.mul(cosine)).add(z.mul(cosine.mul(cosine).mul(1.5).sub(0.5)))

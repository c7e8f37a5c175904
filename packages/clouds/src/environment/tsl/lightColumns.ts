import type { Float } from '../../tsl-types'

/** Column of a table over cosines of the light, in [0, 1]: columns crowd about the horizon. */
export const columnOf = (cosLight: Float): Float =>
  cosLight.sign().mul(cosLight.abs().sqrt()).mul(0.5).add(0.5)

/** Cosine of the light of a column: the inverse of {@link columnOf}. */
export function cosLightOf(column: Float): Float {
  const side = column.mul(2).sub(1).toConst() as Float
  return side.mul(side.abs()).toConst()
}

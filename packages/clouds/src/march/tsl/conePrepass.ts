import { Break, Fn, If, float, uv, vec4 } from 'three/tsl'
import { loop, type Float, type Vec2, type Vec3, type Vec4 } from '../../tsl-types'
import { emptyDistanceAt } from '../../density/tsl/sampler'
import { viewRayAt, type ViewRayNodes } from './viewRay'

/** Marched pixels along an edge of the tiles that look for clouds together. */
export const TILE = 8

/** Most steps of a tile, and its shortest: per distance, at least [m]. */
const STEPS = 48
const GROWTH = 0.004
const LEAST = 10

/** Farthest that tiles look, within the range of half floats, and what their precision leaves of it [m]. */
const REACH = 60_000
const PRECISION = 0.999

/**
 * How far all rays of a tile are sure to be clear: a cone around them goes from ball to ball of clear air.
 * Among clouds most of a ray leads through such air, which each would have to find by itself.
 *
 * @returns [m], at most `REACH`.
 */
export function conePrepass(sights: ViewRayNodes): Vec4 {
  const { field, frame } = sights
  return Fn(() => {
    const edge = frame.block.mul(TILE).div(frame.size).toConst() as unknown as Vec2
    const tile = uv().mul(frame.marchedSize.div(TILE).ceil()).floor().toConst() as unknown as Vec2
    const toward = (part: number): Vec3 => viewRayAt(sights, tile.add(part).mul(edge)).direction
    const direction = toward(0.5)
    // To its corners, of which some are farther off than this one.
    const spread = toward(0).sub(direction).length().mul(1.1).toConst() as Float
    const position = float(0).toVar()
    loop('approach', STEPS, () => {
      const offset = direction.mul(position).toConst() as Vec3
      const clear = emptyDistanceAt(field, {
        offset,
        ...field.view.place(offset),
        distance: position
      })
      const step = clear.sub(position.mul(spread)).div(spread.add(1)).toConst() as Float
      If(step.lessThan(position.mul(GROWTH).add(LEAST)).or(position.greaterThan(REACH)), () => {
        Break()
      })
      position.addAssign(step)
    })
    return vec4(position.mul(PRECISION).min(REACH), 0, 0, 1)
  })()
}

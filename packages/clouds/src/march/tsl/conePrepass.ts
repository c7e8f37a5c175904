import { Break, Fn, If, float, uv, vec4 } from 'three/tsl'
import { loop, type Float, type Vec2, type Vec3, type Vec4 } from '../../tsl-types'
import { emptyDistanceAt } from '../../density/tsl/sampler'
import { viewRayAt, type ViewRayNodes } from './viewRay'

/** Marched pixels along an edge of the tiles that share a cone. */
export const TILE = 8

/** Most steps of a cone. */
const STEPS = 48

/** Shortest step that goes on: per distance, and at least [m]. */
const STEP_GROWTH = 0.004
const SHORTEST_STEP = 10

/** Greatest distance of a cone, within the range of half floats; and what their precision leaves of it [m]. */
const MAX_DISTANCE = 60_000
const PRECISION = 0.999

/**
 * Cone prepass: distance that all rays of a tile are sure to cross without a cloud. The cone around them
 * goes from sphere to sphere of empty air. Among clouds most of a ray leads through such air, which each
 * pixel would otherwise have to cross by itself.
 *
 * @returns Distance in red, at most `MAX_DISTANCE` [m].
 * @see Hart 1996, "Sphere tracing", §2.3: steps of the size of an empty sphere
 */
export function conePrepass(inputs: ViewRayNodes): Vec4 {
  const { field, frame } = inputs
  return Fn(() => {
    const edge = frame.block.mul(TILE).div(frame.size).toConst() as unknown as Vec2
    const tile = uv().mul(frame.marchedSize.div(TILE).ceil()).floor().toConst() as unknown as Vec2
    const toward = (part: number): Vec3 => viewRayAt(inputs, tile.add(part).mul(edge)).direction
    const direction = toward(0.5)
    // To its corners, of which some are farther off than this one.
    const spread = toward(0).sub(direction).length().mul(1.1).toConst() as Float
    const position = float(0).toVar()
    loop('approach', STEPS, () => {
      const offset = direction.mul(position).toConst() as Vec3
      const empty = emptyDistanceAt(field, {
        offset,
        ...field.view.place(offset),
        distance: position
      })
      const step = empty.sub(position.mul(spread)).div(spread.add(1)).toConst() as Float
      const isBlocked = step.lessThan(position.mul(STEP_GROWTH).add(SHORTEST_STEP))
      If(isBlocked.or(position.greaterThan(MAX_DISTANCE)), () => {
        Break()
      })
      position.addAssign(step)
    })
    return vec4(position.mul(PRECISION).min(MAX_DISTANCE), 0, 0, 1)
  })()
}

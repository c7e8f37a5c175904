import type { ExplorerOptions } from '../moving/ExplorerOptions'
import { topOf, type Obstacle } from '../moving/obstacles'
import { groundHeight } from './ground'
import { LAKE } from './places'
import { outlines } from './village'

/** Height of a roof's middle over its walls [m]. */
const ROOF = 1.6

/** Half of a square about the lake outside of which there is no water [m]. */
const REACH = 2400

/**
 * The valley for those on foot: houses, and the lake with its bed.
 *
 * @param isShown - Answers which of these there are.
 */
export function valleyFooting(
  isShown: () => { readonly village: boolean; readonly water: boolean }
): Required<Pick<ExplorerOptions, 'footingAt' | 'waterAt'>> {
  const houses = topOf(
    outlines().map(({ x, z, width, depth, turn, height }): Obstacle => {
      const top = groundHeight(x, z) + height + ROOF
      return { x, z, width, depth, turn, top }
    })
  )
  return {
    footingAt(position) {
      const ground = groundHeight(position.x, position.z)
      return isShown().village ? Math.max(ground, houses(position)) : ground
    },
    waterAt({ x, z }) {
      const isNear = Math.max(Math.abs(x - LAKE.x), Math.abs(z - LAKE.z)) < REACH
      return isNear && isShown().water ? LAKE.height : -Infinity
    }
  }
}

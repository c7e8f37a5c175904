import type { Vector3 } from 'three'
import type { ExplorerOptions } from '../moving/ExplorerOptions'
import { topOf, type Obstacle } from '../moving/obstacles'
import { groundHeight } from './ground'
import { LAKE } from './places'
import { outlines } from './village'

/** Height of a roof's middle over its walls [m]. */
const ROOF = 1.6

/**
 * Height of the roof at a place of a village: −∞ beside its houses [m].
 *
 * @param heightAt - Height of the ground [m].
 * @param middle - Place of the church, default the valley's [m].
 */
export function villageTops(
  heightAt: (x: number, z: number) => number,
  middle?: Readonly<Record<'x' | 'z', number>>
): ReturnType<typeof topOf> {
  return topOf(
    outlines(middle).map(({ x, z, width, depth, turn, height }): Obstacle => {
      const top = heightAt(x, z) + height + ROOF
      return { x, z, width, depth, turn, top }
    })
  )
}

/** Half of a square about the lake outside of which there is no water [m]. */
const REACH = 2400

/**
 * The valley for those on foot: houses, trees, and the lake with its bed.
 *
 * @param isShown - Answers which of houses and lake there are.
 * @param trunkAt - Height of the top of the trunk at a place, −∞ beside trees [m]. Default without trees.
 */
export function valleyFooting(
  isShown: () => { readonly village: boolean; readonly water: boolean },
  trunkAt: (position: Vector3) => number = () => -Infinity
): Required<Pick<ExplorerOptions, 'footingAt' | 'waterAt'>> {
  const houses = villageTops(groundHeight)
  return {
    footingAt(position) {
      const ground = Math.max(groundHeight(position.x, position.z), trunkAt(position))
      return isShown().village ? Math.max(ground, houses(position)) : ground
    },
    waterAt({ x, z }) {
      const isNear = Math.max(Math.abs(x - LAKE.x), Math.abs(z - LAKE.z)) < REACH
      return isNear && isShown().water ? LAKE.height : -Infinity
    }
  }
}

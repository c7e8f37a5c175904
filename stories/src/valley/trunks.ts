import { Vector3 } from 'three'
import type { Tree } from './Trees'

/** Height of a trunk over its ground up to which it is in the way: nobody steps or jumps so high [m]. */
const HEIGHT = 4

/** Radius of a trunk of size 1, and distance that a camera keeps from it, whose near plane is half a metre away [m]. */
const RADIUS = 0.3
const BODY = 0.6

/** Side of the squares in which trunks are looked up, wider than any trunk with what is kept from it [m]. */
const SQUARE = 4

const _place = new Vector3()
const _size = new Vector3()

type Place = Readonly<Record<'x' | 'z', number>>

const keyOf = (column: number, row: number): string => `${column},${row}`

/**
 * Height of the top of the trunk at a place, for walks: −∞ beside all of them [m].
 *
 * @param heightAt - Height of the ground [m].
 */
export function trunkTops(
  trees: Iterable<Tree>,
  heightAt: (x: number, z: number) => number
): (position: Place) => number {
  const squares = new Map<string, (Place & { readonly reach: number })[]>()
  for (const { matrix } of trees) {
    const { x, z } = _place.setFromMatrixPosition(matrix)
    const reach = RADIUS * Math.max(_size.setFromMatrixScale(matrix).x, _size.z) + BODY
    const key = keyOf(Math.floor(x / SQUARE), Math.floor(z / SQUARE))
    squares.set(key, [...(squares.get(key) ?? []), { x, z, reach }])
  }
  return ({ x, z }) => {
    const [column, row] = [Math.floor(x / SQUARE), Math.floor(z / SQUARE)]
    for (let i = 0; i < 9; i++) {
      const near = squares.get(keyOf(column + (i % 3) - 1, row + Math.floor(i / 3) - 1)) ?? []
      const trunk = near.find(each => Math.hypot(each.x - x, each.z - z) < each.reach)
      if (trunk !== undefined) return heightAt(trunk.x, trunk.z) + HEIGHT
    }
    return -Infinity
  }
}

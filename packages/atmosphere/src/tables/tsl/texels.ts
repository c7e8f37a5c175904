import type { Float } from '../../tsl-types'

/**
 * Row and column of the item with a number among rows of `columns` items each, all of them whole.
 *
 * Half an item is added, so that a division that rounds down does not land in another row.
 */
export function rowAndColumn(number: Float, columns: number): { row: Float; column: Float } {
  const row = number
    .add(0.5)
    .mul(1 / columns)
    .floor()
    .toConst()
  return { row, column: number.sub(row.mul(columns)).toConst() }
}

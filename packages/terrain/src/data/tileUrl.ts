import { fail } from '@welkin/geo'

/** Address of a tile: `z` levels of halves, `x` columns from the west, `y` rows from the north. */
export type TileUrl = (z: number, x: number, y: number) => string

/**
 * Addresses of tiles from a template.
 *
 * `{z}`, `{x}` and `{y}` stand for level, column and row from the north, `{-y}` for the row from the south, as of TMS, and
 * `{s}` for one of the subdomains. WMTS servers have the same under other names: `{TileMatrix}`, `{TileCol}` and `{TileRow}`.
 *
 * ```ts
 * tileUrl('https://example.org/terrarium/{z}/{x}/{y}.png')
 * tileUrl('https://{s}.example.org/tms/{z}/{x}/{-y}.jpg', ['a', 'b', 'c'])
 * tileUrl('https://example.org/wmts?TileMatrix={TileMatrix}&TileCol={TileCol}&TileRow={TileRow}')
 * ```
 *
 * @param subdomains - Values of `{s}`, taken in turn.
 * @throws If the template lacks level, column or row, or has another name in braces.
 */
export function tileUrl(template: string, subdomains: readonly string[] = []): TileUrl {
  const where = 'tileUrl'
  if (typeof template !== 'string') fail(where, 'template must be a string', template)
  const names = [...template.matchAll(/\{([^{}]*)\}/g)].map(([, name]) => name)
  for (const choices of PARTS) {
    if (!names.some(name => choices.includes(name))) {
      fail(where, `template must have {${choices.join('} or {')}}`, template)
    }
  }
  const known = new Set([...PARTS.flat(), 's'])
  const other = names.find(name => !known.has(name))
  if (other !== undefined) fail(where, `template must not have {${other}}`, template)
  if (names.includes('s') && subdomains.length === 0) {
    fail(where, 'subdomains must not be empty')
  }
  return (z, x, y) => {
    const south = 2 ** z - 1 - y
    const values: Record<string, string | number> = { z, x, y, '-y': south }
    Object.assign(values, { TileMatrix: z, TileCol: x, TileRow: y })
    values.s = subdomains[(x + y) % subdomains.length]
    return template.replaceAll(/\{([^{}]*)\}/g, (_, name: string) => String(values[name]))
  }
}

/** Names of what a template must have: any of each. */
const PARTS = [
  ['z', 'TileMatrix'],
  ['x', 'TileCol'],
  ['y', '-y', 'TileRow']
]

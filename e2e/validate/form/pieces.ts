import { forFaces, labelPieces, type Mask } from './grid'
import { logSlope } from './slopes'

/** Sections of less area than this are too coarse for a perimeter [cells]. */
const LEAST_SECTION = 60

/** Areas and perimeters of the pieces of a flat mask that don't touch its edge [cells]. */
function closedSections(mask: Mask): { areas: number[]; perimeters: number[] } {
  const [width, height] = mask.size
  const { count, labels } = labelPieces(mask)
  const areas = new Float64Array(count + 1)
  const perimeters = new Float64Array(count + 1)
  const touches = new Uint8Array(count + 1)
  labels.forEach((label, i) => {
    areas[label]++
    const [x, y] = [i % width, Math.floor(i / width)]
    if (x === 0 || y === 0 || x === width - 1 || y === height - 1) touches[label] = 1
  })
  for (const axis of [0, 1] as const) {
    forFaces(mask, axis, (a, b) => {
      if (labels[a] === labels[b]) return
      perimeters[labels[a]]++
      perimeters[labels[b]]++
    })
  }
  const kept = Array.from({ length: count }, (_, i) => i + 1).filter(
    label => touches[label] === 0 && areas[label] > LEAST_SECTION
  )
  return {
    areas: kept.map(label => areas[label]),
    perimeters: kept.map(label => perimeters[label])
  }
}

/**
 * Perimeter–area dimension D of many sections, perimeter ∝ area^(D/2); NaN for eight pieces or fewer.
 *
 * @see Lovejoy 1982, "Area-perimeter relation for rain and cloud areas"
 */
export function perimeterDimension(sections: readonly Mask[]): number {
  const all = sections.map(closedSections)
  const areas = all.flatMap(section => section.areas)
  const perimeters = all.flatMap(section => section.perimeters)
  return areas.length > 8 ? 2 * logSlope(areas, perimeters) : NaN
}

/** Widths of circles as large as the pieces of a flat mask, tiny ones left out [cells]. */
export function pieceWidths(mask: Mask): number[] {
  const { count, labels } = labelPieces(mask)
  const areas = new Float64Array(count + 1)
  for (const label of labels) areas[label]++
  return Array.from(areas.slice(1))
    .filter(area => area > 16)
    .map(area => Math.sqrt((4 * area) / Math.PI))
}

/** A connected piece of cloud. */
export interface Piece {
  /** Volume [cells]. */
  volume: number
  /** Extents along x, y and z [cells]. */
  extents: [number, number, number]
  /** Lowest level that it reaches. */
  lowest: number
}

/** Connected pieces of a mask. */
export function piecesOf(mask: Mask): Piece[] {
  const [nx, ny] = mask.size
  const { count, labels } = labelPieces(mask)
  const found = Array.from({ length: count }, () => ({
    volume: 0,
    low: [Infinity, Infinity, Infinity],
    high: [-1, -1, -1]
  }))
  labels.forEach((label, i) => {
    if (label === 0) return
    const piece = found[label - 1]
    piece.volume++
    const cell = [i % nx, Math.floor(i / nx) % ny, Math.floor(i / (nx * ny))]
    cell.forEach((at, axis) => {
      piece.low[axis] = Math.min(piece.low[axis], at)
      piece.high[axis] = Math.max(piece.high[axis], at)
    })
  })
  return found.map(({ volume, low, high }) => ({
    volume,
    extents: [0, 1, 2].map(axis => high[axis] - low[axis] + 1) as Piece['extents'],
    lowest: low[2]
  }))
}

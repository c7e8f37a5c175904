import { quantile } from '../score'
import { blurMask, squaredDistances } from './filters'
import { boundaryFaces, type ExtinctionGrid, type Mask } from './grid'
import { perimeterDimension, piecesOf, pieceWidths } from './pieces'
import { sizeSlope, spectrumSlope } from './slopes'

/** Part of the 99th percentile of extinction from which a cell counts as cloud. */
const THRESHOLD = 0.05

/** Levels with less than this part of the largest cloud fraction are left out. */
const LEAST_FRACTION = 0.02

/** Depths inside clouds between which extinction is averaged [m]. */
const INTERIOR = [0, 20, 40, 80, 160]

/** Form of a cloud field; NaN where it has too few clouds for a figure. */
export interface FormFigures {
  /** Fraction of columns with cloud. */
  cover: number
  /** Perimeter–area dimension of horizontal and of vertical sections. */
  horizontalDimension: number
  verticalDimension: number
  /** Boundary left after a Gaussian blur of 1, 2 and 4 cells. */
  boundaryLeft: [number, number, number]
  /** Height of the largest cloud fraction, from base to top. */
  peakHeight: number
  /** Cloud fraction at mid-height over the largest. */
  midOverPeak: number
  /** Mean extinction in cloud at 0.8 of the height over that at 0.2. */
  extinctionRise: number
  /** Median height over width of single clouds. */
  aspect: number
  /** Slope of the number density of widths. */
  sizeSlope: number
  /** Part of the volume in pieces that don't reach the lowest quarter. */
  detached: number
  /** Pieces of 8 cells or more [1/km²]. */
  piecesPerKm2: number
  /** Slope of the spectrum of the columns' log depth, 500 to 125 m. */
  spectrumSlope: number
  /** Mean extinction at depths of 0–20–40–80–160 m, over the 90th percentile. */
  interior: number[]
}

/** Profile over heights, read at a share of its height. */
function profileAt(profile: readonly number[], share: number): number {
  const position = share * (profile.length - 1)
  const below = Math.max(Math.min(Math.floor(position), profile.length - 2), 0)
  const next = profile[Math.min(below + 1, profile.length - 1)]
  return profile[below] + (position - below) * (next - profile[below])
}

/** Value below which a part of sorted values lies. */
const percentile = (sorted: Float32Array, part: number): number =>
  sorted[Math.floor(part * (sorted.length - 1))]

/** Cells in cloud. @throws If there are none. */
function cloudMask({ nx, ny, nz, data }: ExtinctionGrid): Mask {
  const positive = data.filter(value => value > 0).toSorted()
  if (positive.length === 0) throw new Error('form: there is no cloud in the field')
  const limit = THRESHOLD * percentile(positive, 0.99)
  return { size: [nx, ny, nz], cells: Uint8Array.from(data, value => (value > limit ? 1 : 0)) }
}

/** Levels from the clouds' base to their top: the lowest one, cells in cloud, and their mean extinction. */
function profiles({ nx, ny, nz, data }: ExtinctionGrid, { cells }: Mask) {
  const level = nx * ny
  const all = Array.from({ length: nz }, (_, k) => {
    let [count, sum] = [0, 0]
    for (let i = k * level; i < (k + 1) * level; i++) {
      count += cells[i]
      sum += cells[i] * data[i]
    }
    return { count, mean: count > 0 ? sum / count : 0 }
  })
  const most = Math.max(...all.map(({ count }) => count))
  const lowest = all.findIndex(({ count }) => count > LEAST_FRACTION * most)
  const highest = all.findLastIndex(({ count }) => count > LEAST_FRACTION * most)
  const cloudy = all.slice(lowest, highest + 1)
  return {
    lowest,
    counts: cloudy.map(({ count }) => count),
    extinctions: cloudy.map(({ mean }) => mean)
  }
}

/** Vertical sections, every sixth. */
function verticalSections({ size: [nx, ny, nz], cells }: Mask): Mask[] {
  return Array.from({ length: Math.ceil(ny / 6) }, (_, i) => {
    const section = new Uint8Array(nx * nz)
    for (let k = 0; k < nz; k++) {
      const start = k * nx * ny + 6 * i * nx
      section.set(cells.subarray(start, start + nx), k * nx)
    }
    return { size: [nx, nz, 1], cells: section }
  })
}

/** Horizontal sections, about a dozen from a lowest to a highest level. */
function horizontalSections(
  { size: [nx, ny], cells }: Mask,
  lowest: number,
  count: number
): Mask[] {
  const every = Math.max(Math.floor(count / 12), 1)
  return Array.from({ length: Math.ceil(count / every) }, (_, i) => {
    const start = (lowest + i * every) * nx * ny
    return { size: [nx, ny, 1], cells: cells.subarray(start, start + nx * ny) }
  })
}

/** Mean extinction at depths inside clouds, over its 90th percentile in cloud. */
function interiorExtinction({ dx, data }: ExtinctionGrid, mask: Mask): number[] {
  const dense = percentile(data.filter((_, i) => mask.cells[i] === 1).toSorted(), 0.9)
  const distances = squaredDistances(mask)
  return INTERIOR.slice(1).map((to, i) => {
    const [low, high] = [(INTERIOR[i] / dx) ** 2, (to / dx) ** 2]
    let [sum, count] = [0, 0]
    distances.forEach((square, cell) => {
      if (square <= low || square > high) return
      sum += data[cell]
      count++
    })
    return count > 0 ? sum / count / dense : NaN
  })
}

/**
 * Figures of the form of a cloud field, from the field alone, so that simulated and procedural ones are
 * judged alike.
 *
 * @throws If there is no cloud in it.
 */
export function formFigures(grid: ExtinctionGrid): FormFigures {
  const { nx, ny, nz, dx, dz, data } = grid
  const mask = cloudMask(grid)
  const level = nx * ny
  const columns = new Uint8Array(level)
  const depths = new Float64Array(level)
  mask.cells.forEach((cell, i) => {
    depths[i % level] += data[i] * dz
    columns[i % level] |= cell
  })
  const { lowest, counts, extinctions } = profiles(grid, mask)
  const most = Math.max(...counts)
  const faces = boundaryFaces(mask)
  const left = (deviation: number): number => boundaryFaces(blurMask(mask, deviation)) / faces
  const pieces = piecesOf(mask)
  const aspects = pieces.flatMap(({ extents: [x, y, z] }) =>
    Math.sqrt(x * y) > 12 ? [(z * dz) / (Math.sqrt(x * y) * dx)] : []
  )
  const quarter = lowest + Math.floor(0.25 * (counts.length - 1))
  const volumeOf = (some: typeof pieces): number => some.reduce((sum, p) => sum + p.volume, 0)
  const cloudy = Array.from(depths).filter((_, i) => columns[i] === 1)
  const middle = Math.max(quantile(cloudy, 0.5), 1e-9)
  const edge = Math.min(nx, ny)
  const square = Array.from({ length: edge ** 2 }, (_, i) =>
    Math.log1p(depths[nx * Math.floor(i / edge) + (i % edge)] / middle)
  )
  return {
    cover: cloudy.length / level,
    horizontalDimension: perimeterDimension(horizontalSections(mask, lowest, counts.length)),
    verticalDimension: nz > 1 ? perimeterDimension(verticalSections(mask)) : NaN,
    boundaryLeft: [left(1), left(2), left(4)],
    peakHeight: counts.indexOf(most) / Math.max(counts.length - 1, 1),
    midOverPeak: profileAt(counts, 0.5) / most,
    extinctionRise: profileAt(extinctions, 0.8) / profileAt(extinctions, 0.2),
    aspect: aspects.length > 0 ? quantile(aspects, 0.5) : NaN,
    sizeSlope: sizeSlope(pieceWidths({ size: [nx, ny, 1], cells: columns })),
    detached: volumeOf(pieces.filter(piece => piece.lowest > quarter)) / volumeOf(pieces),
    piecesPerKm2: pieces.filter(({ volume }) => volume >= 8).length / ((level * dx * dx) / 1e6),
    spectrumSlope: spectrumSlope(square, edge, dx, 500, 125),
    interior: interiorExtinction(grid, mask)
  }
}

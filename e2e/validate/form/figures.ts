import { powerSpectrum } from '../power-spectrum'
import { quantile } from '../score'
import { blurMask, squaredDistances } from './filters'
import { boundaryFaces, forFaces, labelPieces, type ExtinctionGrid, type Mask } from './grid'

/** Part of the 99th percentile of extinction from which a cell counts as cloud. */
const THRESHOLD = 0.05

/** Sections of less area than this are too coarse for a perimeter [cells]. */
const LEAST_SECTION = 60

/** Levels with less than this part of the largest cloud fraction are left out. */
const LEAST_FRACTION = 0.02

/** Depths inside clouds between which extinction is averaged [m]. */
const INTERIOR = [0, 20, 40, 80, 160]

/** Form of a cloud field; NaN where it has too few clouds for a figure. */
export interface FormFigures {
  /** Fraction of columns with cloud. */
  cover: number
  /** Dimension D of horizontal and of vertical sections: perimeter ∝ area^(D/2). */
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

/** Slope of log y against log x by least squares; NaN for fewer than three points. */
function logSlope(x: readonly number[], y: readonly number[]): number {
  if (x.length < 3) return NaN
  const [a, b] = [x, y].map(values => values.map(Math.log))
  const mean = (values: readonly number[]): number => values.reduce((s, v) => s + v) / values.length
  const [ma, mb] = [mean(a), mean(b)]
  const covariance = a.reduce((s, v, i) => s + (v - ma) * (b[i] - mb), 0)
  return covariance / a.reduce((s, v) => s + (v - ma) ** 2, 0)
}

/** Profile over heights, read at a share of its height. */
function profileAt(profile: readonly number[], share: number): number {
  const position = share * (profile.length - 1)
  const below = Math.min(Math.floor(position), profile.length - 2)
  return profile[below] + (position - below) * (profile[below + 1] - profile[below])
}

/** Areas and perimeters of the pieces of a section that don't touch its edge [cells]. */
function sections(width: number, height: number, cells: Uint8Array): [number[], number[]] {
  const mask: Mask = { size: [width, height, 1], cells }
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
  return [kept.map(label => areas[label]), kept.map(label => perimeters[label])]
}

/** Perimeter–area dimension of many sections. */
function dimensionOf(all: [number[], number[]][]): number {
  const areas = all.flatMap(([area]) => area)
  return areas.length > 8
    ? 2 *
        logSlope(
          areas,
          all.flatMap(([, perimeter]) => perimeter)
        )
    : NaN
}

/** Slope of a square picture's power per wavenumber between two wavelengths. */
function spectrumSlope(
  picture: number[],
  size: number,
  cell: number,
  longest: number,
  shortest: number
): number {
  const power = powerSpectrum(picture, size)
  const bins = 6
  const [low, high] = [1 / longest, 1 / shortest]
  const sums = Array.from({ length: bins }, () => ({ power: 0, count: 0 }))
  power.forEach((value, i) => {
    const signed = (k: number): number => (k > size / 2 ? k - size : k)
    const wave = Math.hypot(signed(i % size), signed(Math.floor(i / size))) / (size * cell)
    const bin = Math.floor((bins * Math.log(wave / low)) / Math.log(high / low))
    if (bin < 0 || bin >= bins || wave === 0) return
    sums[bin].power += value
    sums[bin].count++
  })
  const waves = sums.map((_, i) => low * (high / low) ** ((i + 0.5) / bins))
  const used = sums.flatMap(({ count }, i) => (count > 0 ? [i] : []))
  return logSlope(
    used.map(i => waves[i]),
    used.map(i => (sums[i].power / sums[i].count) * waves[i])
  )
}

/** Slope of the number density of clouds' widths, seen from above. */
function sizeSlope(areas: readonly number[]): number {
  const widths = areas.filter(area => area > 16).map(area => Math.sqrt((4 * area) / Math.PI))
  if (widths.length <= 12) return NaN
  const bins = 7
  const [low, high] = [Math.min(...widths), Math.max(...widths) * 1.001]
  const edge = (i: number): number => low * (high / low) ** (i / bins)
  const counts = new Array<number>(bins).fill(0)
  for (const w of widths) counts[Math.floor((bins * Math.log(w / low)) / Math.log(high / low))]++
  const used = counts.flatMap((count, i) => (count > 0 ? [i] : []))
  return logSlope(
    used.map(i => Math.sqrt(edge(i) * edge(i + 1))),
    used.map(i => counts[i] / (edge(i + 1) - edge(i)))
  )
}

/**
 * Figures of the form of a cloud field, from the field alone, so that simulated and procedural ones are
 * judged alike.
 *
 * @throws If there is no cloud in it.
 */
export function formFigures(grid: ExtinctionGrid): FormFigures {
  const { nx, ny, nz, dx, dz, data } = grid
  const positive = data.filter(value => value > 0).toSorted()
  if (positive.length === 0) throw new Error('form: there is no cloud in the field')
  const limit = THRESHOLD * positive[Math.floor(0.99 * (positive.length - 1))]
  const cells = Uint8Array.from(data, value => (value > limit ? 1 : 0))
  const mask: Mask = { size: [nx, ny, nz], cells }
  const level = nx * ny

  const columns = new Uint8Array(level)
  const depths = new Float64Array(level)
  const fractions = new Array<number>(nz).fill(0)
  const extinctions = new Array<number>(nz).fill(0)
  for (let i = 0; i < cells.length; i++) {
    const [column, k] = [i % level, Math.floor(i / level)]
    depths[column] += data[i] * dz
    if (cells[i] === 0) continue
    columns[column] = 1
    fractions[k]++
    extinctions[k] += data[i]
  }
  const most = Math.max(...fractions)
  const cloudy = fractions.flatMap((count, k) => (count > LEAST_FRACTION * most ? [k] : []))
  const [lowest, highest] = [cloudy[0], cloudy.at(-1)!]
  const filled = fractions.slice(lowest, highest + 1)
  const means = extinctions
    .slice(lowest, highest + 1)
    .map((sum, i) => (filled[i] > 0 ? sum / filled[i] : 0))

  const horizontal: [number[], number[]][] = []
  const every = Math.max(Math.floor(cloudy.length / 12), 1)
  for (let i = 0; i < cloudy.length; i += every) {
    const k = cloudy[i]
    horizontal.push(sections(nx, ny, cells.subarray(k * level, (k + 1) * level)))
  }
  const vertical: [number[], number[]][] = []
  for (let y = 0; y < ny; y += 6) {
    const cut = new Uint8Array(nx * nz)
    for (let k = 0; k < nz; k++) {
      const start = k * level + y * nx
      cut.set(cells.subarray(start, start + nx), k * nx)
    }
    vertical.push(sections(nx, nz, cut))
  }

  const faces = boundaryFaces(mask)
  const left = (deviation: number): number => boundaryFaces(blurMask(mask, deviation)) / faces

  const seen = labelPieces({ size: [nx, ny, 1], cells: columns })
  const areas = new Array<number>(seen.count).fill(0)
  for (const label of seen.labels) if (label > 0) areas[label - 1]++

  const pieces = labelPieces(mask)
  const volumes = new Float64Array(pieces.count + 1)
  const bounds = Array.from({ length: pieces.count + 1 }, () => [nx, 0, ny, 0, nz, 0])
  const reaches = new Uint8Array(pieces.count + 1)
  const quarter = lowest + Math.floor(0.25 * (highest - lowest))
  pieces.labels.forEach((label, i) => {
    if (label === 0) return
    const [x, y, k] = [i % nx, Math.floor((i % level) / nx), Math.floor(i / level)]
    volumes[label]++
    if (k <= quarter) reaches[label] = 1
    const b = bounds[label]
    if (x < b[0]) b[0] = x
    if (x > b[1]) b[1] = x
    if (y < b[2]) b[2] = y
    if (y > b[3]) b[3] = y
    if (k < b[4]) b[4] = k
    if (k > b[5]) b[5] = k
  })
  const aspects = bounds.slice(1).flatMap(([x0, x1, y0, y1, k0, k1]) => {
    const width = Math.sqrt((x1 - x0 + 1) * (y1 - y0 + 1)) * dx
    return width > 12 * dx ? [((k1 - k0 + 1) * dz) / width] : []
  })
  const whole = volumes.reduce((a, b) => a + b)
  const apart = volumes.reduce((sum, volume, i) => (reaches[i] === 1 ? sum : sum + volume), 0)

  const inCloud = data.filter((_, i) => cells[i] === 1).toSorted()
  const dense = inCloud[Math.floor(0.9 * (inCloud.length - 1))]
  const inside = squaredDistances(mask)
  const interior = INTERIOR.slice(1).map((to, i) => {
    const [low, high] = [(INTERIOR[i] / dx) ** 2, (to / dx) ** 2]
    let [sum, count] = [0, 0]
    for (let cell = 0; cell < cells.length; cell++) {
      if (inside[cell] <= low || inside[cell] > high) continue
      sum += data[cell]
      count++
    }
    return count > 0 ? sum / count / dense : NaN
  })

  const cloudyDepths = Array.from(depths).filter((_, i) => columns[i] === 1)
  const middle = Math.max(quantile(cloudyDepths, 0.5), 1e-9)
  const size = Math.min(nx, ny)
  const square = Array.from({ length: size ** 2 }, (_, i) =>
    Math.log1p(depths[nx * Math.floor(i / size) + (i % size)] / middle)
  )
  return {
    cover: cloudyDepths.length / level,
    horizontalDimension: dimensionOf(horizontal),
    verticalDimension: dimensionOf(vertical),
    boundaryLeft: [left(1), left(2), left(4)],
    peakHeight: filled.indexOf(Math.max(...filled)) / Math.max(highest - lowest, 1),
    midOverPeak: profileAt(filled, 0.5) / most,
    extinctionRise: profileAt(means, 0.8) / profileAt(means, 0.2),
    aspect: aspects.length > 0 ? quantile(aspects, 0.5) : NaN,
    sizeSlope: sizeSlope(areas),
    detached: apart / whole,
    piecesPerKm2: volumes.slice(1).filter(v => v >= 8).length / ((level * dx * dx) / 1e6),
    spectrumSlope: spectrumSlope(square, size, dx, 500, 125),
    interior
  }
}

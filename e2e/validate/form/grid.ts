/** Extinction of clouds on a regular grid; x fastest, then y, then z. */
export interface ExtinctionGrid {
  nx: number
  ny: number
  nz: number
  /** Horizontal and vertical width of a cell [m]. */
  dx: number
  dz: number
  /** Altitude of the lowest cells' bottom [m]. */
  z0: number
  /** Extinction at the cells' centres [1/m]. */
  data: Float32Array
}

/** Cells in or out of cloud, with the extents of a grid: [nx, ny, nz]. */
export interface Mask {
  size: readonly [number, number, number]
  cells: Uint8Array
}

/** Distance in the flat array between neighbours along x, y and z. */
export const strides = ([nx, ny]: Mask['size']): [number, number, number] => [1, nx, nx * ny]

/** Calls back with the two cells of each face between neighbours along one axis. */
export function forFaces(
  { size }: Pick<Mask, 'size'>,
  axis: 0 | 1 | 2,
  body: (a: number, b: number) => void
): void {
  const [nx, ny, nz] = size
  const stride = strides(size)[axis]
  const end = [nx, ny, nz].map((n, i) => (i === axis ? n - 1 : n))
  for (let z = 0; z < end[2]; z++) {
    for (let y = 0; y < end[1]; y++) {
      let i = nx * (y + ny * z)
      for (let x = 0; x < end[0]; x++, i++) body(i, i + stride)
    }
  }
}

/** Axes along which a mask has more than one cell. */
export const axesOf = ({ size }: Mask): (0 | 1 | 2)[] =>
  ([0, 1, 2] as const).filter(axis => size[axis] > 1)

/** Connected pieces of a mask, cells that share a face belonging together. */
export interface Pieces {
  count: number
  /** Number of each cell's piece from 1; 0 outside. */
  labels: Int32Array
}

/** Labels the connected pieces of a mask (union–find). */
export function labelPieces(mask: Mask): Pieces {
  const { cells } = mask
  const parents = Int32Array.from(cells, (_, i) => i)
  const root = (start: number): number => {
    let i = start
    while (parents[i] !== i) {
      parents[i] = parents[parents[i]]
      i = parents[i]
    }
    return i
  }
  for (const axis of axesOf(mask)) {
    forFaces(mask, axis, (a, b) => {
      if (cells[a] === 1 && cells[b] === 1) parents[root(a)] = root(b)
    })
  }
  const labels = new Int32Array(cells.length)
  let count = 0
  for (let i = 0; i < cells.length; i++) {
    if (cells[i] === 1 && root(i) === i) labels[i] = ++count
  }
  for (let i = 0; i < cells.length; i++) if (cells[i] === 1) labels[i] = labels[root(i)]
  return { count, labels }
}

/** Number of faces between cells in cloud and cells out of it. */
export function boundaryFaces(mask: Mask): number {
  const { cells } = mask
  let faces = 0
  for (const axis of axesOf(mask)) {
    forFaces(mask, axis, (a, b) => {
      if (cells[a] !== cells[b]) faces++
    })
  }
  return faces
}

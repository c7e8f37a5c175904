/** A tile's mesh, as `QuantizedMeshLoaderBase` of 3d-tiles-renderer reads it. */
export interface QuantizedMesh {
  /** Heights that 0 and 1 stand for [m]. */
  readonly header: { readonly minHeight: number; readonly maxHeight: number }
  /** Three corners of each triangle. */
  readonly indices: ArrayLike<number>
  /** Corners, in [0, 1]: `u` from west to east, `v` from south to north. */
  readonly vertexData: {
    readonly u: ArrayLike<number>
    readonly v: ArrayLike<number>
    readonly height: ArrayLike<number>
  }
}

/** Margin of a triangle beyond its edges, so that no pixel centre between two triangles is lost [pixels]. */
const MARGIN = 1e-3

/**
 * Heights of a mesh at the centres of a grid's pixels, linear on its triangles.
 *
 * @param size - Pixels along an edge.
 * @returns Row by row from the north-west corner [m]; NaN where there is no triangle.
 */
export function rasterizeMesh(
  { header, indices, vertexData }: QuantizedMesh,
  size: number
): Float32Array {
  const { u, v, height } = vertexData
  const { minHeight, maxHeight } = header
  const heights = new Float32Array(size ** 2).fill(NaN)
  for (let i = 0; i + 2 < indices.length; i += 3) {
    const [a, b, c] = [indices[i], indices[i + 1], indices[i + 2]]
    // In pixels, whole numbers are centres.
    const [ax, ay] = [u[a] * size - 0.5, (1 - v[a]) * size - 0.5]
    const [bx, by] = [u[b] * size - 0.5 - ax, (1 - v[b]) * size - 0.5 - ay]
    const [cx, cy] = [u[c] * size - 0.5 - ax, (1 - v[c]) * size - 0.5 - ay]
    const area = bx * cy - cx * by
    if (!(Math.abs(area) > 1e-9)) continue // no area, or corners that are not there
    // Barycentric coordinates are distances from an edge over the height upon it.
    const longest = Math.max(Math.hypot(bx, by), Math.hypot(cx, cy), Math.hypot(bx - cx, by - cy))
    const least = (-MARGIN * longest) / Math.abs(area)
    const left = Math.max(Math.ceil(ax + Math.min(0, bx, cx) - MARGIN), 0)
    const right = Math.min(Math.floor(ax + Math.max(0, bx, cx) + MARGIN), size - 1)
    const top = Math.max(Math.ceil(ay + Math.min(0, by, cy) - MARGIN), 0)
    const bottom = Math.min(Math.floor(ay + Math.max(0, by, cy) + MARGIN), size - 1)
    for (let row = top; row <= bottom; row++) {
      for (let column = left; column <= right; column++) {
        const [x, y] = [column - ax, row - ay]
        const second = (x * cy - cx * y) / area
        const third = (bx * y - x * by) / area
        if (Math.min(second, third, 1 - second - third) < least) continue
        const share = height[a] + second * (height[b] - height[a]) + third * (height[c] - height[a])
        heights[row * size + column] = minHeight + share * (maxHeight - minHeight)
      }
    }
  }
  return heights
}

/** Depth of a picture, as a perspective camera at the origin that looks along −Z sees it. */
export interface DepthPicture {
  readonly width: number
  readonly height: number
  /** Tangent of half the vertical field of view. */
  readonly tangent: number
  /** Distance along the camera's axis of what a pixel shows, > 0; rows run down. */
  distanceAt(column: number, row: number): number
}

/** Coordinates of a pixel's ray where the axis has 1: right and up. */
export function rayOf({ width, height, tangent }: DepthPicture, column: number, row: number) {
  return {
    x: ((2 * (column + 0.5)) / width - 1) * tangent * (width / height),
    y: (1 - (2 * (row + 0.5)) / height) * tangent
  }
}

/**
 * Float64 twin of `depthNormal`. Of the plane n·p = c the reciprocal distance w = −(n_x x + n_y y − n_z)/c is linear in a
 * ray's coordinates x and y, and has the normal for a gradient: no positions, and no cross product.
 */
export function depthNormal(
  picture: DepthPicture,
  column: number,
  row: number
): [number, number, number] {
  const w = (x: number, y: number): number => 1 / picture.distanceAt(x, y)
  const here = w(column, row)
  const change = (x: number, y: number): number => {
    const sides = [-1, 1].map(sign => {
      const [next, second] = [1, 2].map(n => [column + sign * n * x, row + sign * n * y] as const)
      const isInside = [0, 1].every(
        i => second[i] >= 0 && second[i] < [picture.width, picture.height][i]
      )
      const bend = isInside ? Math.abs(2 * w(...next) - w(...second) - here) : Infinity
      return { slope: isInside ? sign * (w(...next) - here) : 0, bend }
    })
    return sides[0].bend < sides[1].bend ? sides[0].slope : sides[1].slope
  }
  const { x, y } = rayOf(picture, column, row)
  const right = (change(1, 0) * picture.height) / (2 * picture.tangent)
  const up = (-change(0, 1) * picture.height) / (2 * picture.tangent)
  // w = (right, up)·(ray − its own) + here = (a, b, d)·(x, y, −1), towards the camera where d < 0.
  const normal = [-right, -up, here - right * x - up * y] as const
  const length = Math.hypot(...normal)
  return [normal[0] / length, normal[1] / length, normal[2] / length]
}

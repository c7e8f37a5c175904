import { PNG } from 'pngjs'

/**
 * Largest differences between two frames of the same scene. Rounding differs between backends and between
 * versions of the software renderer; a changed model shows as a mean shift, a changed shape as
 * pixels that are far off. A difference is measured from the range of the 3×3 pixels around.
 */
export const tolerance = {
  /** Mean difference over all channels [1/255]. */
  mean: 0.4,
  /** A pixel is far off when one of its channels differs by more than this [1/255]. */
  farOff: 6,
  /** Share of pixels that may be far off. */
  farOffShare: 0.002
}

export interface Comparison {
  same: boolean
  /** True if more than half of a tolerance is used up. */
  isNearLimit: boolean
  detail: string
  /** The difference, eightfold. */
  diff: PNG
}

/**
 * Distance of a channel outside the range of its neighbourhood in the expected picture: an edge
 * that multisampling places a part of a pixel away is no change.
 */
function distanceFromRange(expected: PNG, x: number, y: number, channel: number, value: number) {
  let low = 255
  let high = 0
  for (let row = Math.max(y - 1, 0); row <= Math.min(y + 1, expected.height - 1); row++) {
    for (let column = Math.max(x - 1, 0); column <= Math.min(x + 1, expected.width - 1); column++) {
      const neighbour = expected.data[4 * (row * expected.width + column) + channel]
      low = Math.min(low, neighbour)
      high = Math.max(high, neighbour)
    }
  }
  return Math.max(low - value, value - high, 0)
}

export function compare(actual: PNG, expected: PNG): Comparison {
  const { width, height } = expected
  const diff = new PNG({ width, height })
  if (actual.width !== width || actual.height !== height) {
    const detail = `${actual.width}×${actual.height} instead of ${width}×${height}`
    return { same: false, isNearLimit: true, detail, diff }
  }
  let sum = 0
  let farOff = 0
  for (let y = 0; y < height; y++) {
    for (let x = 0; x < width; x++) {
      const pixel = 4 * (y * width + x)
      let furthest = 0
      for (let channel = 0; channel < 3; channel++) {
        const value = actual.data[pixel + channel]
        const distance = distanceFromRange(expected, x, y, channel, value)
        sum += distance
        furthest = Math.max(furthest, distance)
        const difference = Math.abs(value - expected.data[pixel + channel])
        diff.data[pixel + channel] = Math.min(255, 8 * difference)
      }
      diff.data[pixel + 3] = 255
      if (furthest > tolerance.farOff) farOff++
    }
  }
  const mean = sum / (3 * width * height)
  const share = farOff / (width * height)
  return {
    isNearLimit: mean > tolerance.mean / 2 || share > tolerance.farOffShare / 2,
    same: mean <= tolerance.mean && share <= tolerance.farOffShare,
    detail: `mean ${mean.toFixed(2)}/255, ${(100 * share).toFixed(2)} % far off`,
    diff
  }
}

/** A canvas that was read too late, or never drawn to, is one flat colour. */
export function isBlank({ data }: PNG): boolean {
  const first = data.readUInt32BE(0)
  for (let i = 4; i < data.length; i += 4) {
    if (data.readUInt32BE(i) !== first) return false
  }
  return true
}

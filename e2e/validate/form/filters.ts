import { strides, type Mask } from './grid'

/** Calls back with the first cell of each line of cells along an axis. */
function forLines([nx, ny, nz]: Mask['size'], axis: number, body: (start: number) => void): void {
  const [sx, sy, sz] = strides([nx, ny, nz])
  const [a, b] = [0, 1, 2].filter(other => other !== axis)
  const extents = [nx, ny, nz]
  const steps = [sx, sy, sz]
  for (let j = 0; j < extents[b]; j++) {
    for (let i = 0; i < extents[a]; i++) body(i * steps[a] + j * steps[b])
  }
}

/**
 * Mask blurred by a Gaussian, and cut at one half again. Edges are mirrored.
 *
 * @param deviation - Standard deviation of the Gaussian [cells].
 */
export function blurMask({ size, cells }: Mask, deviation: number): Mask {
  const radius = Math.ceil(4 * deviation)
  const kernel = Float64Array.from({ length: 2 * radius + 1 }, (_, i) =>
    Math.exp(-0.5 * ((i - radius) / deviation) ** 2)
  )
  const sum = kernel.reduce((a, b) => a + b)
  let values = Float32Array.from(cells)
  for (const axis of [0, 1, 2]) {
    const n = size[axis]
    const step = strides(size)[axis]
    const mirrored = Int32Array.from({ length: n + 2 * radius }, (_, i) => {
      const turn = (((i - radius) % (2 * n)) + 2 * n) % (2 * n)
      return Math.min(turn, 2 * n - 1 - turn)
    })
    const next = new Float32Array(values.length)
    forLines(size, axis, start => {
      for (let i = 0; i < n; i++) {
        let value = 0
        for (let k = 0; k <= 2 * radius; k++) {
          value += kernel[k] * values[start + step * mirrored[i + k]]
        }
        next[start + step * i] = value / sum
      }
    })
    values = next
  }
  return { size, cells: Uint8Array.from(values, value => (value > 0.5 ? 1 : 0)) }
}

/**
 * Squared distance of each cell in a mask to the nearest cell out of it [cells²]; infinite where there is
 * none.
 *
 * @see Felzenszwalb & Huttenlocher 2012, "Distance transforms of sampled functions" §2
 */
export function squaredDistances({ size, cells }: Mask): Float64Array {
  const distances = Float64Array.from(cells, cell => (cell === 1 ? Infinity : 0))
  for (const axis of [0, 1, 2]) {
    const n = size[axis]
    const step = strides(size)[axis]
    const parabolas = new Int32Array(n)
    const bounds = new Float64Array(n + 1)
    const line = new Float64Array(n)
    forLines(size, axis, start => {
      let last = -1
      for (let i = 0; i < n; i++) {
        line[i] = distances[start + step * i]
        if (line[i] === Infinity) continue
        let bound = -Infinity
        while (last >= 0) {
          const p = parabolas[last]
          bound = (line[i] + i * i - line[p] - p * p) / (2 * (i - p))
          if (bound > bounds[last]) break
          last--
        }
        if (last < 0) bound = -Infinity
        last++
        parabolas[last] = i
        bounds[last] = bound
        bounds[last + 1] = Infinity
      }
      if (last < 0) return
      let k = 0
      for (let i = 0; i < n; i++) {
        while (bounds[k + 1] < i) k++
        distances[start + step * i] = (i - parabolas[k]) ** 2 + line[parabolas[k]]
      }
    })
  }
  return distances
}

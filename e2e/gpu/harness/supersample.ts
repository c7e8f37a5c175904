import type { PerspectiveCamera } from 'three'
import { Picture } from './picture'

/** Van der Corput's sequence: offsets within a pixel, as TRAA's are. */
const halton = (index: number, base: number): number => {
  let [result, part, rest] = [0, 1, index + 1]
  while (rest > 0) {
    part /= base
    result += part * (rest % base)
    rest = Math.floor(rest / base)
  }
  return result
}

/** Signal over noise of a picture as it is shown, in [0, 1] [dB]. */
export function psnr(a: Picture, b: Picture): number {
  let sum = 0
  let count = 0
  for (let i = 0; i < a.data.length; i++) {
    if (i % 4 === 3) continue
    const [x, y] = [a.data[i], b.data[i]].map(value => Math.min(value, 1) ** (1 / 2.2))
    sum += (x - y) ** 2
    count++
  }
  return -10 * Math.log10(sum / count)
}

/**
 * Mean of frames with offsets within a pixel, of light up to 1.
 *
 * @param draw - Draws a frame by the camera.
 */
export async function supersample(
  camera: PerspectiveCamera,
  { width, height }: { width: number; height: number },
  samples: number,
  draw: () => Promise<Picture>
): Promise<Picture> {
  const mean = new Picture(width, height, new Float32Array(4 * width * height))
  for (let i = 0; i < samples; i++) {
    camera.setViewOffset(width, height, halton(i, 2) - 0.5, halton(i, 3) - 0.5, width, height)
    const drawn = await draw()
    drawn.data.forEach((value, k) => (mean.data[k] += Math.min(value, 1) / samples))
  }
  camera.clearViewOffset()
  return mean
}

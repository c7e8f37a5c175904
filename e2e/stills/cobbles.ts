import { GroundMaps } from '@welkin/terrain'
import { SRGBColorSpace } from 'three'
import { tileable } from '../../stories/src/mipmapped'

/** Texels along the side, and stones along it. */
const SIZE = 512
const STONES = 9

/** Repeatable random numbers in [0, 1) of a cell. */
function randomOf(x: number, y: number, n: number): number {
  const cell = ((x + STONES) % STONES) + STONES * ((y + STONES) % STONES)
  const value = Math.sin(12.9898 * cell + 78.233 * n) * 43758.5453
  return value - Math.floor(value)
}

/** Height of round stones in [0, 1] at a place in stones, and the nearest stone's brightness. */
function cobble(x: number, y: number): { height: number; light: number } {
  const [column, row] = [Math.floor(x), Math.floor(y)]
  let [first, second, light] = [Infinity, Infinity, 0]
  for (let j = row - 1; j <= row + 1; j++) {
    for (let i = column - 1; i <= column + 1; i++) {
      const [dx, dy] = [
        i + 0.2 + 0.6 * randomOf(i, j, 1) - x,
        j + 0.2 + 0.6 * randomOf(i, j, 2) - y
      ]
      const distance = Math.hypot(dx, dy)
      second = Math.min(second, Math.max(distance, first))
      if (distance >= first) continue
      first = distance
      light = randomOf(i, j, 3)
    }
  }
  const inside = Math.min((second - first) / 0.35, 1)
  return { height: Math.sqrt(1 - (1 - inside) ** 2), light }
}

/** Maps of cobbles, 2 m wide and 6 cm deep, in place of grass. */
export function cobbles(): GroundMaps {
  const stones = Array.from({ length: SIZE ** 2 }, (_, n) =>
    cobble(((n % SIZE) * STONES) / SIZE, (Math.floor(n / SIZE) * STONES) / SIZE)
  )
  const heightAt = (x: number, y: number): number =>
    stones[((y + SIZE) % SIZE) * SIZE + ((x + SIZE) % SIZE)].height
  /** Rise of a texel over its width: 6 cm in 2 m. */
  const steepness = (0.06 / 2) * SIZE
  const color = new Uint8Array(4 * SIZE ** 2)
  const normal = new Uint8Array(4 * SIZE ** 2)
  const relief = new Uint8Array(4 * SIZE ** 2)
  for (const [n, { height, light }] of stones.entries()) {
    const [x, y] = [n % SIZE, Math.floor(n / SIZE)]
    const shade = (90 + 60 * light) * (0.35 + 0.65 * height)
    color.set([shade, 0.95 * shade, 0.88 * shade, 255], 4 * n)
    const [dx, dy] = [
      ((heightAt(x + 1, y) - heightAt(x - 1, y)) / 2) * steepness,
      ((heightAt(x, y + 1) - heightAt(x, y - 1)) / 2) * steepness
    ]
    const length = Math.hypot(dx, dy, 1)
    normal.set(
      [-dx, -dy, 1].map(part => 127.5 + (127.5 * part) / length),
      4 * n
    )
    relief.set([255 * height, 255 * (0.75 + 0.2 * (1 - light)), 0, 255], 4 * n)
  }
  const [albedo, normals, heights] = [color, normal, relief].map(bytes => tileable(bytes, SIZE))
  albedo.colorSpace = SRGBColorSpace
  return new GroundMaps({
    grass: { albedo, normal: normals, height: heights, roughness: heights, relief: 0.06 }
  })
}

import type { PNG } from 'pngjs'

function at({ data, width }: PNG, x: number, y: number): [number, number, number] {
  const i = 4 * (y * width + x)
  return [data[i], data[i + 1], data[i + 2]]
}

/** What is wrong with the consumer's frame (320×180), in words; nothing when it is right. */
export function expectations(png: PNG): string[] {
  const wrong: string[] = []
  const expectColor = (place: string, x: number, y: number, expected: number[]): void => {
    const color = at(png, x, y)
    if (color.some((value, i) => Math.abs(value - expected[i]) > 2)) {
      wrong.push(`${place}: got ${color.join(' ')}, expected ${expected.join(' ')}`)
    }
  }
  expectColor('the globe', 160, 90, [0x22, 0x55, 0xaa])
  expectColor('space', 5, 5, [0, 0, 0])
  return wrong
}

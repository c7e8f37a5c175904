import type { PNG } from 'pngjs'

type Color = [number, number, number]

function at({ data, width }: PNG, x: number, y: number): Color {
  const i = 4 * (y * width + x)
  return [data[i], data[i + 1], data[i + 2]]
}

/** In words what is wrong with a pixel, given what it should be; nothing when it is right. */
function difference(png: PNG, place: string, x: number, y: number, expected: Color): string[] {
  const color = at(png, x, y)
  return color.some((value, i) => Math.abs(value - expected[i]) > 2)
    ? [`${place}: got ${color.join(' ')}, expected ${expected.join(' ')}`]
    : []
}

/** Per scene of the app (`app/src/NAME.ts`), what is wrong with its frame of 320×180. */
export const expectations: Record<string, (png: PNG) => string[]> = {
  geo: png => [
    ...difference(png, 'the globe', 160, 90, [0x22, 0x55, 0xaa]),
    ...difference(png, 'space', 5, 5, [0, 0, 0])
  ]
}

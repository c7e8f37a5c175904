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

/** In words what is wrong when the sky is not blue, or the sunlit ground not a bright grey. */
function checkNoon(png: PNG): string[] {
  const wrong: string[] = []
  const [skyRed, skyGreen, skyBlue] = at(png, 160, 10)
  if (!(skyBlue > skyGreen && skyGreen > skyRed && skyBlue > 100)) {
    wrong.push(`the sky is not blue: ${skyRed} ${skyGreen} ${skyBlue}`)
  }
  const ground = at(png, 160, 170)
  if (Math.min(...ground) < 90 || Math.max(...ground) - Math.min(...ground) > 40) {
    wrong.push(`the ground is not a bright grey: ${ground.join(' ')}`)
  }
  return wrong
}

/** Per scene of the app (`app/src/NAME.ts`), what is wrong with its frame of 320×180. */
export const expectations: Record<string, (png: PNG) => string[]> = {
  geo: png => [
    ...difference(png, 'the globe', 160, 90, [0x22, 0x55, 0xaa]),
    ...difference(png, 'space', 5, 5, [0, 0, 0])
  ],
  atmosphere: checkNoon
}

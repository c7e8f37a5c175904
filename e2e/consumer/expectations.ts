import type { PNG } from 'pngjs'
import type { Backend } from '../harness/backend'

type Color = [number, number, number]

/** Size in whose pixels places of a frame are given, whatever its own. */
const SIZE = { width: 320, height: 180 }

function at({ data, width }: PNG, x: number, y: number): Color {
  const scale = width / SIZE.width
  const i = 4 * (Math.floor(y * scale) * width + Math.floor(x * scale))
  return [data[i], data[i + 1], data[i + 2]]
}

/** Error of a pixel in words, given the colour that it should have; none if it is right. */
function difference(png: PNG, place: string, x: number, y: number, expected: Color): string[] {
  const color = at(png, x, y)
  return color.some((value, i) => Math.abs(value - expected[i]) > 2)
    ? [`${place}: got ${color.join(' ')}, expected ${expected.join(' ')}`]
    : []
}

const brightness = (color: Color): number => color.reduce((sum, value) => sum + value, 0)

/** Errors in words: a sky that is not blue, ground that is not sunlit, a ball without a shadow. */
function checkQuickStart(png: PNG): string[] {
  const wrong: string[] = []
  const [skyRed, skyGreen, skyBlue] = at(png, 160, 10)
  if (!(skyBlue > skyGreen && skyGreen > skyRed && skyBlue > 100)) {
    wrong.push(`the sky is not blue: ${skyRed} ${skyGreen} ${skyBlue}`)
  }
  const ground = at(png, 60, 160)
  if (Math.min(...ground) < 70 || Math.max(...ground) - Math.min(...ground) > 60) {
    wrong.push(`the ground is not sunlit: ${ground.join(' ')}`)
  }
  const shadow = at(png, 200, 130)
  if (brightness(shadow) > 0.7 * brightness(ground)) {
    wrong.push(`the ball casts no shadow: ${shadow.join(' ')} beside ${ground.join(' ')}`)
  }
  return wrong
}

/** Errors in words: a sky without clouds or of clouds alone, black ground. */
function checkClouds(png: PNG): string[] {
  const wrong: string[] = []
  let white = 0
  let blue = 0
  for (let y = 4; y < 80; y += 4) {
    for (let x = 4; x < SIZE.width; x += 4) {
      const [red, , b] = at(png, x, y)
      if (b > 1.25 * red) blue++
      else if (red > 120) white++
    }
  }
  if (white < 40) wrong.push(`there are no clouds: ${white} places are bright and not blue`)
  if (blue < 40) wrong.push(`there is no sky between the clouds: ${blue} places are blue`)
  const ground = at(png, 60, 170)
  if (Math.min(...ground) < 20) wrong.push(`the ground is dark: ${ground.join(' ')}`)
  return wrong
}

/** Checks of the frame that a page of the app (`app/PAGE.html`) draws. */
export interface Expectation {
  /** Faults of a frame, in words. */
  wrongWith: (png: PNG) => string[]
  /** Backends on which it is drawn; each has a page at least. */
  backends: readonly Backend[]
  /** Message on the console that is none of these packages' doing. */
  allows?: RegExp
}

/** Fiber's clock is one that three has replaced. */
const fibersClock = /THREE\.Clock: This module has been deprecated/

/** Expectations by name of the page. */
export const expectations: Record<string, Expectation> = {
  clouds: { wrongWith: checkClouds, backends: ['webgpu'] },
  // The quick start is drawn as webpack bundles it, without WebGPU; Vite's page of it, the very same code, and that of its parts under React are only built, as the terrain's is: its pages take minutes to draw in software.
  fiberClouds: { wrongWith: checkClouds, backends: ['webgpu'], allows: fibersClock },
  webpack: { wrongWith: checkQuickStart, backends: ['webgl'] },
  geo: {
    backends: ['webgpu'],
    wrongWith: png => [
      ...difference(png, 'the globe', 160, 90, [0x22, 0x55, 0xaa]),
      ...difference(png, 'space', 5, 5, [0, 0, 0])
    ]
  }
}

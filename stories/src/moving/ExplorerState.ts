/** A view in numbers. */
export interface ExplorerState {
  x: number
  y: number
  z: number
  /** Clockwise from north [degrees]. */
  heading: number
  /** Angle above the horizontal [degrees]. */
  pitch: number
  /** 1 while walking, 0 while flying. */
  walking: number
}

const DECIMALS = 2

/** A view as a short text, for a link: centimetres and hundredths of a degree. */
export function formatState({ x, y, z, heading, pitch, walking }: ExplorerState): string {
  return [x, y, z, heading, pitch, walking].map(n => Number(n.toFixed(DECIMALS))).join(',')
}

/** The view of such a text; undefined if it is none. */
export function parseState(text: string): ExplorerState | undefined {
  const parts = text.split(',')
  const numbers = parts.map(Number)
  if (numbers.length !== 6 || parts.includes('') || !numbers.every(Number.isFinite))
    return undefined
  const [x, y, z, heading, pitch, walking] = numbers
  return { x, y, z, heading, pitch, walking }
}

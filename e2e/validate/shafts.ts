import { readFileSync } from 'node:fs'
import type { AtmosphereParametersInit } from '@welkin/atmosphere'
import { shaftGoal } from './goals'
import type { Box, ShaftRequest } from './page/shafts'
import { withPages } from './pages'
import { everyNth, quantile } from './score'

/** Rays that lose less than this part of their light are left out. */
const NEGLIGIBLE = 0.01

/** A file like `reference/shafts.json`. */
interface ShaftFile {
  boxes: Record<string, Box[]>
  cases: {
    scene: string
    sun_elevation_deg: number
    sun_azimuth_deg: number
    camera: [number, number, number]
    sun: [number, number, number]
    rays: {
      direction: [number, number, number]
      single: number[]
      lost: number[]
    }[]
  }[]
}

/** Errors of lost light over all light scattered once; fractions. */
export interface ShaftFigures {
  n: number
  median: number
  p95: number
  byScene: { scene: string; n: number; median: number; p95: number }[]
}

/** An error, and where it is. */
export interface ShaftError {
  scene: string
  error: number
  label: string
}

const statistics = (errors: readonly ShaftError[], scene: string) => {
  const values = errors.map(({ error }) => Math.abs(error))
  return {
    scene,
    n: values.length,
    median: quantile(values, 0.5),
    p95: quantile(values, 0.95)
  }
}

/**
 * Draws the boxes of a file with and without light shafts, in one way after the other.
 *
 * @param parameters - Air of the file: that of `sky.json`.
 * @param ways - Ways of drawing.
 * @param every - Takes every so many cameras of the file.
 */
export async function validateShafts(
  file: string,
  parameters: AtmosphereParametersInit,
  ways: readonly Omit<ShaftRequest, 'parameters' | 'views'>[],
  every = 1
): Promise<(ShaftFigures & { errors: ShaftError[] })[]> {
  const { boxes, cases: all } = JSON.parse(readFileSync(file, 'utf8')) as ShaftFile
  const cases = everyNth(all, every)
  const views = cases.map(({ scene, camera, sun, rays }) => ({
    boxes: boxes[scene],
    camera,
    sun,
    directions: rays.map(({ direction }) => direction)
  }))
  return withPages('welkinShafts', async open => {
    const figures = []
    for (const way of ways) {
      const page = await open()
      const request = { ...way, parameters, views }
      const drawn = await page.evaluate(asked => window.welkinShafts(asked), request)
      await page.close()
      figures.push(figuresOf(cases, Object.keys(boxes), drawn))
    }
    return figures
  })
}

/** Errors of lost light, ray by ray, and their statistics. */
function figuresOf(
  cases: ShaftFile['cases'],
  scenes: readonly string[],
  drawn: readonly number[][][]
): ShaftFigures & { errors: ShaftError[] } {
  const errors = cases.flatMap(({ scene, rays, ...place }, i) =>
    rays.flatMap(({ direction, single, lost }, j) => {
      if (!lost.some((value, k) => value > NEGLIGIBLE * single[k])) return []
      const from = `sun ${place.sun_elevation_deg}°, ${place.sun_azimuth_deg}°, ${place.camera[1]} m`
      return lost.map((value, k) => ({
        scene,
        error: (drawn[i][j][k] - value) / single[k],
        label: `${scene}, ${from}, ray ${direction.join(' ')} #${k}, lost ${value / single[k]}`
      }))
    })
  )
  if (!errors.every(({ error }) => Number.isFinite(error))) throw new Error('the model gave NaN')
  const byScene = scenes.map(scene =>
    statistics(
      errors.filter(error => error.scene === scene),
      scene
    )
  )
  const { n, median, p95 } = statistics(errors, 'all')
  return { n, median, p95, byScene, errors }
}

/** Names the goals that light shafts miss, each with its figure. */
export function missedShaftGoals(figures: ShaftFigures): string[] {
  return (['median', 'p95'] as const).flatMap(key =>
    figures[key] <= shaftGoal[key]
      ? []
      : [`${key} of shafts is ${figures[key].toPrecision(3)}, goal ${shaftGoal[key]}`]
  )
}

const percent = (value: number): string => `${(100 * value).toFixed(2)} %`.padStart(10)

/** Prints the scores, and the largest errors. */
export function printShafts(
  title: string,
  { byScene, errors, ...all }: ShaftFigures & { errors: ShaftError[] },
  worst: number
): void {
  console.log(`Light that shadows take from the air, error over all light scattered once: ${title}`)
  console.log(
    `  ${'scene'.padEnd(10)}${'n'.padStart(6)}${'median'.padStart(10)}${'p95'.padStart(10)}`
  )
  for (const { scene, n, median, p95 } of [...byScene, { scene: 'all', ...all }]) {
    console.log(`  ${scene.padEnd(10)}${String(n).padStart(6)}${percent(median)}${percent(p95)}`)
  }
  for (const key of ['median', 'p95'] as const) {
    const mark = all[key] <= shaftGoal[key] ? '✓' : '✗'
    console.log(`  goal: ${key} ≤ ${percent(shaftGoal[key]).trim()} ${mark}`)
  }
  const largest = errors.toSorted((a, b) => Math.abs(b.error) - Math.abs(a.error))
  for (const { error, label } of largest.slice(0, worst)) {
    console.log(`  ${percent(error)}  ${label}`)
  }
}

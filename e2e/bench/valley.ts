import { photographicToneMapping } from '@welkin/atmosphere'
import { CustomToneMapping, RenderTarget, Vector3 } from 'three'
import { PassTimes, type PassTime } from '../../stories/src/valley/PassTimes'
import { openingState } from '../../stories/src/valley/openingState'
import { sharesOf } from '../../stories/src/valley/shares'
import { Valley, type ValleyState } from '../../stories/src/valley/Valley'
import type { ValleyName } from '../../stories/src/valley/views'
import { nextFrame, release, type HeadlessDevice } from '../headless/device'
import { rowsOf } from './rows'
import { median } from './statistics'

const WARM_UP = 30
/** Frames of a measurement at least: shadows of clouds, the mirrored sky and the air's tables are drawn anew every 30 to 60 of them. */
const LEAST_FRAMES = 60
/** Time between two frames [s]. */
const STEP = 1 / 60

/** Parts that the opening picture has, and that take more than the times scatter. */
const PARTS: readonly (keyof ValleyState)[] = ['clouds', 'shafts', 'trees', 'bloom']

/** Speed at which the camera turns [rad/s], and frames after which it turns back where it turns to and fro. */
const TURN = 0.25
const FRO = 15

/** Ways in which the camera turns: to and fro, so that it sees the same on the whole, or on and on. */
type Turn = 'fro' | 'on'

/** The sun is 1.5° down, and lights summits: its shadows and lamps are on together. */
const DUSK = { hour: 19.8 } as const

/** The sun is 4.5° down: the moon's shadows, lamps, stars and the light of dusk are on together. */
const NIGHTFALL = { hour: 20.15 } as const

/** Everything that is on before bloom, depth of field and smoothed edges. */
const FULL = {
  occlusion: true,
  motionBlur: true,
  bloom: false,
  antialiasing: 'none'
} as const

/** The full moon stands high. */
const WINTER = { date: Date.UTC(2026, 11, 24), hour: 22 } as const

const MIST = { ...FULL, weather: 'mist' } as const
const SNOW = { ...FULL, weather: 'snow' } as const
const STORM = { ...FULL, weather: 'storm' } as const

/** Conditions of a measurement. */
interface Conditions {
  changes: Partial<ValleyState>
  /** Place of the camera, by default the village. */
  view?: ValleyName
  turn?: Turn
  /** A flash to the ground is seen all the time. */
  flash?: true
}

interface Row extends Conditions {
  name: string
}

/** Weathers and hours with all that is on, what one of them costs as the story opens, and while the camera turns. */
const ROWS: readonly Row[] = [
  { name: 'fair, as the story opens, without bloom', changes: { bloom: false } },
  { name: 'fair', changes: FULL },
  { name: 'fair, smooth edges', changes: { ...FULL, antialiasing: 'edges' } },
  { name: 'fair, turning to and fro', changes: FULL, turn: 'fro' },
  { name: 'fair, turning on', changes: FULL, turn: 'on' },
  { name: 'fair, from the shore', changes: FULL, view: 'shore' },
  { name: 'fair, over the lake', changes: FULL, view: 'west' },
  { name: 'fair, from a slope', changes: FULL, view: 'slope' },
  { name: 'fair, above the clouds', changes: FULL, view: 'above' },
  { name: 'broken', changes: { ...FULL, weather: 'broken' } },
  { name: 'broken, above the clouds', changes: { ...FULL, weather: 'broken' }, view: 'above' },
  { name: 'overcast', changes: { ...FULL, weather: 'overcast' } },
  { name: 'mist', changes: MIST },
  { name: 'mist, from a slope', changes: MIST, view: 'slope' },
  { name: 'shower', changes: { ...FULL, weather: 'shower' } },
  { name: 'snow', changes: SNOW },
  { name: 'storm', changes: STORM },
  { name: 'storm, turning', changes: STORM, turn: 'on' },
  { name: 'storm, a flash', changes: STORM, flash: true },
  { name: 'storm, above the clouds', changes: STORM, view: 'above' },
  { name: 'dusk', changes: { ...FULL, ...DUSK } },
  { name: 'dusk, above the clouds', changes: { ...FULL, ...DUSK }, view: 'above' },
  { name: 'mist at dusk', changes: { ...MIST, ...DUSK } },
  { name: 'snow at dusk', changes: { ...SNOW, ...DUSK } },
  { name: 'storm at dusk', changes: { ...STORM, ...DUSK } },
  { name: 'storm at dusk, from the shore', changes: { ...STORM, ...DUSK }, view: 'shore' },
  {
    name: 'storm at dusk, turning, a flash',
    changes: { ...STORM, ...DUSK },
    turn: 'on',
    flash: true
  },
  {
    name: 'storm at nightfall, turning, a flash',
    changes: { ...STORM, ...NIGHTFALL },
    turn: 'on',
    flash: true
  },
  { name: 'night', changes: { ...FULL, ...WINTER } },
  { name: 'night, snow', changes: { ...SNOW, ...WINTER } }
]

/** Time that a row may take, with all that is on before bloom, depth of field and TRAA [ms]. */
const GOAL = 10

/** Time over which the picture gathers a flash's light [s], and its distance [m]. */
const FLASH = { seconds: 0.5, distance: 3000 } as const

/** Line about ambient occlusion, which rows at rest leave out. */
const AT_REST =
  ' ambient occlusion is drawn anew only while the camera or things move: at rest it costs what the land reads of it'

/** GPU times of the valley at medium quality [ms]. */
export interface ValleyCost {
  /** Shares of a frame as the story opens, with bloom: means. None where rows were asked for. */
  opening: PassTime[]
  /** Time of what features draw in each weather, by timestamps of their passes. */
  rows: [name: string, features: PassTime[]][]
  /** Time that is saved with a part off. */
  parts: PassTime[]
  /** Time to submit a frame as the story opens, median. */
  cpuMs: number
}

/** Makes flashes as bright as in nature, and of a time that pictures gather. */
export function bareFlashes({ storm }: Valley): void {
  Object.assign(storm, { limit: null, exposure: FLASH.seconds })
}

/** Has a flash to the ground stay in sight of the camera, at its brightest, or has none. */
export function holdFlash({ storm, camera }: Valley, isHeld: boolean): void {
  // Its clock stands: no flash begins of itself, and one of before is over.
  storm.time = (storm.time ?? 0) + 60
  if (!isHeld) return
  camera.updateMatrixWorld()
  const at = new Vector3(0, 0, -FLASH.distance).applyMatrix4(camera.matrixWorld)
  const show = (): void => {
    storm.time = (storm.time ?? 0) + FLASH.seconds
    storm.removeEventListener('strike', show)
  }
  storm.addEventListener('strike', show)
  storm.strike({ kind: 'ground', at })
}

const sumOf = (shares: PassTime[]): number => shares.reduce((total, [, ms]) => total + ms, 0)

/**
 * Times the valley of the story, on its clock.
 *
 * @param only - Rows that are timed, by how their names begin; if there are none all of them, the story as it opens, and what parts cost.
 * @param log - Takes lines of a report, as soon as they are known.
 * @throws If no row's name begins so.
 */
export async function timeValley(
  device: HeadlessDevice,
  size: readonly [number, number],
  frames: number,
  only: readonly string[],
  log: (text: string) => void
): Promise<ValleyCost> {
  const asked = rowsOf(
    'valley',
    ROWS.map(({ name }) => name),
    only,
    (name, word) => name.startsWith(word)
  )
  const renderer = await device.renderer(...size, { reversedDepthBuffer: true })
  renderer.highPrecision = true
  renderer.shadowMap.enabled = true
  renderer.library.addToneMapping(photographicToneMapping(), CustomToneMapping)
  renderer.toneMapping = CustomToneMapping
  const times = new PassTimes()
  renderer.inspector = times
  const valley = new Valley(renderer, { ...openingState, flashes: true })
  bareFlashes(valley)
  await valley.bake(renderer)
  valley.camera.aspect = size[0] / size[1]
  valley.camera.updateProjectionMatrix()
  // As the story's canvas, it has no depth.
  const target = new RenderTarget(...size, { depthBuffer: false })
  let time = 0
  const often = Math.max(frames, LEAST_FRAMES)

  /** Shares of a frame [ms], and the median time to submit it. */
  const measure = async (conditions: Conditions): Promise<[PassTime[], number]> => {
    const { changes, view = 'village', turn, flash } = conditions
    const state = { ...openingState, flashes: true, ...changes }
    valley.set(state, true)
    valley.cycle.hour = state.hour // the clock has gone on
    valley.lookFrom(view)
    holdFlash(valley, flash === true)
    const passes: PassTime[] = []
    const cpu: number[] = []
    for (let frame = 0; frame < WARM_UP + often; frame++) {
      nextFrame()
      valley.time = time += STEP
      const isBack = turn === 'fro' && frame % (2 * FRO) >= FRO
      if (turn !== undefined) valley.camera.rotateY(TURN * STEP * (isBack ? -1 : 1))
      renderer.setRenderTarget(target)
      const start = performance.now()
      valley.render(STEP)
      cpu.push(performance.now() - start)
      renderer.setRenderTarget(null)
      const read = await times.read(renderer)
      if (frame >= WARM_UP) passes.push(...read.passes)
    }
    if (valley.storm.isFlashing !== (flash === true)) throw new Error('valley: flash is amiss')
    const shares = sharesOf(passes, state).map(([name, ms]) => [name, ms / often] as const)
    return [shares, median(cpu.slice(WARM_UP))]
  }
  const list = (shares: PassTime[]): string[] =>
    shares.map(([name, ms]) => `  ${name.padEnd(36)} ${ms.toFixed(2)} ms`)
  const isWhole = only.length === 0
  const [opening, cpuMs] = isWhole ? await measure({ changes: {} }) : [[], NaN]
  if (isWhole) {
    const sum = sumOf(opening).toFixed(2)
    log(`valley at medium, as the story opens   ${sum} ms; CPU ${cpuMs.toFixed(2)} ms`)
  }
  const rows: ValleyCost['rows'] = []
  for (const row of ROWS) {
    if (!asked.has(row.name)) continue
    const [shares] = await measure(row)
    log([` ${row.name}   ${sumOf(shares).toFixed(2)} ms`, ...list(shares)].join('\n'))
    rows.push([row.name, shares])
  }
  const over = rows.filter(([, shares]) => sumOf(shares) > GOAL).map(([name]) => name)
  if (over.length > 0) process.exitCode = 1
  log(over.length > 0 ? ` over ${GOAL} ms: ${over.join('; ')}` : ` no row takes over ${GOAL} ms`)
  const parts: PassTime[] = []
  for (const part of isWhole ? PARTS : []) {
    const [without] = await measure({ changes: { [part]: false } })
    parts.push([part, sumOf(opening) - sumOf(without)])
  }
  if (parts.length > 0) log([' saved with a part off', ...list(parts)].join('\n'))
  log(AT_REST)
  valley.dispose()
  target.dispose()
  release(renderer)
  return { opening, rows, parts, cpuMs }
}

import { photographicToneMapping } from '@welkin/atmosphere'
import { CustomToneMapping, RenderTarget } from 'three'
import { PassTimes, type PassTime } from '../../stories/src/valley/PassTimes'
import { openingState } from '../../stories/src/valley/openingState'
import { sharesOf } from '../../stories/src/valley/shares'
import { Valley, type ValleyState } from '../../stories/src/valley/Valley'
import { nextFrame, release, type HeadlessDevice } from '../headless/device'
import { median } from './statistics'

const WARM_UP = 30
/** Frames of a measurement at least: shadows of clouds, the mirrored sky and the air's tables are drawn anew every 30 to 60 of them. */
const LEAST_FRAMES = 120
/** Time between two frames [s]. */
const STEP = 1 / 60

/** Parts that the opening picture has, and that take more than the times scatter. */
const PARTS: readonly (keyof ValleyState)[] = ['clouds', 'shafts', 'trees', 'bloom']

/** Speed at which the camera turns [rad/s], and frames after which it turns back where it turns to and fro. */
const TURN = 0.25
const FRO = 15

/** Ways in which the camera turns: to and fro, so that it sees the same on the whole, or on and on. */
type Turn = 'fro' | 'on'

/** The sun is 1.5° down: its light and that of lamps, stars and moon are on together. */
const DUSK = { hour: 19.8 } as const

/** Everything that is on before bloom, depth of field and TRAA. */
const FULL = { occlusion: true, motionBlur: true, bloom: false } as const

/** The full moon stands high. */
const WINTER = { date: Date.UTC(2026, 11, 24), hour: 22 } as const

/** Weathers and hours with all that is on, what one of them costs as the story opens, and while the camera turns. */
const ROWS: readonly (readonly [name: string, changes: Partial<ValleyState>, turn?: Turn])[] = [
  ['fair, as the story opens, without bloom', { bloom: false }],
  ['fair', FULL],
  ['fair, while the camera turns to and fro', FULL, 'fro'],
  ['fair, while the camera turns on', FULL, 'on'],
  ['broken', { ...FULL, weather: 'broken' }],
  ['overcast', { ...FULL, weather: 'overcast' }],
  ['mist', { ...FULL, weather: 'mist' }],
  ['shower', { ...FULL, weather: 'shower' }],
  ['snow', { ...FULL, weather: 'snow' }],
  ['storm', { ...FULL, weather: 'storm' }],
  ['dusk', { ...FULL, ...DUSK }],
  ['night', { ...FULL, ...WINTER }],
  ['night, snow', { ...FULL, ...WINTER, weather: 'snow' }]
]

/** GPU times of the valley at medium quality [ms]. */
export interface ValleyCost {
  /** A frame as the story opens, with bloom: mean. */
  totalMs: number
  /** Time of what features draw in each weather, by timestamps of their passes. */
  rows: [name: string, features: PassTime[]][]
  /** Time that is saved with a part off. */
  parts: PassTime[]
  /** Time to submit a frame, median. */
  cpuMs: number
}

const sumOf = (shares: PassTime[]): number => shares.reduce((total, [, ms]) => total + ms, 0)

/** Times the valley of the story, on its clock. */
export async function timeValley(
  device: HeadlessDevice,
  size: readonly [number, number],
  frames: number
): Promise<ValleyCost> {
  const renderer = await device.renderer(...size, { reversedDepthBuffer: true })
  renderer.highPrecision = true
  renderer.shadowMap.enabled = true
  renderer.library.addToneMapping(photographicToneMapping(), CustomToneMapping)
  renderer.toneMapping = CustomToneMapping
  const times = new PassTimes()
  renderer.inspector = times
  const valley = new Valley(renderer, openingState)
  await valley.bake(renderer)
  valley.lookFrom('village')
  valley.camera.aspect = size[0] / size[1]
  valley.camera.updateProjectionMatrix()
  // As the story's canvas, it has no depth.
  const target = new RenderTarget(...size, { depthBuffer: false })
  let time = 0

  const measure = async (
    changes: Partial<ValleyState>,
    frames: number,
    turn?: Turn
  ): Promise<[PassTime[], number]> => {
    const state = { ...openingState, ...changes }
    valley.set(state, true)
    valley.cycle.hour = state.hour // the clock has gone on
    valley.lookFrom('village')
    const passes: PassTime[] = []
    const cpu: number[] = []
    for (let frame = 0; frame < WARM_UP + frames; frame++) {
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
    const shares = sharesOf(passes, state).map(([name, ms]) => [name, ms / frames] as const)
    return [shares, median(cpu.slice(WARM_UP))]
  }
  const often = Math.max(frames, LEAST_FRAMES)
  const [features, cpuMs] = await measure({}, often)
  const totalMs = sumOf(features)
  const rows: ValleyCost['rows'] = []
  for (const [name, changes, turn] of ROWS) {
    rows.push([name, (await measure(changes, often, turn))[0]])
  }
  const parts: PassTime[] = []
  for (const part of PARTS) {
    parts.push([part, totalMs - sumOf((await measure({ [part]: false }, often))[0])])
  }
  valley.dispose()
  target.dispose()
  release(renderer)
  return { totalMs, rows, parts, cpuMs }
}

/** Lines of a report. */
export function valleyLines({ totalMs, rows, parts, cpuMs }: ValleyCost): string {
  const list = (shares: PassTime[]): string =>
    shares.map(([name, ms]) => `  ${name.padEnd(36)} ${ms.toFixed(2)} ms`).join('\n')
  const inRows = rows.map(
    ([name, features]) => ` ${name}   ${sumOf(features).toFixed(2)} ms\n${list(features)}`
  )
  return (
    `valley at medium, as the story opens   ${totalMs.toFixed(2)} ms; CPU ${cpuMs.toFixed(2)} ms\n` +
    `${inRows.join('\n')}\n saved with a part off\n${list(parts)}`
  )
}

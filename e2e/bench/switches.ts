import { photographicToneMapping } from '@welkin/atmosphere'
import { CustomToneMapping, RenderTarget } from 'three'
import { STILL_QUALITY } from '../../stories/src/clouds/still'
import { openingState } from '../../stories/src/valley/openingState'
import { Valley, type ValleyState } from '../../stories/src/valley/Valley'
import type { ValleyName } from '../../stories/src/valley/views'
import { nextFrame, release, type HeadlessDevice } from '../headless/device'
import { readPicture } from '../stills/readPicture'
import { rowsOf } from './rows'
import { bareFlashes, holdFlash } from './valley'

/** Frames after a switch, in which shadows, light of the sky and exposure follow. */
const FRAMES = 40

/** Time between two frames [s]. */
const STEP = 1 / 30

/** Speed at which the camera turns where motion must be seen [rad/s]. */
const TURN = 0.5

/** Change of a colour that one sees, of 255, and how often it must be that of two pictures in the same state. */
const SEEN = 3
const OVER_NOISE = 3

const NIGHT = { date: Date.UTC(2026, 11, 24), hour: 22 } as const
/** The new moon is down: stars and airglow are seen. */
const DARK = { date: Date.UTC(2026, 5, 15), hour: 0 } as const

/** A switch of the panel, and conditions in which it is seen. */
interface Switch {
  name: keyof ValleyState
  /** Its other position; by default the opposite of the first. */
  value?: string
  state?: Partial<ValleyState>
  view?: ValleyName
  isTurning?: true
  /** A flash is asked for before each picture, and lasts. */
  isStruck?: true
  /** Least share of the pixels that change. */
  least: number
}

const SWITCHES: readonly Switch[] = [
  { name: 'clouds', least: 0.1 },
  { name: 'cloudShadows', least: 0.02 },
  { name: 'shadows', least: 0.02 },
  { name: 'shafts', state: { hour: 18.5, weather: 'broken' }, least: 0.02 },
  { name: 'haze', least: 0.1 },
  { name: 'mist', state: { weather: 'mist' }, least: 0.1 },
  { name: 'precipitation', state: { weather: 'shower' }, least: 0.1 },
  {
    name: 'rainbow',
    // Ground that gets wetter changes of itself.
    state: { weather: 'shower', hour: 12.3, date: Date.UTC(2026, 10, 1), wetGround: false },
    least: 0.002
  },
  { name: 'flashes', state: { ...NIGHT, weather: 'storm' }, isStruck: true, least: 0.1 },
  { name: 'wetGround', state: { weather: 'snow' }, least: 0.1 },
  { name: 'moon', state: NIGHT, least: 0.1 },
  { name: 'moonlight', state: NIGHT, least: 0.05 },
  { name: 'stars', state: { ...DARK, weather: 'clear' }, least: 0.002 },
  { name: 'milkyWay', state: { ...DARK, weather: 'clear' }, least: 0.002 },
  { name: 'airglow', state: { ...DARK, weather: 'clear' }, least: 0.02 },
  { name: 'flare', state: { weather: 'clear', hour: 7 }, least: 0.002 },
  { name: 'trees', least: 0.02 },
  { name: 'village', least: 0.02 },
  { name: 'lamps', state: DARK, least: 0.005 },
  { name: 'water', view: 'shore', least: 0.02 },
  { name: 'environment', view: 'shore', state: { reflections: false }, least: 0.02 },
  { name: 'reflections', view: 'shore', least: 0.005 },
  { name: 'autoExposure', state: NIGHT, least: 0.5 },
  { name: 'occlusion', least: 0.005 },
  { name: 'localExposure', state: { weather: 'shower' }, least: 0.1 },
  { name: 'bloom', least: 0.01 },
  { name: 'depthOfField', least: 0.01 },
  { name: 'motionBlur', isTurning: true, least: 0.01 },
  { name: 'antialiasing', value: 'edges', least: 0.005 },
  { name: 'antialiasing', value: 'fxaa', least: 0.005 },
  // SMAA asks for a browser's `Image`.
  { name: 'antialiasing', value: 'traa', least: 0.005 },
  { name: 'antialiasing', value: 'taau', least: 0.01 },
  { name: 'quality', value: 'low', state: { quality: 'medium' }, least: 0.01 },
  { name: 'quality', value: 'high', state: { quality: 'medium' }, least: 0.01 }
]

/** Shares of the pixels of the valley's picture that a switch changes. */
export interface SwitchChange {
  name: string
  changed: number
  /** Share that changes without the switch. */
  noise: number
  least: number
}

/** Share of the pixels in which two pictures differ, as one sees. */
function changedShare(a: Uint8Array, b: Uint8Array): number {
  let count = 0
  for (let i = 0; i < a.length; i += 4) {
    if ([0, 1, 2].some(k => Math.abs(a[i + k] - b[i + k]) > SEEN)) count++
  }
  return (4 * count) / a.length
}

const isSeen = ({ changed, noise, least }: SwitchChange): boolean =>
  changed >= Math.max(least, OVER_NOISE * noise)

/** Line of a report. */
const switchLine = (change: SwitchChange): string => {
  const percent = (share: number): string => `${(100 * share).toFixed(2)} %`.padStart(8)
  const { name, changed, noise } = change
  return `${isSeen(change) ? ' ' : '✗'} ${name.padEnd(20)} changes ${percent(changed)}, of itself ${percent(noise)}`
}

/**
 * Throws each switch of the valley's panel to and fro, and compares the pictures.
 *
 * @param only - Switches, by name; all if there are none.
 * @throws If one changes nothing that one sees, or does not come back, or a name is of none.
 */
export async function measureSwitches(
  device: HeadlessDevice,
  only: readonly string[],
  log: (text: string) => void
): Promise<SwitchChange[]> {
  const taken = rowsOf(
    'switches',
    SWITCHES.map(({ name }) => name),
    only
  )
  const size = [480, 270] as const
  const renderer = await device.renderer(...size, { reversedDepthBuffer: true })
  renderer.highPrecision = true
  renderer.shadowMap.enabled = true
  renderer.library.addToneMapping(photographicToneMapping(), CustomToneMapping)
  renderer.toneMapping = CustomToneMapping
  const base: ValleyState = {
    ...openingState,
    antialiasing: 'none',
    quality: STILL_QUALITY,
    paused: true
  }
  const valley = new Valley(renderer, base)
  bareFlashes(valley)
  await valley.bake(renderer)
  valley.camera.aspect = size[0] / size[1]
  valley.camera.updateProjectionMatrix()
  const target = new RenderTarget(...size, { depthBuffer: false })

  const draw = async (
    state: ValleyState,
    { view, isTurning, isStruck }: Switch
  ): Promise<Uint8Array> => {
    valley.set(state, true)
    valley.lookFrom(view ?? 'village')
    if (isStruck) holdFlash(valley, state.flashes)
    for (let i = 0; i < FRAMES; i++) {
      nextFrame()
      valley.time = 100
      // To and fro: it ends where it began.
      if (isTurning) valley.camera.rotateY((i % 2 === 0 ? 1 : -1) * TURN * STEP)
      renderer.setRenderTarget(target)
      valley.render(STEP)
      renderer.setRenderTarget(null)
      if (i % 8 === 7 && state.autoExposure) await valley.exposure.settle()
    }
    return readPicture(renderer, target)
  }
  const changes: SwitchChange[] = []
  for (const each of SWITCHES) {
    const { name, value, least, state } = each
    if (!taken.has(name)) continue
    const isOfExposure = name === 'autoExposure'
    const asked: ValleyState = { ...base, ...state }
    // An exposure that stays must stand out: it is that of another hour. Others must not hide behind one that adapts.
    await draw(isOfExposure ? base : asked, each)
    const before: ValleyState = isOfExposure ? asked : { ...asked, autoExposure: false }
    const after: ValleyState = { ...before, [name]: value ?? before[name] !== true }
    const states = isOfExposure ? [after, before, before] : [before, after, before]
    const pictures: Uint8Array[] = []
    for (const next of states) pictures.push(await draw(next, each))
    const [first, second, third] = pictures
    const noise = isOfExposure ? [second, third] : [first, third]
    const change = {
      name: value === undefined ? name : `${name} ${value}`,
      changed: changedShare(first, second),
      noise: changedShare(noise[0], noise[1]),
      least
    }
    log(switchLine(change))
    changes.push(change)
  }
  valley.dispose()
  target.dispose()
  release(renderer)
  const dead = changes.filter(change => !isSeen(change))
  if (dead.length > 0) throw new Error(`switches: ${dead.map(({ name }) => name).join(', ')}`)
  return changes
}

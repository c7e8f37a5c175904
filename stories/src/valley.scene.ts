import type { CloudQualityName } from '@welkin/clouds'
import { STILL_QUALITY } from './clouds/still'
import { Explorer } from './moving/Explorer'
import { changeOf, createRenderer, drawSettled, fitToCanvas, frameClock } from './scene'
import type { RendererArgs, SceneHandle } from './scene'
import { ShownHour, toHundredths } from './ShownHour'
import { valleyFooting } from './valley/footing'
import { HourArc } from './valley/HourArc'
import { Readout } from './valley/readout'
import { ShownDate, wayTo } from './valley/ShownDate'
import { Valley, type ValleyState } from './valley/Valley'
import type { ValleyName } from './valley/views'

export interface ValleyArgs extends RendererArgs, Omit<ValleyState, 'quality' | 'date'> {
  view: ValleyName
  /** A moment of the day, UTC [ms since 1970]; from an address, a date. */
  date: number | Date
  quality: CloudQualityName
}

/** A still marches every pixel of the clouds in every frame, coarsely. */
const STILL = { quality: STILL_QUALITY, frames: 2 }

/** Time of the clouds' drift at the start, and in a still [s]. */
const STILL_TIME = 100

const stateOf = (args: ValleyArgs): ValleyState => ({
  ...args,
  date: Number(args.date),
  paused: args.paused || args.frame,
  quality: args.frame ? STILL.quality : args.quality
})

/** A valley with all that Welkin has, at any hour and in any weather. */
export async function createValley(
  canvas: HTMLCanvasElement,
  args: ValleyArgs
): Promise<SceneHandle<ValleyArgs>> {
  const renderer = await createRenderer(canvas, args.forceWebGL, !args.frame, true)
  const current = { ...args }
  const valley = new Valley(renderer, stateOf(current))
  const { scene, camera } = valley
  const explorer = current.frame
    ? undefined
    : new Explorer(camera, canvas, {
        groundAt: place => valley.groundAt(place),
        ...valleyFooting(() => current, valley.trunkAt)
      })
  const shown = (): ValleyState => ({
    ...stateOf(current),
    date: shownDate.date,
    hour: shownHour.byHand
  })
  /** Changes by which a feature is off that is measured. */
  let off: Partial<ValleyState> = {}
  const measured = (changes: Partial<ValleyState> = {}): void => {
    off = changes
    valley.set({ ...shown(), ...off })
  }
  const readout = current.frame ? undefined : new Readout(canvas, renderer, shown, measured)
  const setHour = (asked: number, isLast: boolean): void => {
    const hour = toHundredths(asked)
    handle.update({ hour })
    if (isLast) handle.onArgs?.({ hour })
  }
  const arc = current.frame ? undefined : new HourArc(canvas, setHour)
  await valley.bake(renderer)

  const goTo = (name: ValleyName, seconds: number): void => {
    if (explorer === undefined || seconds === 0) valley.lookFrom(name)
    else void explorer.flyTo(valley.placeOf(name), seconds)
  }
  goTo(current.view, 0)

  const elapsed = frameClock(args.frame)
  let time = STILL_TIME
  const shownHour = new ShownHour(current.hour)
  const shownDate = new ShownDate(Number(current.date))
  const showTime = (): void => {
    const hour = current.paused ? undefined : shownHour.next(valley.cycle.hour)
    if (hour === undefined) return
    const today = shownDate.next(valley.cycle)
    handle.onArgs?.({ hour, ...(today !== undefined && { date: today }) })
  }
  const draw = (): void => {
    const start = performance.now()
    const delta = elapsed()
    explorer?.update(delta)
    valley.time = time += delta
    valley.render(delta)
    showTime()
    const spent = performance.now() - start
    const ground = valley.groundAt(camera.position)
    arc?.update(valley.cycle.hour, current.latitude, valley.cycle.season)
    readout?.update(camera, ground, valley.cycle, current, spent)
  }

  let ready: Promise<void> = Promise.resolve()
  const warmUp = (): void => {
    if (current.frame) ready = drawSettled(STILL.frames, draw, () => valley.exposure)
  }
  /** Arguments that the clock changes. */
  const moving = { hour: undefined, date: undefined }
  const isOther = changeOf()
  isOther({ ...current, ...moving })
  const handle: SceneHandle<ValleyArgs> = {
    renderer,
    scene,
    camera,
    explorer,
    get conditions() {
      return { hour: valley.cycle.hour, weather: valley.weather }
    },
    get ready() {
      return ready
    },
    progress: 1,
    render: draw,
    resize(width, height, pixelRatio) {
      fitToCanvas(renderer, camera, width, height, pixelRatio)
      warmUp()
    },
    update(changes) {
      const { view, hour, date } = current
      Object.assign(current, changes)
      const isDaySet = shownDate.take(Number(current.date), Number(date), valley.cycle)
      const isSet = shownHour.take(current.hour, hour)
      // The clock goes on while features are measured.
      const isChanged = isOther({ ...current, ...moving })
      if (isSet || isDaySet || isChanged) readout?.reset()
      valley.set({ ...shown(), ...off }, current.frame)
      if (isSet) valley.cycle.hour = current.hour
      const way = wayTo(shownDate.date, valley.cycle)
      if (way !== 0) valley.cycle.time += way // another longitude may have another day
      if (current.view !== view) goTo(current.view, 4)
      warmUp()
    },
    dispose() {
      explorer?.dispose()
      readout?.dispose()
      arc?.dispose()
      valley.dispose()
      void renderer.dispose()
    }
  }
  return handle
}

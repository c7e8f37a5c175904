import { MathUtils } from 'three'
import { clockOf } from './clock'

/** Size of the arc [px], and elevation of the sun at its upper edge [°]. */
const WIDTH = 300
const HEIGHT = 84
const HIGHEST = 90

/** Obliquity of the ecliptic [°]. */
const OBLIQUITY = 23.44

/** Step of the arrow keys [h]. */
const STEP = 0.25

const STYLE = `
  .welkin-hour { position: absolute; left: 50%; bottom: 12px; width: ${WIDTH}px; height: ${HEIGHT}px;
    transform: translateX(-50%); border-radius: 6px; background: rgb(5 7 10 / 55%); cursor: grab; touch-action: none }
  .welkin-hour:active { cursor: grabbing }
  .welkin:has(.welkin-hour) .welkin-help { bottom: ${HEIGHT + 24}px }
  .welkin-hour svg { display: block; overflow: visible }
  .welkin-hour text { fill: #e8edf2; font: 11px system-ui, sans-serif; text-anchor: middle }
`

/**
 * Elevation of the sun [°].
 *
 * @param hour - Solar time [h].
 * @param latitude - [°]
 * @param season - Part of the year since the equinox of March.
 */
export function sunElevation(hour: number, latitude: number, season: number): number {
  const { sin, cos, asin, PI } = Math
  const sinDeclination = sin(MathUtils.degToRad(OBLIQUITY)) * sin(2 * PI * season)
  const phi = MathUtils.degToRad(latitude)
  const hourAngle = (PI * (hour - 12)) / 12
  const cosDeclination = Math.sqrt(1 - sinDeclination ** 2)
  return MathUtils.radToDeg(
    asin(sin(phi) * sinDeclination + cos(phi) * cosDeclination * cos(hourAngle))
  )
}

const xOf = (hour: number): number => (hour / 24) * WIDTH
const yOf = (elevation: number): number => HEIGHT / 2 - (elevation / HIGHEST) * (HEIGHT / 2 - 6)

/** A day and its hour, which one drags along the sun's way over and under the horizon. */
export class HourArc {
  readonly #element: HTMLElement
  readonly #onHour: (hour: number, isLast: boolean) => void
  #latitude = 0
  #season = 0
  #hour = 12

  /** @param onHour - Called with the hour that the user asks for [h], and true unless a drag goes on. */
  constructor(canvas: HTMLCanvasElement, onHour: (hour: number, isLast: boolean) => void) {
    this.#onHour = onHour
    const element = document.createElement('div')
    element.className = 'welkin-hour'
    element.tabIndex = 0
    element.role = 'slider'
    for (const [name, value] of [
      ['label', 'Hour'],
      ['valuemin', '0'],
      ['valuemax', '24']
    ]) {
      element.setAttribute(`aria-${name}`, value)
    }
    element.innerHTML = `<style>${STYLE}</style>
      <svg width="${WIDTH}" height="${HEIGHT}">
        <path class="night" fill="rgb(20 30 60 / 70%)" />
        <path class="way" fill="none" stroke="#ffd28a" stroke-width="1.5" />
        <line x2="${WIDTH}" y1="${HEIGHT / 2}" y2="${HEIGHT / 2}" stroke="#e8edf2" stroke-opacity=".5" />
        <circle r="6" stroke="#fff" /><text y="${HEIGHT - 5}"></text>
      </svg>`
    element.addEventListener('pointerdown', event => {
      element.setPointerCapture(event.pointerId)
      this.#drag(event, false)
    })
    element.addEventListener('pointermove', event => {
      if (element.hasPointerCapture(event.pointerId)) this.#drag(event, false)
    })
    element.addEventListener('pointerup', event => this.#drag(event, true))
    element.addEventListener('keydown', event => this.#step(event))
    this.#element = element
    canvas.parentElement?.append(element)
  }

  /** Shows an hour [h] of a day at a latitude [°] and in a season. */
  update(hour: number, latitude: number, season: number): void {
    if (latitude !== this.#latitude || season !== this.#season) this.#drawWay(latitude, season)
    this.#hour = hour
    const y = yOf(sunElevation(hour, latitude, season))
    const clock = clockOf(hour)
    const sun = this.#element.querySelector('circle')!
    sun.setAttribute('cx', xOf(hour).toFixed(1))
    sun.setAttribute('cy', y.toFixed(1))
    sun.setAttribute('fill', y > HEIGHT / 2 ? '#34406a' : '#ffb347')
    const text = this.#element.querySelector('text')!
    text.setAttribute('x', MathUtils.clamp(xOf(hour), 16, WIDTH - 16).toFixed(1))
    if (text.textContent === clock) return
    text.textContent = clock
    this.#element.setAttribute('aria-valuenow', hour.toFixed(2))
    this.#element.setAttribute('aria-valuetext', clock)
  }

  #drawWay(latitude: number, season: number): void {
    this.#latitude = latitude
    this.#season = season
    const points = Array.from({ length: 97 }, (_, i) => {
      const hour = i / 4
      return `${xOf(hour).toFixed(1)} ${yOf(sunElevation(hour, latitude, season)).toFixed(1)}`
    })
    this.#element.querySelector('.way')!.setAttribute('d', `M${points.join('L')}`)
    const floor = `M0 ${HEIGHT / 2}H${WIDTH}V${HEIGHT}H0Z`
    this.#element.querySelector('.night')!.setAttribute('d', floor)
  }

  #drag({ clientX }: PointerEvent, isLast: boolean): void {
    const { left, width } = this.#element.getBoundingClientRect()
    this.#onHour(MathUtils.clamp((24 * (clientX - left)) / width, 0, 23.99), isLast)
  }

  #step(event: KeyboardEvent): void {
    const steps: Readonly<Record<string, number>> = {
      ArrowLeft: -STEP,
      ArrowDown: -STEP,
      ArrowRight: STEP,
      ArrowUp: STEP,
      PageDown: -3,
      PageUp: 3
    }
    const step = steps[event.key]
    if (step === undefined) return
    event.preventDefault()
    event.stopPropagation()
    this.#onHour((this.#hour + step + 24) % 24, true)
  }

  dispose(): void {
    this.#element.remove()
  }
}

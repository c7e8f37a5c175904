import { Vector2, type Vector3 } from 'three'

/** Keys that move, by their place on the keyboard: right, up, forward. */
const DIRECTIONS: Record<string, readonly [number, number, number]> = {
  KeyW: [0, 0, 1],
  KeyS: [0, 0, -1],
  KeyA: [-1, 0, 0],
  KeyD: [1, 0, 0],
  KeyE: [0, 1, 0],
  KeyQ: [0, -1, 0]
}
const USED = new Set([...Object.keys(DIRECTIONS), 'KeyF', 'Space', 'ShiftLeft', 'ShiftRight'])

/** Way of two fingers for full speed [px]. */
const TOUCH_RADIUS = 80
/** Wheel's way that doubles the speed [px]. */
const WHEEL_DOUBLING = 300
const LEAST_SPEED = 1 / 16
const MOST_SPEED = 16

/** Elements that take letters; sliders and checkboxes do not. */
export const TYPED =
  'textarea, select, [contenteditable], input:not([type=range], [type=checkbox], [type=radio], [type=button], [type=color])'
const PRESSED = 'button, summary, a, input'

/** True for the mouse's other buttons, and for button and wheel with Ctrl: these are left to other controls. */
export const isOthers = (event: PointerEvent | WheelEvent): boolean =>
  event.ctrlKey || ('pointerType' in event && event.pointerType === 'mouse' && event.button !== 0)

interface Finger {
  readonly start: Vector2
  readonly at: Vector2
}

/** Keys, mouse, wheel and fingers of an {@link Explorer}, as wishes to move. */
export class ExplorerInput {
  /** Factor of speed that the wheel sets. */
  speed = 1

  private readonly canvas: HTMLElement
  private readonly keys = new Set<string>()
  private readonly fingers = new Map<number, Finger>()
  private readonly turned = new Vector2()
  private readonly listeners = new AbortController()
  private isToggled = false
  private isUsed = false

  constructor(canvas: HTMLElement) {
    this.canvas = canvas
    // Else the browser takes the first finger for a scroll.
    canvas.style.touchAction = 'none'
    const { signal } = this.listeners
    const page = canvas.ownerDocument
    const view = page.defaultView ?? window
    const options = { signal }
    view.addEventListener('keydown', event => this.press(event), options)
    view.addEventListener('keyup', event => this.letGo(event.code), options)
    view.addEventListener('blur', () => this.release(), options)
    page.addEventListener('visibilitychange', () => this.release(), options)
    // Else keys go to what was used last: a control of Storybook's panel, in a page around this one.
    canvas.addEventListener('pointerenter', () => view.focus(), options)
    canvas.addEventListener('pointerdown', event => this.touch(event), options)
    canvas.addEventListener('pointermove', event => this.drag(event), options)
    for (const end of ['pointerup', 'pointercancel', 'lostpointercapture'] as const) {
      canvas.addEventListener(end, event => this.fingers.delete(event.pointerId), options)
    }
    canvas.addEventListener('wheel', event => this.roll(event), { signal, passive: false })
  }

  /** True while Shift is held. */
  get isFast(): boolean {
    return this.keys.has('ShiftLeft') || this.keys.has('ShiftRight')
  }

  /** True while Space is held. */
  get isJumping(): boolean {
    return this.keys.has('Space')
  }

  /** Wish to move: right, up and forward, of length 1 at most. */
  move(target: Vector3): Vector3 {
    target.set(0, 0, 0)
    for (const key of this.keys) {
      const [x, y, z] = DIRECTIONS[key] ?? [0, 0, 0]
      target.set(target.x + x, target.y + y, target.z + z)
    }
    if (this.fingers.size === 2) {
      for (const { start, at } of this.fingers.values()) {
        target.x += (at.x - start.x) / (2 * TOUCH_RADIUS)
        target.z -= (at.y - start.y) / (2 * TOUCH_RADIUS)
      }
    }
    return target.clampLength(0, 1)
  }

  /** Way of drags since it was last asked for: to the right and up, in heights of the canvas. */
  takeTurn(target: Vector2): Vector2 {
    target.copy(this.turned)
    this.turned.set(0, 0)
    return target
  }

  /** True if F was pressed since it was last asked for. */
  takeToggle(): boolean {
    const toggled = this.isToggled
    this.isToggled = false
    return toggled
  }

  /** Holds a key down, by its place on the keyboard. */
  hold(code: string, isRepeated = false): void {
    this.isUsed = true
    if (code === 'KeyF' && !isRepeated) this.isToggled = true
    if (USED.has(code)) this.keys.add(code)
  }

  /** Lets a key go. */
  letGo(code: string): void {
    this.keys.delete(code)
  }

  /** True if any key was pressed, the pointer pressed or the wheel turned since it was last asked for. */
  takeUse(): boolean {
    const used = this.isUsed
    this.isUsed = false
    return used
  }

  dispose(): void {
    this.listeners.abort()
    this.release()
  }

  private release(): void {
    this.keys.clear()
    this.fingers.clear()
  }

  private press(event: KeyboardEvent): void {
    const { code, target, repeat } = event
    if (event.ctrlKey || event.metaKey || event.altKey) return
    const element = target as Partial<Element> | null
    const ignored = code === 'Space' ? `${TYPED}, ${PRESSED}` : TYPED
    if (element?.closest?.(ignored)) return
    if (code === 'Space') event.preventDefault()
    this.hold(code, repeat)
  }

  private touch(event: PointerEvent): void {
    const { pointerId, clientX, clientY } = event
    this.isUsed = true
    if (isOthers(event)) return
    this.canvas.setPointerCapture(pointerId)
    const start = new Vector2(clientX, clientY)
    this.fingers.set(pointerId, { start, at: start.clone() })
    // Fingers move from where there are two of them.
    if (this.fingers.size === 2) for (const { start, at } of this.fingers.values()) start.copy(at)
  }

  private drag({ pointerId, pointerType, clientX, clientY }: PointerEvent): void {
    const finger = this.fingers.get(pointerId)
    if (finger === undefined) return
    if (this.fingers.size === 1) {
      // A mouse turns the head; a finger draws the picture along.
      const share = (pointerType === 'mouse' ? 1 : -1) / Math.max(this.canvas.clientHeight, 1)
      this.turned.x += (clientX - finger.at.x) * share
      this.turned.y -= (clientY - finger.at.y) * share
    }
    finger.at.set(clientX, clientY)
  }

  private roll(event: WheelEvent): void {
    this.isUsed = true
    if (isOthers(event)) return
    event.preventDefault()
    // Firefox may count in lines.
    const way = event.deltaY * (event.deltaMode === 1 ? 33 : 1)
    const speed = this.speed * 2 ** (-way / WHEEL_DOUBLING)
    this.speed = Math.min(Math.max(speed, LEAST_SPEED), MOST_SPEED)
  }
}

import { PerspectiveCamera } from 'three'
import { Explorer } from '../src/moving/Explorer'
import type { ExplorerOptions } from '../src/moving/Explorer'

/** An explorer on a canvas without a page, whose events tests make. */
export function explore(options: ExplorerOptions = {}, height = 2) {
  const page = new EventTarget()
  const ownerDocument = Object.assign(new EventTarget(), { defaultView: page })
  const canvas = Object.assign(new EventTarget(), {
    ownerDocument,
    style: {},
    clientHeight: 500,
    setPointerCapture() {}
  })
  const camera = new PerspectiveCamera(60)
  camera.position.set(0, height, 0)
  const explorer = new Explorer(camera, canvas as unknown as HTMLCanvasElement, options)
  const send = (to: EventTarget, type: string, values: object): Event => {
    const event = new Event(type, { cancelable: true })
    for (const [name, value] of Object.entries(values)) {
      Object.defineProperty(event, name, { value })
    }
    to.dispatchEvent(event)
    return event
  }
  const pointer = (type: string, pointerType: string, pointerId: number, x: number, y: number) =>
    send(canvas, type, { pointerType, pointerId, button: 0, clientX: x, clientY: y })
  return {
    camera,
    explorer,
    press: (code: string, target: object = page) => send(page, 'keydown', { code, target }),
    release: (code: string) => send(page, 'keyup', { code }),
    page: (type: string, values: object) => send(page, type, values),
    hide: () => send(page, 'blur', {}),
    wheel: (deltaY: number) => send(canvas, 'wheel', { deltaY, deltaMode: 0 }),
    roll: (values: object) => send(canvas, 'wheel', { deltaY: 300, deltaMode: 0, ...values }),
    pointer,
    /** A mouse's drag to the right by some pixels. */
    drag: (way: number, values: object): void => {
      const mouse = { pointerType: 'mouse', pointerId: 1, button: 0, clientY: 100 }
      send(canvas, 'pointerdown', { ...mouse, clientX: 100, ...values })
      pointer('pointermove', 'mouse', 1, 100 + way, 100)
      pointer('pointerup', 'mouse', 1, 100 + way, 100)
    },
    run: (seconds: number, step = 1 / 60): void => {
      for (let t = step / 2; t < seconds; t += step) explorer.update(step)
    }
  }
}

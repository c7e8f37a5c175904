import { coverWith } from './fade'
import type { Explorer } from './moving/Explorer'
import { formatState, parseState } from './moving/ExplorerState'
import { showHelp } from './moving/help'
import { addTouchButtons } from './moving/touchButtons'
import { keepInUrl } from './moving/urlState'
import type { CreateScene, RendererArgs, SceneHandle } from './scene'

declare global {
  interface Window {
    /** The scene of the story on show, for tests: `welkinScene.render()` and then `canvas.toDataURL()`. */
    welkinScene?: SceneHandle<never>
    /** Channel from the story's page to Storybook's, where there is one. */
    __STORYBOOK_ADDONS_CHANNEL__?: { emit(event: string, ...values: unknown[]): void }
  }
}

/** Names of what is on show: it stays while they do. */
interface Identity {
  key: string
  storyId: string
  /** Key of the arguments that take a new scene. */
  scene: string
}

interface Mounted extends Identity {
  element: HTMLElement
  update(args: object): void
  /** Picture on show, as an address; undefined before the first. */
  picture(): string | undefined
  dispose(): void
}

let mounted: Mounted | undefined

/** Keeps the view in the page's address; what it has when the page opens is the first story's. */
function keepView(explorer: Explorer, restores: boolean): () => void {
  const write = (text: string): void => {
    const state = parseState(text)
    if (state !== undefined) explorer.state = state
  }
  return keepInUrl('view', () => formatState(explorer.state), write, { restores })
}

const STYLE = `
  .welkin { position: fixed; inset: 0; background: #05070a; font: 13px/1.4 system-ui, sans-serif; color: #e8edf2 }
  .welkin canvas { display: block; width: 100%; height: 100%; outline: none }
  .welkin-note { position: absolute; left: 12px; bottom: 12px; padding: 6px 10px; border-radius: 6px;
    background: rgb(5 7 10 / 70%); pointer-events: none; transition: opacity .4s }
  .welkin-note progress { width: 140px; height: 6px; margin-right: 8px; accent-color: #8fc7ff }
  .welkin-help { position: absolute; right: 12px; bottom: 12px; padding: 6px 10px; border: 0; border-radius: 6px;
    background: rgb(5 7 10 / 70%); color: inherit; font: inherit; text-align: left; cursor: pointer }
  .welkin-help[hidden] { display: none }
  .welkin-touch { position: absolute; right: 12px; top: 50%; display: grid; gap: 8px; transform: translateY(-50%) }
  .welkin-touch[hidden] { display: none }
  .welkin-touch button { width: 56px; height: 44px; border: 0; border-radius: 6px; background: rgb(5 7 10 / 55%);
    color: inherit; font: inherit; touch-action: none; user-select: none }
  .welkin-code { position: absolute; left: 12px; top: 12px; max-width: calc(100% - 24px); border-radius: 6px;
    background: rgb(5 7 10 / 70%) }
  .welkin-code summary { padding: 6px 10px; cursor: pointer }
  .welkin-code pre { margin: 0; padding: 2px 12px 12px; overflow: auto; font: 12px/1.5 ui-monospace, monospace }
  .welkin-error { position: absolute; inset: 0; display: grid; place-items: center; padding: 10%; text-align: center;
    white-space: pre-line }
`

/**
 * Turns a scene into the render function of a story.
 *
 * The canvas fills the page; new arguments go to the running scene. With `frame` it draws once, when everything is
 * loaded, and sets `data-ready="true"` on the body.
 *
 * @param code - Code that a user writes for it: shown on request.
 * @param restartsWith - Key of the arguments that take a new scene when they change; it fades in over the old one's last picture.
 * @param setWith - Arguments that go with a new scene of the same story.
 */
export function mount<Args extends RendererArgs>(
  create: CreateScene<Args>,
  code: string,
  restartsWith: (args: Args) => string = () => '',
  setWith: (args: Args) => Partial<Args> = () => ({})
): (args: Args, context: { id: string }) => HTMLElement {
  return (args, { id }) => {
    const scene = restartsWith(args)
    const key = [id, args.forceWebGL, args.path, args.frame, scene].join(' ')
    if (mounted?.key === key && mounted.element.isConnected) {
      mounted.update(args)
    } else {
      const last = mounted
      const isSame = last?.storyId === id
      const before = isSame && !args.frame ? last.picture() : undefined
      const changes = isSame && last.scene !== scene ? setWith(args) : {}
      last?.dispose()
      const own = { key, storyId: id, scene }
      mounted = start(own, create, code, { ...args, ...changes }, last === undefined, before)
      if (Object.keys(changes).length > 0) showArgs(id, changes)
    }
    return mounted.element
  }
}

/** Has the controls of a story, and with them Storybook's address, show what its scene changed. */
function showArgs(storyId: string, updatedArgs: object): void {
  // Not by `storybook/preview-api`: tests show stories without Storybook.
  window.__STORYBOOK_ADDONS_CHANNEL__?.emit('updateStoryArgs', { storyId, updatedArgs })
}

function start<Args extends RendererArgs>(
  identity: Identity,
  create: CreateScene<Args>,
  code: string,
  args: Args,
  isFirst: boolean,
  before: string | undefined
): Mounted {
  delete document.body.dataset.ready
  const element = document.createElement('div')
  element.className = 'welkin'
  element.innerHTML = `<style>${STYLE}</style><canvas></canvas>
    <div class="welkin-note"><progress max="1"></progress><span>Loading</span></div>
    <button class="welkin-help" hidden></button>
    <div class="welkin-touch" hidden></div>
    <details class="welkin-code"><summary>Code</summary><pre></pre></details>`
  element.querySelector('pre')!.textContent = code
  element.querySelector<HTMLElement>('.welkin-code')!.hidden = args.frame
  const canvas = element.querySelector('canvas')!
  const note = element.querySelector<HTMLElement>('.welkin-note')!
  const fade = before === undefined ? undefined : coverWith(canvas, before)
  let latest = args
  let handle: SceneHandle<Args> | undefined
  let disposed = false
  let forgetView: (() => void) | undefined
  let endHelp: (() => void) | undefined

  const resize = (): void => {
    const { clientWidth, clientHeight } = element
    if (handle !== undefined && clientWidth > 0 && clientHeight > 0) {
      handle.resize(clientWidth, clientHeight, args.frame ? 1 : Math.min(devicePixelRatio, 2))
    }
  }
  const observer = new ResizeObserver(resize)

  const dispose = (): void => {
    if (!disposed) {
      disposed = true
      observer.disconnect()
      forgetView?.()
      endHelp?.()
      void handle?.renderer.setAnimationLoop(null)
      handle?.dispose()
      delete window.welkinScene
    }
  }

  const showProgress = (): void => {
    const progress = handle?.progress ?? 0
    note.style.opacity = progress < 1 ? '1' : '0'
    note.querySelector('progress')!.value = progress
  }

  const drawFrame = async (): Promise<void> => {
    delete document.body.dataset.ready
    await handle!.ready
    if (!disposed) {
      handle!.render()
      showProgress()
      document.body.dataset.ready = 'true'
    }
  }

  const run = async (): Promise<void> => {
    const created = await create(canvas, latest)
    if (disposed) {
      created.dispose()
      return
    }
    handle = created
    handle.onArgs = changes => showArgs(identity.storyId, changes)
    window.welkinScene = created as unknown as SceneHandle<never>
    if (latest !== args) handle.update(latest)
    const { explorer } = handle
    if (explorer !== undefined && !args.frame) {
      forgetView = keepView(explorer, isFirst)
      endHelp = showHelp(element.querySelector<HTMLElement>('.welkin-help')!, explorer)
      addTouchButtons(element.querySelector<HTMLElement>('.welkin-touch')!, canvas, explorer)
    }
    resize()
    observer.observe(element)
    if (args.frame) {
      await drawFrame()
      return
    }
    await handle.renderer.setAnimationLoop(() => {
      // Storybook takes the element away without notice when another page is shown.
      if (element.isConnected) {
        handle!.render()
        showProgress()
      } else {
        dispose()
      }
    })
    await handle.ready
    fade?.()
    document.body.dataset.ready = 'true'
  }

  run().catch((error: unknown) => {
    console.error(error)
    fade?.()
    const message = document.createElement('div')
    message.className = 'welkin-error'
    message.textContent = `This story could not start.\nIt needs a browser with WebGPU or WebGL 2.\n\n${String(error)}`
    element.append(message)
    note.remove()
    document.body.dataset.ready = 'error'
  })

  return {
    ...identity,
    element,
    update(next) {
      latest = next as Args
      if (handle !== undefined) {
        handle.update(latest)
        if (args.frame) {
          void drawFrame()
        }
      }
    },
    picture() {
      handle?.render()
      return handle && canvas.toDataURL('image/jpeg', 0.9)
    },
    dispose
  }
}

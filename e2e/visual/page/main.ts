import { modules } from 'virtual:modules'
import { ConsoleWatch } from '../../gpu/harness/console'
import type { Backend } from '../../harness/backend'
import { filterCoarsely } from '../../gpu/harness/filter-samples'
import { loadTexels } from '../../gpu/harness/kept-texels'
import { keepTables, reuseTables } from '../../gpu/harness/reuse-tables'
import { requestOffscreenFrames } from '../../harness/offscreenFrames'
import { freeResources, shareDevice } from '../../harness/shareDevice'
import { setShadowSize } from '../../gpu/harness/shadow-size'

/** Interface of a story's scene module, which Storybook and this page drive alike. */
interface SceneView {
  ready: Promise<void>
  resize: (width: number, height: number, pixelRatio: number) => void
  update: (args: object) => void
  render: () => void
  dispose: () => void
}

type CreateScene = (canvas: HTMLCanvasElement, args: object) => Promise<SceneView>

interface Story {
  args?: object
  tags?: string[]
}

export interface Shot {
  /** The frame as a data URL. */
  url: string
  messages: string[]
  milliseconds: number
}

export interface VisualPage {
  /** Stories with the tag `screenshot`, per file; those with `webgpu-only` are not taken on WebGL. */
  list: () => Promise<{ file: string; story: string; isWebGPUOnly: boolean }[]>
  /** All stories that are of a scene. */
  listAll: () => Promise<{ file: string; story: string }[]>
  /** @param type - Type of the picture; default PNG. */
  shoot: (file: string, story: string, backend: Backend, type?: string) => Promise<Shot>
}

declare global {
  interface Window {
    welkinVisual: VisualPage
  }
}

async function load(name: string): Promise<Record<string, unknown>> {
  const module = await modules[name]?.()
  if (typeof module !== 'object' || module === null) throw new Error(`no module ${name}`)
  return module as Record<string, unknown>
}

async function findCreate(file: string): Promise<CreateScene> {
  const module = await load(`${file}.scene`)
  const found = Object.entries(module).find(
    ([name, value]) => /^create[A-Z]?/.test(name) && typeof value === 'function'
  )
  if (found === undefined) throw new Error(`${file}.scene.ts exports no create function`)
  return found[1] as CreateScene
}

requestOffscreenFrames()
shareDevice()
reuseTables(true)
filterCoarsely(true)

window.welkinVisual = {
  async list() {
    const found: { file: string; story: string; isWebGPUOnly: boolean }[] = []
    for (const name of Object.keys(modules).filter(key => key.endsWith('.stories'))) {
      const { default: meta, ...stories } = await load(name)
      const inherited = (meta as Story).tags ?? []
      for (const [story, value] of Object.entries(stories)) {
        const tags = new Set([...inherited, ...((value as Story).tags ?? [])])
        if (tags.has('screenshot') && !tags.has('!screenshot')) {
          const isWebGPUOnly = tags.has('webgpu-only')
          found.push({ file: name.replace('.stories', ''), story, isWebGPUOnly })
        }
      }
    }
    return found
  },

  async listAll() {
    const files = Object.keys(modules).filter(key => key.endsWith('.stories'))
    const names = files.map(key => key.replace('.stories', ''))
    const ofScenes = names.filter(file => `${file}.scene` in modules)
    const found = ofScenes.map(async file => {
      const { default: _meta, ...stories } = await load(`${file}.stories`)
      return Object.keys(stories).map(story => ({ file, story }))
    })
    return (await Promise.all(found)).flat()
  },

  async shoot(file, story, backend, type = 'image/png') {
    await loadTexels()
    const create = await findCreate(file)
    setShadowSize('half')
    const stories = await load(`${file}.stories`)
    const args = {
      ...(stories.default as Story).args,
      ...(stories[story] as Story).args,
      forceWebGL: backend === 'webgl',
      frame: true
    }
    const canvas = document.createElement('canvas')
    // Hidden: the browser needs not draw it again.
    const style = { display: 'block', width: '100vw', height: '100vh', visibility: 'hidden' }
    Object.assign(canvas.style, style)
    document.body.append(canvas)
    const watch = new ConsoleWatch()
    // Other libraries may warn; three's warnings, and all errors, count.
    watch.allow(/^console warning: (?!THREE)/)
    const start = performance.now()
    const view = await create(canvas, args)
    view.resize(innerWidth, innerHeight, 1)
    await view.ready
    view.render()
    // In the task of the drawing: later, a WebGPU canvas reads as blank.
    const url = canvas.toDataURL(type, 0.7)
    const milliseconds = performance.now() - start
    await new Promise(resolve => setTimeout(resolve, 20))
    await keepTables()
    const messages = watch.stop()
    view.dispose()
    canvas.remove()
    await freeResources()
    return { url, messages, milliseconds }
  }
}

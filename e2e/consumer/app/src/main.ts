import { WebGPURenderer } from 'three/webgpu'

declare global {
  interface Window {
    /** Draws one frame and answers with it as a PNG data URL. */
    draw: () => string
  }
}

/** One file per package that the app tries; each exports `create`, which answers with what draws. */
const scenes: Record<string, () => Promise<{ create: CreateScene }>> = {
  geo: () => import('./geo'),
  atmosphere: () => import('./atmosphere')
}

export type CreateScene = (renderer: WebGPURenderer) => Promise<() => void> | (() => void)

const parameters = new URLSearchParams(location.search)
const renderer = new WebGPURenderer({ forceWebGL: parameters.has('webgl') })
renderer.setSize(320, 180)
document.body.append(renderer.domElement)
await renderer.init()

const load = scenes[parameters.get('scene') ?? '']
if (load === undefined) throw new Error('no such scene')
const { create } = await load()
const render = await create(renderer)

window.draw = () => {
  render()
  return renderer.domElement.toDataURL('image/png')
}

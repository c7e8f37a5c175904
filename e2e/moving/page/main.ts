import { Vector3 } from 'three'
import { modules } from 'virtual:modules'
import type { mount } from '../../../stories/src/mount'
import type { ExplorerState } from '../../../stories/src/moving/Explorer'
import { loadTexels } from '../../gpu/harness/kept-texels'
import { keepTables, reuseTables } from '../../gpu/harness/reuse-tables'

/** Frames over which a speed is measured. */
const FRAMES = 12

/** A story, as Storybook shows it. */
interface Story {
  args?: object
  render?: ReturnType<typeof mount>
}

export interface MovingPage {
  /** Shows a story; settles when it runs. */
  show: (file: string, story: string) => Promise<void>
  /** Keeps the tables of the story's air for pages that are opened next. */
  keepTables: () => Promise<void>
  /** Position and direction of the camera. */
  look: () => ExplorerState
  /** Speed of the camera, over some frames [m/s]. */
  speed: () => Promise<number>
  /** Flies to a view: where the camera is in each frame until it arrives. */
  flyTo: (position: readonly number[], seconds: number) => Promise<ExplorerState[]>
}

declare global {
  interface Window {
    welkinMoving: MovingPage
  }
}

// The page that a link opens takes the tables of the first.
reuseTables(true)

const show: MovingPage['show'] = async (file, story) => {
  const stories = (await modules[`${file}.stories`]?.()) as Record<string, Story>
  const { default: meta, [story]: shown } = stories
  await loadTexels()
  const { render } = meta
  if (render === undefined) throw new Error(`${file}.stories.ts must render`)
  const args = { ...meta.args, ...shown.args }
  document.body.replaceChildren(
    render(args as Parameters<typeof render>[0], { id: `${file}--${story}` })
  )
  while (document.body.dataset.ready === undefined) {
    await new Promise(resolve => setTimeout(resolve, 20))
  }
}

const look = (): ExplorerState => window.welkinScene!.explorer!.state

const nextFrame = async (): Promise<number> =>
  new Promise(resolve => requestAnimationFrame(resolve))

const speed: MovingPage['speed'] = async () => {
  let [way, time] = [0, 0]
  let [before, last] = [look(), await nextFrame()]
  for (let i = 0; i < FRAMES; i++) {
    const now = await nextFrame()
    const view = look()
    way += Math.hypot(view.x - before.x, view.y - before.y, view.z - before.z)
    // As the explorer counts it.
    time += Math.min((now - last) / 1000, 0.1)
    before = view
    last = now
  }
  return way / time
}

const flyTo: MovingPage['flyTo'] = async ([x, y, z], seconds) => {
  const { explorer } = window.welkinScene!
  const view = { position: new Vector3(x, y, z), direction: new Vector3(1, 0, 0) }
  const arrival = explorer!.flyTo(view, seconds)
  let isThere = false
  void arrival.then(() => (isThere = true))
  const views = [look()]
  while (!isThere) {
    await nextFrame()
    views.push(look())
  }
  return views
}

window.welkinMoving = { show, keepTables, look, speed, flyTo }

import { modules } from 'virtual:modules'
import type { mount } from '../../../stories/src/mount'
import type { ExplorerState } from '../../../stories/src/moving/Explorer'

/** A story, as Storybook shows it. */
interface Story {
  args?: object
  render?: ReturnType<typeof mount>
}

export interface MovingPage {
  /** Shows a story; settles when it runs. */
  show: (file: string, story: string) => Promise<void>
  /** Position and direction of the camera. */
  look: () => ExplorerState
}

declare global {
  interface Window {
    welkinMoving: MovingPage
  }
}

const show: MovingPage['show'] = async (file, story) => {
  const stories = (await modules[`${file}.stories`]?.()) as Record<string, Story>
  const { default: meta, [story]: shown } = stories
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

window.welkinMoving = {
  show,
  look: () => window.welkinScene!.explorer!.state
}

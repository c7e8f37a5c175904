import type { Meta, StoryObj } from '@storybook/html-vite'
import { mount } from './mount'
import { createRain } from './rain.scene'
import type { RainArgs } from './rain.scene'
import { VIEWS } from './rainViews'
import { choiceOf, rendererArgTypes } from './storyArgs'
import { storyCode } from './storyCode'

const code = storyCode(
  ['quickStart.ts', 'quick start'],
  ['air.ts', 'post effect'],
  ['rain.scene.ts', 'rain']
)

const { forceWebGL, frame } = rendererArgTypes

const meta: Meta<RainArgs> = {
  title: 'Rain and snow',
  render: mount(createRain, code),
  argTypes: {
    view: { name: 'View', ...choiceOf(VIEWS), description: 'Sets sun, rate and exposure, too' },
    sun: { name: 'Sun [°]', control: { type: 'range', min: 1, max: 60, step: 0.5 } },
    rate: {
      name: 'Rate [mm/h]',
      description: 'As water, in the mean where it falls',
      control: { type: 'range', min: 0, max: 100, step: 0.5 }
    },
    virgaDepth: {
      name: 'Virga [m]',
      description: 'Depth of fall in which rain evaporates; 0 for none',
      control: { type: 'range', min: 0, max: 3000, step: 50 }
    },
    freezingLevel: {
      name: 'Freezing level [m]',
      description: 'Snow falls above it, rain below',
      control: { type: 'range', min: 0, max: 5000, step: 100 }
    },
    exposure: { name: 'Exposure [stops]', control: { type: 'range', min: -4, max: 4, step: 0.25 } },
    forceWebGL,
    frame,
    path: { table: { disable: true } }
  },
  args: {
    view: 'shower',
    ...VIEWS.shower.args,
    forceWebGL: false,
    path: 'post',
    frame: false
  }
}

export default meta

type Story = StoryObj<RainArgs>

/** Curtains of rain under towers, where their columns are strongest; they slant as the wind grows with height. */
export const Shower: Story = {}

/** The sun behind one's back: both bows where a shaft is sunlit, dark between them, and none beside it. */
export const Bow: Story = {
  name: 'Bow in a shower',
  tags: ['screenshot', 'webgpu-only'],
  args: { view: 'bow', ...VIEWS.bow.args }
}

/** Snow that evaporates below altocumulus in a low sun: tails that curve away with the wind, of which the heaviest reach far down. */
export const Virga: Story = {
  args: { view: 'virga', ...VIEWS.virga.args }
}

/** Snow that falls slowly, and so trails far behind its clouds. */
export const SnowShower: Story = {
  name: 'Snow shower',
  args: { view: 'snow', ...VIEWS.snow.args }
}

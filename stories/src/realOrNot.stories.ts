import { cloudQualities } from '@welkin/clouds'
import type { Meta, StoryObj } from '@storybook/html-vite'
import { mount } from './mount'
import { createRealOrNot, VIEWS } from './realOrNot.scene'
import type { RealOrNotArgs } from './realOrNot.scene'
import { choiceOf, rendererArgTypes, timeArgTypes } from './storyArgs'
import { storyCode } from './storyCode'

const code = storyCode(
  ['quickStart.ts', 'quick start'],
  ['air.ts', 'post effect'],
  ['realOrNot.scene.ts', 'two skies']
)

const { forceWebGL, frame } = rendererArgTypes

const meta: Meta<RealOrNotArgs> = {
  title: 'Real or not',
  render: mount(createRealOrNot, code),
  argTypes: {
    split: {
      name: 'Simulated',
      description:
        'Share of the picture, from the left, that shows simulated clouds; the rest is `fairWeather`',
      control: { type: 'range', min: 0, max: 1, step: 0.01 }
    },
    view: {
      name: 'Camera',
      description: 'Where the camera goes; fly on from there with the mouse',
      ...choiceOf(VIEWS)
    },
    quality: { name: 'Quality', options: Object.keys(cloudQualities), control: 'inline-radio' },
    ...timeArgTypes,
    forceWebGL,
    frame,
    path: { table: { disable: true } }
  },
  args: {
    view: 'ground',
    split: 0.5,
    quality: 'high',
    day: Date.UTC(2026, 5, 21),
    hour: 15,
    exposure: 0,
    forceWebGL: false,
    path: 'post',
    frame: false
  }
}

export default meta

type Story = StoryObj<RealOrNotArgs>

/** Simulated cumulus on the left, procedural ones on the right. */
export const Ground: Story = { tags: ['screenshot', 'webgpu-only'] }

/** Simulated and procedural clouds, from among them. */
export const Among: Story = { args: { view: 'among' } }

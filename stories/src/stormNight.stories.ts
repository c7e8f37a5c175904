import type { Meta, StoryObj } from '@storybook/html-vite'
import { mount } from './mount'
import { createStorm, VIEWS } from './stormNight.scene'
import type { StormArgs } from './stormNight.scene'
import { choiceOf, rendererArgTypes } from './storyArgs'
import { storyCode } from './storyCode'

const code = storyCode(
  ['quickStart.ts', 'quick start'],
  ['air.ts', 'post effect'],
  ['stormNight.scene.ts', 'lightning']
)

const { forceWebGL, frame } = rendererArgTypes

const meta: Meta<StormArgs> = {
  title: 'Storm at night',
  render: mount(createStorm, code),
  argTypes: {
    view: { name: 'View', ...choiceOf(VIEWS) },
    flashes: {
      name: 'Flashes',
      control: 'boolean',
      description: 'Off at first: flashes may harm people with photosensitive epilepsy'
    },
    rate: {
      name: 'Rate [1/min]',
      description: 'Flashes within 20 km',
      control: { type: 'range', min: 0, max: 30, step: 1 }
    },
    gentle: {
      name: 'Gentle',
      control: 'boolean',
      description: 'At most three a second, of limited brightness, that fade slowly'
    },
    exposure: { name: 'Exposure [stops]', control: { type: 'range', min: 0, max: 20, step: 0.5 } },
    forceWebGL,
    frame,
    path: { table: { disable: true } }
  },
  args: {
    view: 'ground',
    flashes: false,
    rate: 6,
    gentle: true,
    exposure: 13,
    forceWebGL: false,
    path: 'post',
    frame: false
  }
}

export default meta

type Story = StoryObj<StormArgs>

/** A storm over the sea; switch the flashes on. As a single frame, one to the ground. */
export const Ground: Story = { name: 'From the ground', tags: ['screenshot', 'webgpu-only'] }

/** Beside the towers, which are lit from inside. */
export const Aeroplane: Story = { name: 'From an aeroplane', args: { view: 'aeroplane' } }

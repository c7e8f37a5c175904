import type { Meta, StoryObj } from '@storybook/html-vite'
import { createFogValley, VIEWS } from './fogValley.scene'
import type { FogValleyArgs } from './fogValley.scene'
import { mount } from './mount'
import { choiceOf, rendererArgTypes, timeArgTypes } from './storyArgs'
import { storyCode } from './storyCode'

const code = storyCode(['quickStart.ts', 'quick start'], ['fogValley.scene.ts', 'fog'])

const meta: Meta<FogValleyArgs> = {
  title: 'Fog valley',
  render: mount(createFogValley, code),
  argTypes: {
    view: {
      name: 'Camera',
      description: 'Where the camera goes; fly on from there with the mouse',
      ...choiceOf(VIEWS)
    },
    density: {
      name: 'Density [1/km]',
      control: { type: 'range', min: 0, max: 50, step: 0.1 },
      description: 'Extinction of the mist at its base'
    },
    falloff: {
      name: 'Falloff [m]',
      control: { type: 'range', min: 5, max: 500, step: 1 },
      description: 'Altitude over which it falls to 1/e'
    },
    base: { name: 'Base [m]', control: { type: 'range', min: 0, max: 1000, step: 5 } },
    distance: {
      name: 'Distance fog [1/km]',
      control: { type: 'range', min: 0, max: 1, step: 0.01 },
      description: 'exp(−(density × distance)²)'
    },
    ...timeArgTypes,
    ...rendererArgTypes
  },
  args: {
    view: 'ridge',
    density: 6,
    falloff: 40,
    base: 300,
    distance: 0,
    day: Date.UTC(2026, 9, 5),
    hour: 11.95,
    exposure: 1.5,
    forceWebGL: false,
    path: 'forward',
    frame: false
  }
}

export default meta

type Story = StoryObj<FogValleyArgs>

/** The sun is 4° up, and shines through the mist. */
export const Sunrise: Story = { tags: ['screenshot', 'webgpu-only'] }

/** Inside the mist. */
export const Inside: Story = {
  args: { view: 'floor', base: 342, density: 8, falloff: 25, hour: 12.5 }
}

/** Valley by the post effect. */
export const Post: Story = { args: { path: 'post' } }

/** Ridges that stand out of the fog. */
export const FromAbove: Story = { args: { view: 'high', hour: 14, exposure: 0 } }

/** Fog by distance alone, in the colour of the sky behind. */
export const Distance: Story = {
  args: { view: 'ridge', density: 0, distance: 0.12, hour: 15, exposure: 0 }
}

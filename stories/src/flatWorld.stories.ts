import type { Meta, StoryObj } from '@storybook/html-vite'
import { createFlatWorld } from './flatWorld.scene'
import type { FlatWorldArgs } from './flatWorld.scene'
import { mount } from './mount'
import { rendererArgTypes, timeArgTypes } from './storyArgs'
import { storyCode } from './storyCode'

const meta: Meta<FlatWorldArgs> = {
  title: 'Flat world',
  render: mount(createFlatWorld, storyCode(['flatWorld.scene.ts', 'flat world'])),
  argTypes: {
    seaLevel: {
      name: 'Level of lakes [m]',
      control: { type: 'range', min: -150, max: 100, step: 1 }
    },
    ...timeArgTypes,
    ...rendererArgTypes
  },
  args: {
    seaLevel: -10,
    day: Date.UTC(2026, 5, 21),
    hour: 14,
    exposure: 0,
    forceWebGL: false,
    path: 'forward',
    frame: false
  }
}

export default meta

type Story = StoryObj<FlatWorldArgs>

/** Blocks on hills by a lake, on a plane: no planet, no longitudes. */
export const Hills: Story = { tags: ['screenshot', 'webgpu-only'] }

import type { Meta, StoryObj } from '@storybook/html-vite'
import { mount } from './mount'
import { createMountainShadows } from './mountainShadows.scene'
import type { MountainShadowsArgs } from './mountainShadows.scene'
import { rendererArgTypes, shaftArgTypes } from './storyArgs'
import { storyCode } from './storyCode'

const code = storyCode(['air.ts', 'post effect'], ['mountainShadows.scene.ts', 'mountain shadows'])

const { forceWebGL, frame } = rendererArgTypes
const { strength, turbidity, azimuth, exposure } = shaftArgTypes

const meta: Meta<MountainShadowsArgs> = {
  title: 'Mountain shadows',
  render: mount(createMountainShadows, code),
  argTypes: {
    strength,
    turbidity,
    elevation: {
      name: 'Elevation [°]',
      control: { type: 'range', min: -2, max: 30, step: 0.25 },
      description: 'Of the sun'
    },
    azimuth,
    exposure,
    forceWebGL,
    frame,
    path: { table: { disable: true } }
  },
  args: {
    strength: 1,
    turbidity: 5,
    elevation: 4,
    azimuth: 57,
    exposure: -1.75,
    forceWebGL: false,
    path: 'post',
    frame: false
  }
}

export default meta

type Story = StoryObj<MountainShadowsArgs>

/** A ridge 30 km away before the rising sun. */
export const Sunrise: Story = { tags: ['screenshot', 'webgpu-only'] }

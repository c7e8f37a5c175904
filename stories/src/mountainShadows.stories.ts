import type { Meta, StoryObj } from '@storybook/html-vite'
import { mount } from './mount'
import { createMountainShadows } from './mountainShadows.scene'
import type { MountainShadowsArgs } from './mountainShadows.scene'
import { rendererArgTypes } from './storyArgs'
import { storyCode } from './storyCode'

const code = `${storyCode('air.ts', 'post effect')}

${storyCode('mountainShadows.scene.ts', 'mountain shadows')}`

const { forceWebGL, frame } = rendererArgTypes

const meta: Meta<MountainShadowsArgs> = {
  title: 'Mountain shadows',
  render: mount(createMountainShadows, code),
  argTypes: {
    strength: {
      name: 'Strength',
      control: { type: 'range', min: 0, max: 3, step: 0.05 },
      description: 'Part of the light that shadowed air loses: 1 is physical, 0 has no shafts'
    },
    turbidity: {
      name: 'Haze',
      control: { type: 'range', min: 1, max: 12, step: 0.25 },
      description: 'Turbidity of the air: 1 is clear, 6 thick haze'
    },
    elevation: {
      name: 'Elevation [°]',
      control: { type: 'range', min: -2, max: 30, step: 0.25 },
      description: 'Of the sun'
    },
    azimuth: {
      name: 'Azimuth [°]',
      control: { type: 'range', min: 0, max: 360, step: 1 },
      description: 'Clockwise from north'
    },
    exposure: {
      name: 'Exposure [stops]',
      control: { type: 'range', min: -4, max: 4, step: 0.25 },
      description: '0 as exposureFor says'
    },
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
export const Sunrise: Story = { tags: ['screenshot'] }

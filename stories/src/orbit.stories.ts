import type { Meta, StoryObj } from '@storybook/html-vite'
import { mount } from './mount'
import { createOrbit } from './orbit.scene'
import type { OrbitArgs } from './orbit.scene'
import { rendererArgTypes } from './storyArgs'
import { storyCode } from './storyCode'

const code = storyCode(['orbit.scene.ts', 'orbit'], ['orbit.scene.ts', 'orbit exposure'])

const meta: Meta<OrbitArgs> = {
  title: 'Low Earth orbit',
  render: mount(createOrbit, code),
  argTypes: {
    altitude: {
      name: 'Altitude [km]',
      control: { type: 'range', min: 60, max: 2000, step: 10 },
      description: 'Above the ellipsoid'
    },
    angle: {
      name: 'Along the orbit [°]',
      control: { type: 'range', min: 0, max: 360, step: 0.5 },
      description: '0 where the sun is overhead, 180 at midnight'
    },
    fieldOfView: {
      name: 'Field of view [°]',
      control: { type: 'range', min: 2, max: 100, step: 1 },
      description: 'Vertical'
    },
    exposure: {
      name: 'Exposure [stops]',
      control: { type: 'range', min: -8, max: 8, step: 0.25 },
      description: '0 as exposureFor says'
    },
    ...rendererArgTypes,
    path: { table: { disable: true } }
  },
  args: {
    altitude: 410,
    angle: 190,
    fieldOfView: 50,
    exposure: -1.5,
    forceWebGL: false,
    path: 'forward',
    frame: false
  }
}

export default meta

type Story = StoryObj<OrbitArgs>

/** Airglow over the limb, past midnight. */
export const Night: Story = { tags: ['screenshot', 'webgpu-only'] }

/** The sun is about to rise ahead. */
export const Dawn: Story = {
  args: { angle: 248, exposure: -9.5, fieldOfView: 30 }
}

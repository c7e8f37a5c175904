import type { Meta, StoryObj } from '@storybook/html-vite'
import { mount } from './mount'
import { createPlain } from './plain.scene'
import type { PlainArgs } from './plain.scene'
import { rendererArgTypes, timeArgTypes } from './storyArgs'
import { storyCode } from './storyCode'

const meta: Meta<PlainArgs> = {
  title: 'Plain scene',
  render: mount(createPlain, storyCode(['quickStart.ts', 'quick start'])),
  argTypes: {
    longitude: {
      name: 'Longitude [°]',
      control: { type: 'range', min: -180, max: 180, step: 0.01 }
    },
    latitude: { name: 'Latitude [°]', control: { type: 'range', min: -90, max: 90, step: 0.01 } },
    height: {
      name: 'Height [m]',
      control: { type: 'range', min: 0, max: 30_000, step: 10 },
      description: 'Of the ground, above the ellipsoid'
    },
    ...timeArgTypes,
    ...rendererArgTypes
  },
  args: {
    longitude: 139.77,
    latitude: 35.68,
    height: 0,
    day: Date.UTC(2026, 5, 21),
    hour: 7,
    exposure: 0,
    forceWebGL: false,
    path: 'forward',
    frame: false
  }
}

export default meta

type Story = StoryObj<PlainArgs>

/** Four in the afternoon in Tokyo. */
export const Afternoon: Story = { tags: ['screenshot'] }

/** A quarter of an hour before sunset. */
export const Sunset: Story = {
  args: { hour: 9.75, exposure: 2 },
  tags: ['screenshot', 'webgpu-only']
}

/** Civil twilight, the sun 5° down: the sky over it is a hundred times as bright as the ground. */
export const Dusk: Story = {
  args: { hour: 10.4, exposure: 8 },
  tags: ['screenshot', 'webgpu-only']
}

/** The air over the finished picture, as a post effect. */
export const Post: Story = { args: { path: 'post' }, tags: ['screenshot', 'webgpu-only'] }

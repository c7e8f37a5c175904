import type { Meta, StoryObj } from '@storybook/html-vite'
import { createEclipse } from './eclipse.scene'
import { sceneKey, type MoonArgs } from './moon.scene'
import moonMeta from './moon.stories'
import { mount } from './mount'
import { storyCode } from './storyCode'

const code = storyCode(['quickStart.ts', 'quick start'], ['moon.scene.ts', 'moon'])

const meta: Meta<MoonArgs> = {
  title: 'Eclipse',
  render: mount(createEclipse, code, sceneKey),
  argTypes: moonMeta.argTypes,
  args: {
    ...moonMeta.args,
    longitude: -96.797,
    latitude: 32.777,
    day: Date.UTC(2024, 3, 8),
    hour: 18.71,
    target: 'sun',
    fieldOfView: 2.5,
    exposure: 1
  }
}

export default meta

type Story = StoryObj<MoonArgs>

/** Dallas, 8 April 2024, 18:42:38 UTC: the corona. */
export const Totality: Story = { tags: ['screenshot'] }

/** Ten seconds before totality. */
export const DiamondRing: Story = {
  args: { hour: 18.675, exposure: 1 },
  tags: ['screenshot', 'webgpu-only']
}

/** Half an hour before, through a dark filter. */
export const Partial: Story = {
  args: { hour: 18.2, fieldOfView: 1, exposure: -16 }
}

/** The land a minute before totality: a hundredth of the sun lights it, as it still stands high. */
export const LastLight: Story = {
  args: { hour: 18.66, fieldOfView: 60, lower: 60, exposure: 5, lights: 'sun' }
}

import type { Meta, StoryObj } from '@storybook/html-vite'
import { createDay } from './day.scene'
import type { DayArgs } from './day.scene'
import { mount } from './mount'
import { rendererArgTypes } from './storyArgs'
import { storyCode } from './storyCode'

const code = storyCode(
  ['quickStart.ts', 'quick start'],
  ['day.scene.ts', 'day'],
  ['day.scene.ts', 'cycle'],
  ['day.scene.ts', 'each frame']
)

const meta: Meta<DayArgs> = {
  title: '24 hours',
  render: mount(createDay, code),
  argTypes: {
    latitude: { name: 'Latitude [°]', control: { type: 'range', min: -90, max: 90, step: 1 } },
    season: {
      name: 'Season [part of a year]',
      control: { type: 'range', min: 0, max: 0.99, step: 0.01 },
      description:
        '0 the equinox of March 2026, 0.25 the solstice of June; the moon is as of the date'
    },
    hour: {
      name: 'Hour [h]',
      control: { type: 'range', min: 0, max: 23.9, step: 0.1 },
      description: 'Solar time; the clock goes on from here'
    },
    dayLength: {
      name: 'A day takes [s]',
      control: { type: 'range', min: 10, max: 3600, step: 10 },
      description: 'On the clock'
    },
    daylight: {
      name: 'Part of it by day',
      control: { type: 'range', min: 0.1, max: 0.9, step: 0.05 },
      description: '0.5 is real; more makes days long and nights short'
    },
    paused: { name: 'Paused', control: 'boolean' },
    ...rendererArgTypes
  },
  args: {
    latitude: 35,
    season: 0.2,
    hour: 16,
    dayLength: 60,
    daylight: 0.5,
    paused: false,
    forceWebGL: false,
    path: 'forward',
    frame: false
  }
}

export default meta

type Story = StoryObj<DayArgs>

/** A day and a night in a minute. */
export const Minute: Story = { name: 'In a minute' }

/** Half an hour after sunset. */
export const Dusk: Story = {
  args: { hour: 19.4, paused: true }
}

/** The moon, full the day before, has risen. */
export const Moonrise: Story = {
  args: { hour: 21, paused: true },
  tags: ['screenshot', 'webgpu-only']
}

/** A fortnight later there is no moon. */
export const Night: Story = {
  args: { season: 0.237, hour: 1, paused: true }
}

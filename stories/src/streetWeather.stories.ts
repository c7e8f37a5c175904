import type { Meta, StoryObj } from '@storybook/html-vite'
import { mount } from './mount'
import { rendererArgTypes } from './storyArgs'
import { storyCode } from './storyCode'
import { createStreet } from './streetWeather.scene'
import type { StreetArgs } from './streetWeather.scene'

const code = storyCode(
  ['quickStart.ts', 'quick start'],
  ['air.ts', 'post effect'],
  ['street/Street.ts', 'wet ground'],
  ['street/Street.ts', 'rain and snow']
)

const { forceWebGL, frame } = rendererArgTypes

const meta: Meta<StreetArgs> = {
  title: 'Rain and snow in a street',
  render: mount(createStreet, code),
  argTypes: {
    rain: { name: 'Rain [mm/h]', control: { type: 'range', min: 0, max: 100, step: 0.5 } },
    snow: {
      name: 'Snow [mm/h]',
      description: 'As water',
      control: { type: 'range', min: 0, max: 5, step: 0.1 }
    },
    wind: { name: 'Wind [m/s]', control: { type: 'range', min: 0, max: 15, step: 0.5 } },
    elevation: { name: 'Sun [°]', control: { type: 'range', min: -25, max: 60, step: 1 } },
    shutter: {
      name: 'Shutter [s]',
      description: 'Streaks are as long as it is open',
      control: { type: 'range', min: 0.001, max: 0.04, step: 0.001 }
    },
    forceWebGL,
    frame,
    path: { table: { disable: true } }
  },
  args: {
    rain: 0,
    snow: 2.5,
    wind: 1,
    elevation: -25,
    shutter: 1 / 60,
    forceWebGL: false,
    path: 'post',
    frame: false
  }
}

export default meta

type Story = StoryObj<StreetArgs>

/** Snow at night, in the light of four lamps. */
export const Snowfall: Story = { tags: ['screenshot', 'webgpu-only'] }

/** A shower by day: streaks against the walls, puddles with rings. */
export const Rain: Story = {
  args: { rain: 25, snow: 0, wind: 3, elevation: 25, shutter: 1 / 120 }
}

/** Rain at night: bright below the lamps, whose light the wet street mirrors. */
export const RainAtNight: Story = {
  name: 'Rain at night',
  args: { rain: 12, snow: 0, wind: 2 }
}

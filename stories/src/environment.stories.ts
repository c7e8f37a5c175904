import type { Meta, StoryObj } from '@storybook/html-vite'
import { createEnvironment } from './environment.scene'
import type { EnvironmentArgs } from './environment.scene'
import { mount } from './mount'
import { rendererArgTypes } from './storyArgs'
import { storyCode } from './storyCode'

const code = storyCode(['quickStart.ts', 'quick start'], ['environment.scene.ts', 'environment'])

const meta: Meta<EnvironmentArgs> = {
  title: 'Environment',
  render: mount(createEnvironment, code),
  argTypes: {
    elevation: {
      name: "Sun's elevation [°]",
      control: { type: 'range', min: -12, max: 90, step: 0.1 }
    },
    azimuth: {
      name: "Sun's azimuth [°]",
      control: { type: 'range', min: 0, max: 360, step: 1 },
      description: 'Clockwise from north; the camera looks north'
    },
    ripples: {
      name: 'Ripples [10⁻³]',
      control: { type: 'range', min: 0, max: 20, step: 0.1 },
      description: 'Mean square slope of the water'
    },
    exposure: {
      name: 'Exposure [stops]',
      control: { type: 'range', min: -4, max: 20, step: 0.25 },
      description: '0 suits daylight; one more is twice as bright'
    },
    ...rendererArgTypes
  },
  args: {
    elevation: 32,
    azimuth: 250,
    ripples: 1,
    exposure: 0,
    forceWebGL: false,
    path: 'forward',
    frame: false
  }
}

export default meta

type Story = StoryObj<EnvironmentArgs>

/** Metals from polished to matt, paint, gold, glass and water. */
export const Day: Story = {}

/** The sun stands low ahead: its glow in the sky, in the water and in the metals. */
export const Sunset: Story = {
  args: { elevation: 3, azimuth: 25, ripples: 2, exposure: 1.5 },
  tags: ['screenshot', 'webgpu-only']
}

/** Still water: at the horizon sea and sky are of one colour. */
export const Mirror: Story = { args: { ripples: 0, elevation: 15, azimuth: 120 } }

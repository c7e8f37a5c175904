import type { Meta, StoryObj } from '@storybook/html-vite'
import { mount } from './mount'
import { createShell } from './shell.scene'
import type { ShellArgs } from './shell.scene'
import { rendererArgTypes } from './storyArgs'
import { storyCode } from './storyCode'

const meta: Meta<ShellArgs> = {
  title: 'Shell',
  render: mount(createShell, storyCode(['shell.scene.ts', 'shell']), ({ model }) => model),
  argTypes: {
    view: { name: 'View', table: { disable: true } },
    model: {
      name: 'Model',
      description: 'From tables, or a short march without any: a new scene, which fades in',
      options: ['tables', 'single-scattering'],
      control: 'inline-radio'
    },
    sun: {
      name: 'Sun [°]',
      description: "Above the cockpit's horizon, or around the map",
      control: { type: 'range', min: -180, max: 180, step: 1 }
    },
    height: {
      name: 'Height [m]',
      description: 'Of the cockpit above the ground',
      control: { type: 'range', min: 100, max: 400_000, step: 100 }
    },
    descent: {
      name: 'Descent',
      description: 'Part of the way from the map to the ground, from where it goes on',
      control: { type: 'range', min: 0, max: 0.99, step: 0.01 }
    },
    exposure: {
      name: 'Exposure [stops]',
      description: 'One more is twice as bright',
      control: { type: 'range', min: -4, max: 10, step: 0.25 }
    },
    ...rendererArgTypes,
    path: { table: { disable: true } }
  },
  args: {
    view: 'map',
    model: 'tables',
    sun: 60,
    height: 11_000,
    descent: 0,
    exposure: -1,
    forceWebGL: false,
    path: 'forward',
    frame: false
  }
}

export default meta

type Story = StoryObj<ShellArgs>

/** Three bodies with air and one without. */
export const Map: Story = {}

/** Inside the air: the cockpit is clear, the ground is in haze. */
export const Cockpit: Story = {
  args: { view: 'cockpit', sun: 12 },
  tags: ['screenshot', 'webgpu-only']
}

export const CockpitInSpace: Story = {
  args: { view: 'cockpit', sun: 20, height: 300_000 }
}

/** One take from the map into the cockpit and down to the ground; any key, press or wheel takes over. */
export const Descent: Story = {
  args: { view: 'descent', sun: 35 }
}

export const SingleScattering: Story = {
  args: { model: 'single-scattering' },
  tags: ['screenshot']
}

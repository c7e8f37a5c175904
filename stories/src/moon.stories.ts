import type { Meta, StoryObj } from '@storybook/html-vite'
import { createMoon, sceneKey } from './moon.scene'
import type { MoonArgs } from './moon.scene'
import { mount } from './mount'
import { rendererArgTypes, timeArgTypes } from './storyArgs'
import { storyCode } from './storyCode'

const code = storyCode(['quickStart.ts', 'quick start'], ['moon.scene.ts', 'moon'])

const meta: Meta<MoonArgs> = {
  title: 'Moon phases',
  render: mount(createMoon, code, sceneKey),
  argTypes: {
    longitude: {
      name: 'Longitude [°]',
      control: { type: 'range', min: -180, max: 180, step: 0.01 }
    },
    latitude: { name: 'Latitude [°]', control: { type: 'range', min: -90, max: 90, step: 0.01 } },
    ...timeArgTypes,
    exposure: {
      name: 'Exposure [stops]',
      control: { type: 'range', min: -16, max: 20, step: 0.25 },
      description: '0 suits daylight; one more is twice as bright'
    },
    setPhase: { name: 'Set the phase', control: 'boolean', description: 'Not that of the date' },
    phase: {
      name: 'Phase',
      control: { type: 'range', min: 0, max: 1, step: 0.01 },
      description: '0 new, 0.25 first quarter, 0.5 full, 0.75 last quarter'
    },
    target: { name: 'Look at', options: ['moon', 'sun'], control: 'inline-radio' },
    lower: {
      name: 'Look below it by [°]',
      control: { type: 'range', min: -30, max: 60, step: 1 }
    },
    fieldOfView: {
      name: 'Field of view [°]',
      control: { type: 'range', min: 0.3, max: 90, step: 0.1 }
    },
    lights: {
      name: 'Land lit by',
      options: ['none', 'sun', 'moon', 'both'],
      control: 'select',
      description: 'None leaves the sky alone; another choice takes a new scene, which fades in'
    },
    mapSize: {
      name: 'Map of its ground [texels]',
      options: [256, 512, 1024, 2048],
      control: 'select',
      description: 'Another one takes a new scene, which fades in'
    },
    ...rendererArgTypes
  },
  args: {
    longitude: 10,
    latitude: 45,
    day: Date.UTC(2026, 4, 23),
    hour: 20.5,
    setPhase: false,
    phase: 0.5,
    target: 'moon',
    lower: 0,
    fieldOfView: 0.65,
    exposure: 1.5,
    lights: 'none',
    mapSize: 1024,
    forceWebGL: false,
    path: 'forward',
    frame: false
  }
}

export default meta

type Story = StoryObj<MoonArgs>

/** The first quarter of May 2026 in a telescope, libration and tilt as they were. */
export const FirstQuarter: Story = {
  args: { exposure: 2.5 }
}

/** Full, 5 days later: flat, without a dark limb. */
export const Full: Story = {
  args: { day: Date.UTC(2026, 4, 31), hour: 23, exposure: 1 },
  tags: ['screenshot', 'webgpu-only']
}

/** Three days old: the dark part is lit by the Earth. */
export const Earthshine: Story = {
  args: { day: Date.UTC(2026, 4, 19), hour: 20.25, exposure: 9.5 },
  tags: ['screenshot', 'webgpu-only']
}

/** A night of full moon: sky, haze and shadows by its light alone. */
export const MoonlitNight: Story = {
  args: {
    day: Date.UTC(2026, 4, 2),
    hour: 22.5,
    fieldOfView: 50,
    lower: 12,
    exposure: 17,
    lights: 'moon'
  },
  tags: ['screenshot']
}

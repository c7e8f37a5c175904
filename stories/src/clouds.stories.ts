import { cloudQualities } from '@welkin/clouds'
import type { Meta, StoryObj } from '@storybook/html-vite'
import { createClouds } from './clouds.scene'
import type { CloudsArgs } from './clouds.scene'
import { mount } from './mount'
import { rendererArgTypes, timeArgTypes } from './storyArgs'
import { storyCode } from './storyCode'

const { forceWebGL, frame } = rendererArgTypes

const meta: Meta<CloudsArgs> = {
  title: 'Clouds',
  render: mount(createClouds, storyCode('clouds.scene.ts', 'clouds')),
  argTypes: {
    preset: {
      name: 'Clouds',
      options: ['fairWeather', 'stratocumulus', 'overcast', 'cumulonimbus', 'cirrus', 'mixed'],
      control: 'select'
    },
    coverage: {
      name: 'Coverage',
      control: { type: 'range', min: -1, max: 1, step: 0.01 },
      description: 'Of the lowest layer; below 0 the preset’s'
    },
    quality: { name: 'Quality', options: Object.keys(cloudQualities), control: 'inline-radio' },
    debug: {
      name: 'Show',
      options: ['off', 'opacity', 'steps', 'distance', 'history'],
      control: 'select'
    },
    altitude: {
      name: 'Altitude [m]',
      control: { type: 'number', min: 0, max: 1e8 },
      description: 'Of the camera, above the ellipsoid'
    },
    heading: { name: 'Heading [°]', control: { type: 'range', min: 0, max: 360, step: 1 } },
    pitch: { name: 'Pitch [°]', control: { type: 'range', min: -90, max: 90, step: 1 } },
    longitude: {
      name: 'Longitude [°]',
      control: { type: 'range', min: -180, max: 180, step: 0.01 }
    },
    latitude: { name: 'Latitude [°]', control: { type: 'range', min: -90, max: 90, step: 0.01 } },
    ...timeArgTypes,
    forceWebGL,
    path: { table: { disable: true } },
    frame
  },
  args: {
    preset: 'fairWeather',
    coverage: -1,
    quality: 'medium',
    debug: 'off',
    altitude: 2,
    heading: 60,
    pitch: 14,
    longitude: 20,
    latitude: 45,
    day: Date.UTC(2026, 5, 21),
    hour: 7,
    exposure: 0,
    forceWebGL: false,
    path: 'post',
    frame: false
  }
}

export default meta

type Story = StoryObj<CloudsArgs>

/** Fair-weather cumulus from the ground. */
export const Cumulus: Story = {}

/** Above a deck of stratocumulus. */
export const Cockpit: Story = {
  args: { preset: 'stratocumulus', altitude: 3000, pitch: -6 }
}

/** Towers among small cumulus. */
export const Storm: Story = { args: { preset: 'cumulonimbus', heading: 300 } }

/** The camera among cumulus. */
export const InsideACloud: Story = { args: { altitude: 1500, pitch: 0 } }

/** From 400 km. */
export const Orbit: Story = { args: { altitude: 400_000, pitch: -50 } }

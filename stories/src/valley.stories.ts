import { cloudQualities } from '@welkin/clouds'
import type { Meta, StoryObj } from '@storybook/html-vite'
import { mount } from './mount'
import { choiceOf, effect, effectArgTypes, rendererArgTypes } from './storyArgs'
import { storyCode } from './storyCode'
import { createValley } from './valley.scene'
import type { ValleyArgs } from './valley.scene'
import { openingState } from './valley/openingState'
import { VIEWS } from './valley/views'
import { weathers } from './valley/weather'

const code = storyCode(
  ['valleyAir.ts', 'sky and light'],
  ['valleyAir.ts', 'everything'],
  ['valley/flashes.ts', 'lightning'],
  ['valleyFactors.ts', 'factors']
)

const part = (name: string): object => ({ name, control: 'boolean', table: { category: 'Parts' } })

/** Slider of an artistic factor. */
const factor = (name: string, description: string): object => ({
  name,
  description,
  control: { type: 'range', min: 0, max: 3, step: 0.05 },
  table: { category: 'Artistic factors' }
})

const meta: Meta<ValleyArgs> = {
  title: 'Valley, all day',
  render: mount(createValley, code),
  argTypes: {
    view: {
      name: 'Place',
      ...choiceOf(VIEWS)
    },
    weather: {
      name: 'Weather',
      control: 'select',
      options: Object.keys(weathers),
      description: 'One becomes another in ten seconds'
    },
    hour: {
      name: 'Hour [h]',
      control: { type: 'range', min: 0, max: 23.9, step: 0.1 },
      description: 'Solar time; the clock goes on from here'
    },
    dayLength: {
      name: 'A day takes [s]',
      control: { type: 'range', min: 30, max: 7200, step: 10 },
      description: 'On the clock'
    },
    paused: { name: 'Paused', control: 'boolean' },
    date: {
      name: 'Date [UTC]',
      control: 'date',
      description: 'Sun, moon and stars are as of this day; its time is the hour above'
    },
    latitude: { name: 'Latitude [°]', control: { type: 'range', min: -66, max: 66, step: 1 } },
    longitude: {
      name: 'Longitude [°]',
      control: { type: 'range', min: -180, max: 180, step: 1 },
      description: 'The hour is solar time, and stays'
    },
    quality: { name: 'Quality', control: 'select', options: Object.keys(cloudQualities) },
    clouds: part('Clouds'),
    cloudShadows: part("Clouds' shadows"),
    shadows: part('Shadows of things'),
    shafts: part('Light shafts'),
    haze: part('Haze'),
    mist: part('Mist'),
    precipitation: part('Rain and snow'),
    rainbow: part('Rainbow'),
    wetGround: part('Wet ground and snow cover'),
    flashes: {
      ...part('Lightning'),
      description: 'In storms. Off at first: flashes may harm people with photosensitive epilepsy'
    },
    moon: part('Moon'),
    moonlight: part('Moonlight on the land'),
    stars: part('Stars'),
    milkyWay: part('Milky Way'),
    airglow: part('Airglow'),
    flare: part("Sun's halo"),
    trees: part('Trees'),
    village: part('Village'),
    lamps: part('Lamps and lit windows'),
    water: part('Lake'),
    environment: part('Sky in the lake'),
    autoExposure: part('Automatic exposure'),
    ...effectArgTypes,
    reflections: effect(
      'Reflections',
      'The lake mirrors what is in the picture (SSR); without, the sky alone'
    ),
    hazeStrength: factor('Haze', 'Optical depth of the air between camera and scene'),
    twilightSaturation: factor('Colour of twilight', 'Saturation; 0 is grey'),
    shaftStrength: factor('Light shafts', 'Light that shadowed air loses'),
    starlight: factor('Stars', 'Light of stars and Milky Way'),
    airglowStrength: factor('Airglow', 'Light of the upper air itself, by night'),
    earthshine: factor('Earthshine', "On the moon's dark side"),
    ambient: factor('Ambient of clouds', 'Light of sky and ground on clouds'),
    purkinjeShift: {
      ...factor('Sight by night', 'Bluish grey, as eyes see nights; 0 has the colours of a camera'),
      control: { type: 'range', min: 0, max: 1, step: 0.05 }
    },
    ...rendererArgTypes,
    path: { table: { disable: true } }
  },
  args: {
    view: 'village',
    ...openingState,
    forceWebGL: false,
    path: 'post',
    frame: false
  }
}

export default meta

type Story = StoryObj<ValleyArgs>

/** A day in a valley: sun, moon and stars, clouds and their shadows, mist, water and a village. */
export const Day: Story = { name: 'A day', tags: ['screenshot', 'webgpu-only'] }

/** Mist over the lake, in the shadow of a mountain and in the sun. */
export const Morning: Story = { args: { hour: 7, weather: 'mist', view: 'slope', dayLength: 1800 } }

/** The last sun is on summits and clouds, and in the lake. */
export const Evening: Story = {
  args: { hour: 19, view: 'shore', dayLength: 1800 }
}

/** The village's windows are lit; the moon and the stars are. */
export const Night: Story = {
  args: { hour: 22.5, date: Date.UTC(2026, 8, 26), dayLength: 1800 }
}

/** Showers over the valley at noon in autumn, and their bow before the mountains. */
export const Shower: Story = {
  args: { hour: 12.3, date: Date.UTC(2026, 10, 1), weather: 'shower', dayLength: 1800 }
}

/** A storm on a summer afternoon; switch the lightning on. */
export const Storm: Story = { args: { hour: 15, weather: 'storm', dayLength: 1800 } }

/** Snowfall in winter: the ground whitens. */
export const Snow: Story = {
  args: { hour: 11, date: Date.UTC(2026, 11, 19), weather: 'snow', dayLength: 1800 }
}

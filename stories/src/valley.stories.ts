import { cloudQualities } from '@welkin/clouds'
import type { Meta, StoryObj } from '@storybook/html-vite'
import { mount } from './mount'
import { choiceOf, rendererArgTypes } from './storyArgs'
import { storyCode } from './storyCode'
import { createValley } from './valley.scene'
import type { ValleyArgs } from './valley.scene'
import { ANTIALIASING } from './valley/finish'
import { openingState } from './valley/openingState'
import { VIEWS } from './valley/views'
import { weathers } from './valley/weather'

const code = `${storyCode('valleyAir.ts', 'sky and light')}

${storyCode('valleyAir.ts', 'everything')}

${storyCode('valleyFactors.ts', 'factors')}`

const part = (name: string): object => ({ name, control: 'boolean', table: { category: 'Parts' } })

const POST_EFFECTS = { table: { category: 'Post effects' } }

/** Switch of a post effect; the picture is compiled anew. */
const effect = (name: string, description: string): object => ({
  name,
  description,
  control: 'boolean',
  ...POST_EFFECTS
})

/** Slider of an artistic factor. */
const factor = (name: string, description: string): object => ({
  name,
  description,
  control: { type: 'range', min: 0, max: 3, step: 0.05 },
  table: { category: 'Artistic factors' }
})

const meta: Meta<ValleyArgs> = {
  title: 'Valley, all day',
  render: mount(createValley, code, ({ quality }) => quality),
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
    season: {
      name: 'Season [part of a year]',
      control: { type: 'range', min: 0, max: 0.99, step: 0.01 },
      description:
        '0 the equinox of March 2026, 0.25 the solstice of June; the moon is as of the date'
    },
    latitude: { name: 'Latitude [°]', control: { type: 'range', min: -66, max: 66, step: 1 } },
    quality: { name: 'Quality', control: 'select', options: Object.keys(cloudQualities) },
    clouds: part('Clouds'),
    shafts: part('Light shafts'),
    mist: part('Mist'),
    nightSky: part('Moon, stars and airglow'),
    trees: part('Trees'),
    village: part('Village'),
    water: part('Lake'),
    antialiasing: { name: 'Smooth edges', ...choiceOf(ANTIALIASING), ...POST_EFFECTS },
    occlusion: effect('Ambient occlusion', 'Of the light of the sky alone (GTAO)'),
    bloom: effect('Bloom', 'A halo about what is bright'),
    depthOfField: effect(
      'Depth of field',
      'Sharp in the middle; the nearer that is, the more is blurred'
    ),
    motionBlur: effect('Motion blur', 'While the camera turns or flies'),
    haze: factor('Haze', 'Optical depth of the air between camera and scene'),
    twilightSaturation: factor('Colour of twilight', 'Saturation; 0 is grey'),
    shaftStrength: factor('Light shafts', 'Light that shadowed air loses'),
    starlight: factor('Stars', 'Light of stars and Milky Way'),
    airglow: factor('Airglow', 'Light of the upper air itself, by night'),
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
export const Day: Story = { name: 'A day', tags: ['screenshot'] }

/** Mist over the lake before the sun is over the mountains. */
export const Morning: Story = { args: { hour: 5, weather: 'mist', view: 'slope', dayLength: 1800 } }

/** The sun sets among broken clouds. */
export const Evening: Story = {
  args: { hour: 18.8, weather: 'broken', view: 'shore', dayLength: 1800 }
}

/** The village's windows are lit; the moon and the stars are. */
export const Night: Story = {
  args: { hour: 22.5, season: 0.27, dayLength: 1800 },
  tags: ['screenshot', 'webgpu-only']
}

/** Showers over the valley at noon in autumn, and their bow before the mountains. */
export const Shower: Story = {
  args: { hour: 12.3, season: 0.62, weather: 'shower', dayLength: 1800 },
  tags: ['screenshot', 'webgpu-only']
}

/** Snowfall in winter: the ground whitens. */
export const Snow: Story = { args: { hour: 11, season: 0.75, weather: 'snow', dayLength: 1800 } }

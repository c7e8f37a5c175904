import { cloudPreset, cloudPresetNames, cloudQualities } from '@welkin/clouds'
import type { CloudPresetName } from '@welkin/clouds'
import type { Meta, StoryObj } from '@storybook/html-vite'
import { layerArgs, layerArgTypes } from './clouds/layerArgs'
import { stageNames, stages } from './clouds/stages'
import { createClouds, shownBy } from './clouds.scene'
import type { CloudsArgs } from './clouds.scene'
import { mount } from './mount'
import { rendererArgTypes, timeArgTypes } from './storyArgs'
import { storyCode } from './storyCode'

const code = storyCode(
  ['quickStart.ts', 'quick start'],
  ['air.ts', 'post effect'],
  ['clouds.scene.ts', 'clouds']
)

const { forceWebGL, frame } = rendererArgTypes
const hidden = { table: { disable: true } }
const camera = { table: { category: 'Camera' } }

/** A preset and the parameters of its lowest layer. */
const sky = (preset: CloudPresetName) => ({
  preset,
  layer: 0,
  shown: shownBy(preset, 0),
  ...layerArgs(cloudPreset(preset).at(0).parameters)
})

/** The picture says little of thin clouds: more of them, and thicker. */
const world = {
  ...sky('fairWeather'),
  coverage: 0.75,
  topAltitude: 4000,
  world: true,
  day: Date.UTC(2026, 11, 21),
  hour: 15,
  exposure: -1.25
}

const meta: Meta<CloudsArgs> = {
  title: 'Clouds',
  render: mount(createClouds, code, ({ preset, world }) => `${preset} ${world}`),
  argTypes: {
    preset: {
      name: 'Clouds',
      options: cloudPresetNames,
      control: 'select'
    },
    quality: { name: 'Quality', options: Object.keys(cloudQualities), control: 'inline-radio' },
    debug: {
      name: 'Debug',
      description: 'What is shown instead of the clouds: white is most',
      options: ['off', 'density', 'steps', 'depth', 'history'],
      control: 'select'
    },
    timeLapse: {
      name: 'Time lapse',
      description: 'How many times faster than the clock clouds drift',
      control: { type: 'range', min: 0, max: 100, step: 1 }
    },
    ...timeArgTypes,
    layer: {
      name: 'Layer',
      description: 'Which of the layers the parameters below are of, from the lowest',
      control: { type: 'range', min: 0, max: 3, step: 1 },
      table: { category: 'Layer' }
    },
    ...layerArgTypes,
    altitude: {
      name: 'Altitude [m]',
      control: { type: 'number', min: 2, max: 1e8 },
      description: 'Where the camera goes, above the ellipsoid; fly on from there with the mouse',
      ...camera
    },
    heading: {
      name: 'Heading [°]',
      control: { type: 'range', min: 0, max: 360, step: 1 },
      ...camera
    },
    pitch: { name: 'Pitch [°]', control: { type: 'range', min: -90, max: 90, step: 1 }, ...camera },
    longitude: {
      name: 'Longitude [°]',
      control: { type: 'range', min: -180, max: 180, step: 0.01 },
      ...camera
    },
    latitude: {
      name: 'Latitude [°]',
      control: { type: 'range', min: -90, max: 90, step: 0.01 },
      ...camera
    },
    world: {
      name: 'World map',
      description: 'Takes the cover from a picture of the whole planet',
      control: 'boolean'
    },
    forceWebGL,
    frame,
    shown: hidden,
    stage: hidden,
    noise: hidden,
    slice: hidden,
    props: hidden,
    path: hidden
  },
  args: {
    ...sky('fairWeather'),
    quality: 'medium',
    debug: 'off',
    timeLapse: 1,
    world: false,
    stage: 'cloud',
    noise: false,
    slice: 0.5,
    props: 'none',
    // 2 m above a meadow.
    longitude: -84.178,
    latitude: 36.622,
    altitude: 341.8,
    heading: 318,
    pitch: 14,
    day: Date.UTC(2026, 5, 21),
    hour: 15,
    exposure: 0,
    forceWebGL: false,
    path: 'post',
    frame: false
  }
}

export default meta

type Story = StoryObj<CloudsArgs>

/** Fair weather over a meadow. */
export const Cumulus: Story = {
  name: 'Cumulus from the ground',
  args: { coverage: 0.45, pitch: 18 },
  tags: ['screenshot', 'webgpu-only']
}

/** Stratocumulus below the windows of an aircraft. */
export const Cockpit: Story = {
  name: 'Cockpit above a deck',
  args: { ...sky('stratocumulus'), altitude: 2600, heading: 250, pitch: -5, props: 'cockpit' }
}

/** Storms up to 11 km high in the sun of the afternoon: flat bases, towers, an anvil. */
export const Storm: Story = {
  args: {
    ...sky('cumulonimbus'),
    longitude: 139.853,
    latitude: 35.845,
    altitude: 600,
    heading: 20,
    pitch: 14,
    hour: 6.5
  }
}

/** Towering cumulus of an afternoon, heads upon heads. */
export const Congestus: Story = {
  args: {
    ...sky('congestus'),
    longitude: 139.77,
    latitude: 35.68,
    altitude: 300,
    heading: 330,
    pitch: 14,
    hour: 6.5
  }
}

/** Small regular cells, lit aside. */
export const Altocumulus: Story = {
  args: {
    ...sky('altocumulus'),
    longitude: 139.77,
    latitude: 35.68,
    altitude: 300,
    heading: 30,
    pitch: 24,
    hour: 0.5
  }
}

/** A closed deck, and grey rain from it that hides the horizon. */
export const Nimbostratus: Story = {
  args: {
    ...sky('nimbostratus'),
    longitude: 22.3,
    latitude: 46.7,
    altitude: 300,
    heading: 30,
    pitch: 7,
    hour: 9
  }
}

/** Rain and hail below a storm's tower: steep shafts of stones in what leans with the wind. */
export const Hailstorm: Story = {
  args: {
    ...sky('hailstorm'),
    longitude: 139.853,
    latitude: 35.845,
    altitude: 300,
    heading: 20,
    pitch: 10,
    hour: 6.5
  }
}

/** Morning over a sea of fog, out of which ridges stand. */
export const Fog: Story = {
  args: {
    ...sky('fog'),
    baseAltitude: 250,
    topAltitude: 450,
    altitude: 700,
    heading: 60,
    pitch: -5,
    hour: 11.6
  }
}

/** The sun is about to set, and reddens ice clouds from below. */
export const Cirrus: Story = {
  name: 'Cirrus at dusk',
  args: { ...sky('cirrus'), heading: 290, pitch: 12, hour: 24.6, exposure: 2 }
}

/** The cloud cover of a real day, from 400 km; fly down to the ground. */
export const WorldClouds: Story = {
  name: 'World clouds from orbit',
  args: {
    ...world,
    longitude: -38,
    latitude: -34,
    altitude: 400_000,
    heading: 235,
    pitch: -28
  }
}

/** Cloud cover of a real day, from 12,000 km. */
export const WorldCloudsFromAfar: Story = {
  name: 'World clouds from 12,000 km',
  args: {
    ...world,
    longitude: -40,
    latitude: -25,
    altitude: 12_000_000,
    heading: 0,
    pitch: -90
  }
}

/** Balloons, one farther into the cloud than the other. */
export const InsideACloud: Story = {
  name: 'Inside a cloud',
  args: {
    ...sky('overcast'),
    density: 0.008,
    altitude: 1350,
    heading: 140,
    pitch: 2,
    props: 'balloons'
  }
}

/** Shadows drift over real heights. */
export const Shadows: Story = {
  name: 'Cloud shadows on terrain',
  args: {
    coverage: 0.5,
    longitude: -84.1517,
    latitude: 36.45,
    altitude: 3200,
    heading: 322,
    pitch: -20,
    timeLapse: 20
  }
}

/** Each preset over the same land; choose one. */
export const Presets: Story = {
  args: { ...sky('mixed'), altitude: 500, pitch: 12 }
}

/** The stages of a cumulus, one on top of the other; choose one. */
export const HowACloudIsMade: Story = {
  name: 'How a cloud is made',
  argTypes: {
    stage: {
      name: 'Stage',
      description: 'How much of their form clouds have; the parameters below set the rest',
      options: Object.keys(stages),
      control: { type: 'inline-radio', labels: stageNames },
      table: { disable: false }
    },
    noise: {
      name: 'Slices of the noise',
      description:
        'Rows: weather (cumulus, stratocumulus, cumulonimbus, cirrus), shape (coarse and fine billows, curl), detail',
      control: 'boolean',
      table: { disable: false }
    },
    slice: {
      name: 'Place of the slices',
      control: { type: 'range', min: 0, max: 1, step: 0.005 },
      table: { disable: false }
    }
  },
  args: { stage: 'columns', coverage: 0.2, altitude: 1150, pitch: 6 }
}

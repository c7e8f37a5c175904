import type { Meta, StoryObj } from '@storybook/html-vite'
import { mount } from './mount'
import {
  choiceOf,
  effectArgTypes,
  rendererArgTypes,
  shaftArgTypes,
  timeArgTypes
} from './storyArgs'
import { storyCode } from './storyCode'
import { COLORS, createTerrain, VIEWS } from './terrain.scene'
import type { TerrainArgs } from './terrain.scene'
import { hasEffects, NO_EFFECTS } from './terrain/GroundFinish'

const meta: Meta<TerrainArgs> = {
  title: 'Terrain',
  render: mount(
    createTerrain,
    storyCode(['terrain.scene.ts', 'terrain'], ['terrain/NightSky.ts', 'night']),
    ({ clouds, mist, shafts, mirror, night, ...effects }: TerrainArgs) =>
      [clouds, mist > 0, shafts, mirror, night, hasEffects(effects)].join()
  ),
  argTypes: {
    view: {
      name: 'Place',
      ...choiceOf(VIEWS)
    },
    color: { name: 'Colours', ...choiceOf(COLORS) },
    wireframe: { name: 'Wireframe', control: 'boolean' },
    tour: { name: 'Shore, summit, orbit', control: 'boolean' },
    windSpeed: { name: 'Wind [m/s]', control: { type: 'range', min: 0, max: 30, step: 0.5 } },
    shadows: { name: 'Shadows', control: 'boolean' },
    shafts: {
      name: 'Light shafts, far shadows',
      control: 'boolean',
      description: 'Shadows of mountains beyond all shadow maps, on the ground and in the air'
    },
    strength: shaftArgTypes.strength,
    mirror: {
      name: 'Water mirrors clouds',
      control: 'boolean',
      description: 'The scene has an environment map, in place of the clear sky'
    },
    clouds: { name: 'Clouds', control: 'boolean' },
    mist: { name: 'Mist [1/km]', control: { type: 'range', min: 0, max: 6, step: 0.1 } },
    vegetation: { name: 'Grass, flowers, trees', control: 'boolean' },
    night: {
      name: 'Moon, stars, airglow',
      control: 'boolean',
      description: "With their light on the land, and the sun's halo"
    },
    ...effectArgTypes,
    ...timeArgTypes,
    ...rendererArgTypes
  },
  args: {
    view: 'meadow',
    color: 'ground',
    wireframe: false,
    tour: false,
    windSpeed: 7,
    shadows: true,
    shafts: false,
    strength: 1,
    mirror: false,
    clouds: false,
    mist: 0,
    vegetation: false,
    night: false,
    ...NO_EFFECTS,
    day: Date.UTC(2026, 5, 21),
    hour: 15.5,
    exposure: 0,
    forceWebGL: false,
    path: 'forward',
    frame: false
  }
}

export default meta

type Story = StoryObj<TerrainArgs>

/** Two metres above the ground, among mountains: the ground alone. */
export const Meadow: Story = {}

/** Grass, flowers and trees on it: a sample, no part of the package. */
export const Plants: Story = { name: 'Meadow and woods', args: { vegetation: true } }

/** One take: a shore, a summit, orbit. */
export const Take: Story = { name: 'Shore to orbit', args: { view: 'shore', tour: true } }

/** A lake among mountains, 1,516 m above the sea. */
export const Lake: Story = { args: { view: 'lake' } }

/** Summits in clouds, valleys in mist. */
export const Weather: Story = {
  name: 'Clouds and mist',
  args: { view: 'range', clouds: true, mist: 1.5, hour: 7 }
}

/** A low sun behind mountains: their shadows in the haze, on the ground and on clouds. */
export const Shafts: Story = {
  name: 'Mountain shadows and clouds',
  args: { view: 'range', clouds: true, shafts: true, mirror: true, hour: 4.7, exposure: 1.5 }
}

/** All at once: mist, clouds, shafts, plants, and what a camera does, exposed by the picture. */
export const Everything: Story = {
  name: 'Everything at once',
  args: {
    view: 'lake',
    clouds: true,
    mist: 1,
    shafts: true,
    mirror: true,
    night: true,
    vegetation: true,
    hour: 5.5,
    antialiasing: 'traa',
    occlusion: true,
    localExposure: true,
    bloom: true,
    motionBlur: true
  }
}

/** Above the ridges. */
export const Range: Story = { args: { view: 'range' } }

/** The whole planet: the same mesh. */
export const Globe: Story = { args: { view: 'globe' }, tags: ['screenshot', 'webgpu-only'] }

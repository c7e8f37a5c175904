import type { Meta, StoryObj } from '@storybook/html-vite'
import { mount } from './mount'
import { createPlanets } from './planets.scene'
import type { PlanetsArgs } from './planets.scene'
import { rendererArgTypes } from './storyArgs'
import { storyCode } from './storyCode'

const range = (name: string, min: number, max: number, step: number, description: string) => ({
  name,
  description,
  control: { type: 'range' as const, min, max, step }
})

const code = storyCode(['planets.scene.ts', 'planets'], ['planets.scene.ts', "planet's ground"])

const meta: Meta<PlanetsArgs> = {
  title: 'Planets',
  render: mount(createPlanets, code),
  argTypes: {
    planet: {
      name: 'Planet',
      description: 'Venus is seen above its clouds; the Moon has no air',
      options: ['earth', 'made-up', 'mars', 'titan', 'venus', 'moon'],
      control: {
        type: 'select',
        labels: {
          earth: 'Earth',
          'made-up': 'Procedural continents',
          mars: 'Mars',
          titan: 'Titan',
          venus: 'Venus',
          moon: 'Moon'
        }
      }
    },
    height: range('Height [m]', 2, 2e7, 1, 'Of the camera above the ground'),
    longitude: range('Longitude [°]', -180, 180, 1, 'East of the prime meridian'),
    latitude: range('Latitude [°]', -90, 90, 1, 'North of the equator'),
    sunElevation: range('Sun [°]', -90, 90, 0.5, 'Above the horizon'),
    sunAzimuth: range('Sun aside [°]', -180, 180, 1, 'From where the camera looks, clockwise'),
    pitch: range('Look up [°]', -90, 90, 1, 'Above the horizontal'),
    fieldOfView: range('Field of view [°]', 5, 120, 1, 'Vertical'),
    exposure: range('Exposure [stops]', -4, 20, 0.25, "0 suits the planet's daylight"),
    dust: range('Dust', 0, 4, 0.05, "Optical depth of Mars's dust"),
    ...rendererArgTypes
  },
  args: {
    planet: 'mars',
    height: 2,
    longitude: 10,
    latitude: 30,
    sunElevation: 45,
    sunAzimuth: 100,
    pitch: 12,
    fieldOfView: 60,
    exposure: -1,
    dust: 0.5,
    forceWebGL: false,
    path: 'forward',
    frame: false
  }
}

export default meta

type Story = StoryObj<PlanetsArgs>

export const MarsNoon: Story = {}

/** Dust throws blue light closer to the sun than red. */
export const MarsSunset: Story = {
  args: { sunElevation: 3, sunAzimuth: 0, pitch: 8, fieldOfView: 55, exposure: -3, dust: 0.3 },
  tags: ['screenshot', 'webgpu-only']
}

export const Titan: Story = {
  args: { planet: 'titan', height: 6e6, pitch: -90, sunElevation: 10, exposure: -0.5 }
}

export const TitanGround: Story = { args: { planet: 'titan', sunElevation: 40, exposure: 1 } }

export const Venus: Story = {
  args: { planet: 'venus', height: 1.2e7, pitch: -90, sunElevation: 20, exposure: -1.5 }
}

export const MoonGround: Story = { args: { planet: 'moon', sunElevation: 15, sunAzimuth: 20 } }

/** Land and sea from pictures; the sun glints on the sea. */
export const Earth: Story = {
  args: { planet: 'earth', height: 1.2e7, pitch: -90, sunElevation: 35, exposure: -2 }
}

export const EarthNight: Story = {
  args: { planet: 'earth', height: 1.2e7, pitch: -90, sunElevation: -60, exposure: 10 }
}

/** The Mediterranean, and a low sun on it. */
export const LowOrbit: Story = {
  args: {
    planet: 'earth',
    height: 4e5,
    longitude: 18,
    latitude: 31,
    pitch: -25,
    sunElevation: 35,
    sunAzimuth: 25,
    exposure: -2
  }
}

/** No picture at all: continents are procedural. */
export const MadeUp: Story = {
  args: { planet: 'made-up', height: 1e7, pitch: -90, sunElevation: 35, exposure: -2 }
}

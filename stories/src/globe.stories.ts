import type { Meta, StoryObj } from '@storybook/html-vite'
import { createGlobe } from './globe.scene'
import type { GlobeArgs } from './globe.scene'
import { PLACES } from './globe/places'
import { mount } from './mount'
import { choiceOf, rendererArgTypes, timeArgTypes } from './storyArgs'
import { storyCode } from './storyCode'

const code = storyCode(
  ['quickStart.ts', 'quick start'],
  ['globe.scene.ts', 'globe'],
  ['globe.scene.ts', 'globe night']
)

const partOfNight = (name: string): object => ({
  name,
  control: 'boolean',
  table: { category: 'Night sky' }
})

const meta: Meta<GlobeArgs> = {
  title: 'Globe',
  render: mount(createGlobe, code, ({ clouds, path }) => String(clouds && path !== 'post')),
  argTypes: {
    place: {
      name: 'Camera',
      description: 'Where the camera goes; fly on from there with the mouse, WASD and QE',
      ...choiceOf(PLACES)
    },
    clouds: {
      name: 'Clouds',
      description:
        "The world's, drawn over the finished picture; on the forward path the scene is made anew for them",
      control: 'boolean'
    },
    stars: partOfNight('Stars and Milky Way'),
    moon: partOfNight('Moon'),
    airglow: partOfNight('Airglow'),
    ...timeArgTypes,
    ...rendererArgTypes
  },
  args: {
    place: 'street',
    day: Date.UTC(2026, 5, 21),
    hour: 22,
    exposure: 0,
    clouds: false,
    stars: true,
    moon: true,
    airglow: true,
    forceWebGL: false,
    path: 'forward',
    frame: false
  }
}

export default meta

type Story = StoryObj<GlobeArgs>

/** Seven on a summer morning, eye height. */
export const Street: Story = { tags: ['screenshot', 'webgpu-only'] }

export const Rooftops: Story = {
  name: '1 km',
  args: { place: 'rooftops', hour: 6.5 }
}

export const Coast: Story = {
  name: '10 km',
  args: { place: 'coast', hour: 7 }
}

export const Orbit: Story = {
  name: '400 km',
  args: { place: 'orbit', hour: 5, exposure: -1 },
  tags: ['screenshot', 'webgpu-only']
}

/** The terminator crosses the Indian Ocean. */
export const WholeGlobe: Story = {
  name: '20,000 km',
  args: { place: 'globe', hour: 1, exposure: -1 }
}

/** Eye height, between ridges of real heights. */
export const Valley: Story = {
  args: { place: 'valley', hour: 13.5 },
  tags: ['screenshot', 'webgpu-only']
}

/** Early morning along the Jacksboro fault. */
export const Ridges: Story = { args: { place: 'ridges', hour: 12 } }

/** Nights have the world's clouds: on the post path these go and come at once. */
const night = { clouds: true, path: 'post' } as const

/** Lit windows, lanes under lamps, and the moon over the end of the street. */
export const NightStreet: Story = {
  name: 'By night: street',
  args: { ...night, place: 'street', day: Date.UTC(2026, 8, 24), hour: 17.25, exposure: -0.5 }
}

/** The city's lights, and the moon about to set among clouds. */
export const NightRooftops: Story = {
  name: 'By night: 1 km',
  args: { ...night, place: 'rooftops', day: Date.UTC(2026, 8, 24), hour: 18 }
}

/** America's towns beside moonlit clouds; airglow, stars, and the moon over the limb. */
export const NightOrbit: Story = {
  name: 'By night: 400 km',
  args: { ...night, place: 'eastCoast', day: Date.UTC(2026, 0, 29), hour: 8.9, exposure: -0.75 }
}

/** Towns of Europe and the Nile at midnight; over the Atlantic, clouds in moonlight. */
export const NightGlobe: Story = {
  name: 'By night: 20,000 km',
  args: { ...night, place: 'europe', day: Date.UTC(2026, 11, 18), hour: 23.3, exposure: -1.25 }
}

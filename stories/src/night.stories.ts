import type { Meta, StoryObj } from '@storybook/html-vite'
import { mount } from './mount'
import { createNight } from './night.scene'
import type { NightArgs } from './night.scene'
import { CONSTELLATIONS } from './night/constellations'
import { choiceOf, rendererArgTypes } from './storyArgs'
import { storyCode } from './storyCode'

const code = storyCode(['night.scene.ts', 'night'], ['night.scene.ts', 'night exposure'])

const meta: Meta<NightArgs> = {
  title: 'Starry night',
  render: mount(createNight, code),
  argTypes: {
    constellation: {
      name: 'Constellation',
      ...choiceOf(CONSTELLATIONS)
    },
    fieldOfView: {
      name: 'Field of view [°]',
      control: { type: 'range', min: 1, max: 100, step: 1 },
      description: 'Vertical'
    },
    chart: {
      name: 'Chart',
      control: 'boolean',
      description: 'Lines of a star chart, from places of its own'
    },
    exposure: {
      name: 'Exposure [stops]',
      control: { type: 'range', min: -6, max: 6, step: 0.25 },
      description: '0 as exposureFor says'
    },
    ...rendererArgTypes,
    path: { table: { disable: true } }
  },
  args: {
    constellation: 'orion',
    fieldOfView: 40,
    chart: true,
    exposure: 0,
    forceWebGL: false,
    path: 'forward',
    frame: false
  }
}

export default meta

type Story = StoryObj<NightArgs>

/** Two hours before midnight in January, 45° north. */
export const Orion: Story = { tags: ['screenshot', 'webgpu-only'] }

export const UrsaMajor: Story = {
  args: { constellation: 'ursaMajor' }
}

export const Cassiopeia: Story = {
  args: { constellation: 'cassiopeia' }
}

/** The middle of the Milky Way beside it, from 25° south. */
export const Scorpius: Story = { args: { constellation: 'scorpius' }, tags: ['screenshot'] }

export const Crux: Story = { args: { constellation: 'crux' } }

/** The whole arch of the Milky Way, a stop and a half brighter than the eye sees it. */
export const Wide: Story = {
  args: { constellation: 'scorpius', fieldOfView: 95, chart: false, exposure: 1.5 }
}

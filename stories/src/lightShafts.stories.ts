import type { Meta, StoryObj } from '@storybook/html-vite'
import { createLightShafts } from './lightShafts.scene'
import type { LightShaftsArgs } from './lightShafts.scene'
import { mount } from './mount'
import { argsOf, sceneOf, shaftViews } from './shafts/views'
import { choiceOf, rendererArgTypes, shaftArgTypes } from './storyArgs'
import { storyCode } from './storyCode'

const code = storyCode(
  ['quickStart.ts', 'quick start'],
  ['air.ts', 'post effect'],
  ['lightShafts.scene.ts', 'light shafts'],
  ['lightShafts.scene.ts', 'shafts of clouds'],
  ['lightShafts.scene.ts', 'exposure under clouds']
)

const { forceWebGL, frame } = rendererArgTypes
const { strength, turbidity, azimuth, exposure } = shaftArgTypes

const meta: Meta<LightShaftsArgs> = {
  title: 'Light shafts',
  render: mount(
    createLightShafts,
    code,
    ({ view }) => sceneOf(view),
    ({ view }) => argsOf(view)
  ),
  argTypes: {
    view: {
      name: 'View',
      ...choiceOf(shaftViews),
      description:
        'Sets haze and light, too. One flies between the two of storms; others have land or a light of their own: a new scene, which fades in'
    },
    strength,
    turbidity: { ...turbidity, control: { type: 'range', min: 1, max: 16, step: 0.25 } },
    elevation: {
      name: 'Elevation [°]',
      control: { type: 'range', min: -6, max: 60, step: 0.5 },
      description: 'Of the sun, or of the moon by night'
    },
    azimuth,
    exposure: { ...exposure, description: '0 as the picture asks for' },
    forceWebGL,
    frame,
    path: { table: { disable: true } }
  },
  args: {
    view: 'deck',
    ...argsOf('deck'),
    strength: 1,
    exposure: 0,
    forceWebGL: false,
    path: 'post',
    frame: false
  }
}

export default meta

type Story = StoryObj<LightShaftsArgs>

/** Jacob's ladder: rays that fan out from the gaps of a deck. */
export const Deck: Story = { name: 'Below a broken deck' }

/** Rays between the shadows of spruces on a ridge, in the fog of the valley before it, the sun 9° up. */
export const Ridge: Story = {
  name: 'Ridge at sunrise',
  args: { view: 'ridge', ...argsOf('ridge') }
}

/** Towers against the sun, in haze and mist. */
export const Towers: Story = {
  name: 'Towers in haze',
  args: { view: 'towers', ...argsOf('towers') },
  tags: ['screenshot', 'webgpu-only']
}

/** A storm's shadow on its anvil and on the haze below, from 9 km. */
export const Storm: Story = {
  name: "Storm's shadow from 9 km",
  args: { view: 'storm', ...argsOf('storm') }
}

/** Rays that run together opposite the sunset. */
export const Opposite: Story = {
  name: 'Anticrepuscular rays',
  args: { view: 'opposite', ...argsOf('opposite') }
}

/** Moonlight through the gaps of a deck. */
export const Moonlight: Story = { args: { view: 'moonlight', ...argsOf('moonlight') } }

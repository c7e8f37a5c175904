import type { Meta, StoryObj } from '@storybook/html-vite'
import { createLightShafts } from './lightShafts.scene'
import type { LightShaftsArgs } from './lightShafts.scene'
import { mount } from './mount'
import { rendererArgTypes, shaftArgTypes } from './storyArgs'
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
const hidden = { table: { disable: true } }

const meta: Meta<LightShaftsArgs> = {
  title: 'Light shafts',
  render: mount(createLightShafts, code, ({ view }) => view),
  argTypes: {
    strength,
    turbidity,
    elevation: {
      name: 'Elevation [°]',
      control: { type: 'range', min: -6, max: 60, step: 0.5 },
      description: 'Of the sun, or of the moon by night'
    },
    azimuth,
    exposure,
    forceWebGL,
    frame,
    view: hidden,
    path: hidden
  },
  args: {
    view: 'deck',
    strength: 1,
    turbidity: 9,
    elevation: 20,
    azimuth: 45,
    exposure: -1.75,
    forceWebGL: false,
    path: 'post',
    frame: false
  }
}

export default meta

type Story = StoryObj<LightShaftsArgs>

/** Jacob's ladder: rays that fan out from the gaps of a deck. */
export const Deck: Story = { name: 'Below a broken deck', tags: ['screenshot'] }

/** Shadows of a ridge in the haze and the fog behind it, the sun 4° up. */
export const Ridge: Story = {
  name: 'Ridge at sunrise',
  args: { view: 'ridge', turbidity: 3, elevation: 4, azimuth: 100, exposure: -1.75 },
  tags: ['screenshot', 'webgpu-only']
}

/** Towers in haze, against the sun. */
export const Towers: Story = {
  name: 'Towers in haze',
  args: { view: 'city', turbidity: 10, elevation: 12, azimuth: 236, exposure: -1 }
}

/** A storm's shadow on its anvil and on the haze below, from 10 km. */
export const Storm: Story = {
  name: "Storm's shadow from 10 km",
  args: { view: 'storm', turbidity: 3, elevation: 12, azimuth: 192, exposure: -2 }
}

/** Rays that run together opposite the sunset. */
export const Opposite: Story = {
  name: 'Anticrepuscular rays',
  args: { view: 'opposite', turbidity: 3, elevation: 3, azimuth: 250, exposure: -1 }
}

/** Moonlight through the gaps of a deck. */
export const Moonlight: Story = {
  args: { view: 'moon', turbidity: 4, elevation: 25, azimuth: 40, exposure: 0.5 }
}

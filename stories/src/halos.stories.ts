import type { Meta, StoryObj } from '@storybook/html-vite'
import { createHalos } from './halos.scene'
import type { HalosArgs } from './halos.scene'
import { argsOf, VIEWS } from './halosViews'
import { mount } from './mount'
import { choiceOf, rendererArgTypes } from './storyArgs'
import { storyCode } from './storyCode'

const code = storyCode(
  ['quickStart.ts', 'quick start'],
  ['air.ts', 'post effect'],
  ['halos.scene.ts', 'droplets']
)

const { forceWebGL, frame } = rendererArgTypes
const share = (name: string, description: string) => ({
  name,
  description,
  control: { type: 'range' as const, min: 0, max: 1, step: 0.05 }
})

const meta: Meta<HalosArgs> = {
  title: 'Bows and halos',
  render: mount(createHalos, code),
  argTypes: {
    view: {
      name: 'View',
      ...choiceOf(VIEWS),
      description: 'Sets sun, droplets and exposure, too'
    },
    sun: { name: 'Sun [°]', control: { type: 'range', min: 1, max: 60, step: 0.5 } },
    dropletRadius: {
      name: 'Droplets [µm]',
      description: 'Effective radius of the droplets of clouds and mist',
      control: { type: 'range', min: 3, max: 30, step: 0.5 }
    },
    regular: share('Flat crystals', 'Share of the crystals with flat faces: others make no halo'),
    level: share('Level plates', 'Share of the plates that float level: they make sun dogs'),
    exposure: { name: 'Exposure [stops]', control: { type: 'range', min: -4, max: 4, step: 0.25 } },
    forceWebGL,
    frame,
    path: { table: { disable: true } }
  },
  args: {
    view: 'halo',
    ...argsOf(VIEWS.halo),
    regular: 0.7,
    level: 0.5,
    forceWebGL: false,
    path: 'post',
    frame: false
  }
}

export default meta

type Story = StoryObj<HalosArgs>

/** A winter noon: thin cirrus, a halo of 22° about the sun, and sun dogs beside it. */
export const Halo: Story = {
  name: 'Halo and sun dogs',
  tags: ['screenshot', 'webgpu-only']
}

/** The sun behind an aeroplane: coloured rings on a thin deck below, about the point where its shadow falls. */
export const Glory: Story = {
  name: 'Glory from an aeroplane',
  args: { view: 'glory', ...argsOf(VIEWS.glory) }
}

/** A white bow of 40° about the glory, whole through a wide lens. */
export const Cloudbow: Story = {
  name: 'Cloudbow from an aeroplane',
  args: { view: 'cloudbow', ...argsOf(VIEWS.cloudbow) }
}

/** A light shower all about, the sun behind one's back: both bows, and the dark band between them. */
export const Rainbow: Story = {
  args: { view: 'rainbow', ...argsOf(VIEWS.rainbow) }
}

/** The sun behind one's back, and mist before one. */
export const Fogbow: Story = {
  args: { view: 'fogbow', ...argsOf(VIEWS.fogbow) }
}

/** The sun behind a thin even cloud of small droplets, exposed for it: an aureole that ends in brown, and coloured rings around. */
export const Corona: Story = {
  args: { view: 'corona', ...argsOf(VIEWS.corona) }
}

import type { Meta, StoryObj } from '@storybook/html-vite'
import { mount } from './mount'
import { createPhotogrammetry } from './photogrammetry.scene'
import type { PhotogrammetryArgs } from './photogrammetry.scene'
import { KEY } from './photogrammetry/KeptSource'
import { SIGHTS } from './photogrammetry/places'
import { choiceOf, rendererArgTypes, timeArgTypes } from './storyArgs'
import { storyCode } from './storyCode'

const meta: Meta<PhotogrammetryArgs> = {
  title: 'Photogrammetry tiles',
  render: mount(
    createPhotogrammetry,
    storyCode(
      ['photogrammetry.scene.ts', 'photogrammetry'],
      ['photogrammetry.scene.ts', 'clouds over photogrammetry']
    )
  ),
  argTypes: {
    url: {
      name: 'Tileset',
      description:
        "URL of any tileset, shown where it stands, or ion:NUMBER of one of Cesium's; empty with a key for Google's. Links have it",
      control: 'text'
    },
    [KEY]: {
      name: 'Key',
      description: 'Key or token that goes with it; this tab keeps it, and no link has it',
      control: 'text'
    },
    place: {
      name: 'Place',
      description: 'In tiles of the whole world',
      ...choiceOf(SIGHTS)
    },
    strength: {
      name: 'Light',
      description: "Share of Welkin's light; 0 leaves the photographs as they are",
      control: { type: 'range', min: 0, max: 1, step: 0.01 }
    },
    albedo: {
      name: "White's albedo",
      description: 'Photographs are brighter than what they show',
      control: { type: 'range', min: 0.1, max: 1.5, step: 0.01 }
    },
    clouds: {
      name: 'Clouds',
      description: 'Share of the sky that they cover, and shade the tiles from',
      control: { type: 'range', min: 0, max: 1, step: 0.01 }
    },
    ...timeArgTypes,
    ...rendererArgTypes,
    path: { table: { disable: true } }
  },
  args: {
    url: '',
    [KEY]: '',
    place: 'local',
    strength: 1,
    albedo: 0.8,
    clouds: 0.3,
    day: Date.UTC(2026, 5, 21),
    hour: 23.4,
    exposure: -1,
    forceWebGL: false,
    path: 'post',
    frame: false
  }
}

export default meta

type Story = StoryObj<PhotogrammetryArgs>

/** An evening's light and shadows on local tiles, which have neither. */
export const Local: Story = { tags: ['screenshot', 'webgpu-only'] }

/** Moonlight on the same tiles, whose photographs were taken by day. */
export const Night: Story = {
  args: { day: Date.UTC(2026, 8, 27), hour: 4.5, exposure: 0.5 }
}

/** The photographs as they are, in today's air. */
export const Untouched: Story = { args: { strength: 0 } }

/** Needs a key and a network: without, the local tiles, as in the picture here. */
export const Manhattan: Story = {
  name: 'Manhattan with a key, without it Tennessee',
  args: { place: 'manhattan', hour: 22.5 }
}

/** Needs a key and a network: without, the local tiles, as in the picture here. */
export const Fuji: Story = {
  name: 'Fuji with a key, without it Tennessee',
  args: { place: 'fuji', hour: 20.5 }
}

/** Needs a key and a network: without, the local tiles, as in the picture here. */
export const London: Story = {
  name: 'London with a key, without it Tennessee',
  args: { place: 'london', hour: 18.5 }
}

import type { Meta, StoryObj } from '@storybook/html-vite'
import { mount } from './mount'
import { createRealHeights, VIEWS } from './realHeights.scene'
import type { RealHeightsArgs } from './realHeights.scene'
import { choiceOf, rendererArgTypes, timeArgTypes } from './storyArgs'
import { storyCode } from './storyCode'

const meta: Meta<RealHeightsArgs> = {
  title: 'Real heights',
  render: mount(
    createRealHeights,
    storyCode(['realHeights.scene.ts', 'heights'], ['realHeights.scene.ts', 'GeoTIFF']),
    ({ url, attribution }: RealHeightsArgs) => url + attribution
  ),
  argTypes: {
    view: { name: 'Place', ...choiceOf(VIEWS) },
    url: {
      name: 'Terrarium tiles, GeoTIFF',
      control: 'text',
      description:
        'Template with {z}, {x} and {y}, such as https://…/{z}/{x}/{y}.png, or a GeoTIFF in degrees, such as https://…/heights.tif; empty for the local grid'
    },
    attribution: {
      name: 'Source of the tiles',
      control: 'text',
      description: 'Line that is shown with tiles of a server'
    },
    wireframe: { name: 'Wireframe', control: 'boolean' },
    ...timeArgTypes,
    ...rendererArgTypes
  },
  args: {
    view: 'village',
    url: '',
    attribution: '',
    wireframe: false,
    day: Date.UTC(2026, 5, 21),
    hour: 22,
    exposure: 0,
    forceWebGL: false,
    path: 'forward',
    frame: false
  }
}

export default meta

type Story = StoryObj<RealHeightsArgs>

/** A village between ridges of Tennessee, measured from space. */
export const Village: Story = { tags: ['screenshot', 'webgpu-only'] }

/** All of the grid, at which a plain begins. */
export const Range: Story = { args: { view: 'range' } }

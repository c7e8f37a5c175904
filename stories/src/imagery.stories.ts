import type { Meta, StoryObj } from '@storybook/html-vite'
import { createImagery, VIEWS } from './imagery.scene'
import type { ImageryArgs } from './imagery.scene'
import { mount } from './mount'
import { choiceOf, rendererArgTypes, timeArgTypes } from './storyArgs'
import { storyCode } from './storyCode'

const meta: Meta<ImageryArgs> = {
  title: 'Imagery',
  render: mount(
    createImagery,
    storyCode(['imagery.scene.ts', 'imagery']),
    ({ url }: ImageryArgs) => url
  ),
  argTypes: {
    view: { name: 'Place', ...choiceOf(VIEWS) },
    url: {
      name: 'Tiles',
      control: 'text',
      description:
        'Template with {z}, {x} and {y}, such as https://…/{z}/{x}/{y}.jpg, of Web Mercator; empty for local ones'
    },
    ...timeArgTypes,
    ...rendererArgTypes
  },
  args: {
    view: 'globe',
    url: '',
    day: Date.UTC(2026, 5, 21),
    hour: 11,
    exposure: -0.8,
    forceWebGL: false,
    path: 'forward',
    frame: false
  }
}

export default meta

type Story = StoryObj<ImageryArgs>

/** The whole planet: pictures for land, and a sea with waves and the sun's glint. */
export const Globe: Story = { tags: ['screenshot'] }

/** The Mediterranean from orbit. */
export const Orbit: Story = { args: { view: 'orbit' } }

/** Pictures are coarse there: blades and stones make up for it. */
export const Near: Story = { args: { view: 'near' } }

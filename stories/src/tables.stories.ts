import type { Meta, StoryObj } from '@storybook/html-vite'
import { mount } from './mount'
import { rendererArgTypes } from './storyArgs'
import { createTables } from './tables.scene'
import type { TablesArgs } from './tables.scene'

const meta: Meta<TablesArgs> = {
  title: 'Tables',
  render: mount(createTables),
  argTypes: {
    exposure: {
      name: 'Exposure [stops]',
      control: { type: 'range', min: -4, max: 20, step: 0.25 }
    },
    ...rendererArgTypes
  },
  args: { exposure: 0, forceWebGL: false, path: 'forward', frame: false }
}

export default meta

export const Tables: StoryObj<TablesArgs> = { tags: ['screenshot'] }

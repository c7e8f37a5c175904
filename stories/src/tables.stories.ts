import type { Meta, StoryObj } from '@storybook/html-vite'
import { mount } from './mount'
import { rendererArgTypes, timeArgTypes } from './storyArgs'
import { storyCode } from './storyCode'
import { createTables } from './tables.scene'
import type { TablesArgs } from './tables.scene'

const meta: Meta<TablesArgs> = {
  title: 'Tables',
  render: mount(createTables, storyCode(['tables.scene.ts', 'tables'])),
  argTypes: {
    turbidity: {
      name: 'Turbidity',
      control: { type: 'range', min: 1, max: 10, step: 0.1 },
      description: '1 is air without aerosols, 2 clear air'
    },
    ozone: {
      name: 'Ozone [DU]',
      control: { type: 'range', min: 0, max: 600, step: 10 },
      description: 'Dobson units'
    },
    groundAlbedo: {
      name: 'Ground albedo',
      control: { type: 'range', min: 0, max: 1, step: 0.01 },
      description: 'Part of the light that the ground reflects'
    },
    altitude: {
      name: 'Camera altitude [km]',
      control: { type: 'range', min: 0, max: 400, step: 0.5 },
      description: 'For the sky volume'
    },
    sunElevation: {
      name: 'Sun elevation [°]',
      control: { type: 'range', min: -18, max: 90, step: 0.5 },
      description: 'For the sky volume'
    },
    exposure: timeArgTypes.exposure,
    ...rendererArgTypes,
    path: { table: { disable: true } }
  },
  args: {
    turbidity: 2,
    ozone: 300,
    groundAlbedo: 0.1,
    altitude: 0.1,
    sunElevation: 30,
    exposure: 0,
    forceWebGL: false,
    path: 'forward',
    frame: false
  }
}

export default meta

export const Tables: StoryObj<TablesArgs> = { tags: ['screenshot'] }

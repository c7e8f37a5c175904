import type { Meta, StoryObj } from '@storybook/html-vite'
import { createImportedModel } from './importedModel.scene'
import type { ImportedModelArgs } from './importedModel.scene'
import { mount } from './mount'
import { rendererArgTypes, timeArgTypes } from './storyArgs'
import { storyCode } from './storyCode'

const code = storyCode(
  ['quickStart.ts', 'quick start'],
  ['importedModel.scene.ts', 'model'],
  ['importedModel.scene.ts', 'lamps']
)

const meta: Meta<ImportedModelArgs> = {
  title: 'An imported model',
  render: mount(createImportedModel, code),
  argTypes: {
    lampsBelow: {
      name: 'Lamps below',
      description: "Sine of the sun's elevation under which lamps are lit",
      control: { type: 'range', min: -0.3, max: 1, step: 0.01 }
    },
    ...timeArgTypes,
    ...rendererArgTypes
  },
  args: {
    day: Date.UTC(2026, 5, 21),
    hour: 10.55,
    exposure: -1,
    lampsBelow: 0.03,
    forceWebGL: false,
    path: 'forward',
    frame: false
  }
}

export default meta

type Story = StoryObj<ImportedModelArgs>

/** Half an hour after sunset the lamps outshine the sky. */
export const Dusk: Story = { tags: ['screenshot'] }

export const Afternoon: Story = { args: { hour: 7 } }

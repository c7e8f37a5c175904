import type { Meta, StoryObj } from '@storybook/html-vite'
import { mount } from './mount'
import { airArgTypes, slider } from './sandbox/argTypes'
import { presetLabels, presets } from './sandbox/presets'
import type { PresetName } from './sandbox/presets'
import { createSandbox } from './sandbox.scene'
import type { SandboxArgs } from './sandbox.scene'
import { rendererArgTypes } from './storyArgs'
import { storyCode } from './storyCode'

const code = storyCode(['sandbox.scene.ts', 'sandbox'])

const degrees = [-90, 90, 0.25] as const
const turn = [-180, 180, 1] as const

const flareArgTypes = (key: 'sunFlare' | 'moonFlare', category: string) => ({
  [`${key}InnerPower`]: slider(category, 'Inner power', [10, 40_000, 10], 'Larger is tighter'),
  [`${key}InnerStrength`]: slider(
    category,
    'Inner strength',
    [0, 0.2, 0.001],
    'Part of its light in the inner lobe'
  ),
  [`${key}OuterPower`]: slider(category, 'Outer power', [2, 4000, 2], 'Larger is tighter'),
  [`${key}OuterStrength`]: slider(
    category,
    'Outer strength',
    [0, 0.2, 0.001],
    'Part of its light in the outer lobe'
  )
})

const meta: Meta<SandboxArgs> = {
  title: 'Sandbox',
  render: mount(createSandbox, code),
  argTypes: {
    preset: {
      name: 'Preset',
      description: 'Sets the sliders of air, planet and sun',
      options: Object.keys(presets),
      control: { type: 'select', labels: presetLabels }
    },
    shown: { table: { disable: true } },
    sunElevation: slider('Sun', 'Elevation [°]', degrees, 'Above the horizon'),
    sunAzimuth: slider('Sun', 'Azimuth [°]', turn, 'From north, clockwise'),
    compensation: slider('Camera', 'Exposure [EV]', [-6, 6, 0.25], 'Over what is metered'),
    ...airArgTypes,
    moonElevation: slider('Moon', 'Elevation [°]', degrees, 'Above the horizon'),
    moonAzimuth: slider('Moon', 'Azimuth [°]', turn, 'From north, clockwise'),
    moonPhase: slider('Moon', 'Phase', [0, 1, 0.01], '0 new, 0.25 first quarter, 0.5 full'),
    moonRadius: slider('Moon', 'Radius [km]', [10, 20_000, 10], 'Its light grows with its area'),
    moonDistance: slider('Moon', 'Distance [1000 km]', [40, 1000, 1], 'From the camera'),
    moonStrength: slider('Moon', 'Strength', [0, 100, 0.1], 'Factor on its light'),
    ...flareArgTypes('sunFlare', "Sun's flare"),
    ...flareArgTypes('moonFlare', "Moon's flare"),
    height: {
      name: 'Height [m]',
      description: 'Above the ground; fly on from there with the mouse, WASD and QE',
      control: { type: 'number', min: 1, max: 1e8 },
      table: { category: 'Camera' }
    },
    heading: slider('Camera', 'Heading [°]', turn, 'From north, clockwise'),
    pitch: slider('Camera', 'Look up [°]', [-89, 89, 1], 'Above the horizontal'),
    ...rendererArgTypes
  },
  args: {
    preset: 'earth',
    shown: 'earth',
    ...presets.earth,
    sunElevation: 12,
    sunAzimuth: -38,
    moonElevation: 26,
    moonAzimuth: -4,
    moonPhase: 0.3,
    moonRadius: 1737,
    moonDistance: 384,
    moonStrength: 1,
    sunFlareInnerPower: 6000,
    sunFlareInnerStrength: 0.006,
    sunFlareOuterPower: 150,
    sunFlareOuterStrength: 0.004,
    moonFlareInnerPower: 12_000,
    moonFlareInnerStrength: 0.02,
    moonFlareOuterPower: 500,
    moonFlareOuterStrength: 0.006,
    compensation: 0,
    height: 2.2,
    heading: 0,
    pitch: 8,
    forceWebGL: false,
    path: 'forward',
    frame: false
  }
}

export default meta

type Story = StoryObj<SandboxArgs>

const preset = (name: PresetName) => ({ preset: name, shown: name, ...presets[name] })

export const Earth: Story = { tags: ['screenshot', 'webgpu-only'] }

/** Mars's air, with sun and moon of the sliders. */
export const Mars: Story = { args: { ...preset('mars'), sunElevation: 25 } }

/** The Earth's sky over a planet of 16 km: its lengths are divided, its scattering multiplied. */
export const SmallPlanet: Story = {
  args: { ...preset('smallPlanet'), height: 40, pitch: -16, sunElevation: 20 }
}

/** A red dwarf stands large and dim in the sky, which is hardly blue. */
export const RedDwarf: Story = { args: { ...preset('redDwarf'), sunElevation: 10 } }

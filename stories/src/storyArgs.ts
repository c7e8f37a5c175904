import type { ArgTypes } from '@storybook/html-vite'
import type { RendererArgs, TimeArgs } from './scene'
import { ANTIALIASING, type PostEffects } from './valley/finish'

/** A choice among things with labels. */
export const choiceOf = (things: Readonly<Record<string, { readonly label: string }>>) => ({
  options: Object.keys(things),
  control: {
    type: 'select' as const,
    labels: Object.fromEntries(Object.entries(things).map(([name, { label }]) => [name, label]))
  }
})

export const timeArgTypes: ArgTypes<TimeArgs> = {
  day: {
    name: 'Date [UTC]',
    control: 'date',
    description: 'Day; its time is the slider below'
  },
  hour: {
    name: 'Time [h UTC]',
    control: { type: 'range', min: 0, max: 24, step: 0.05 },
    description: 'Hour of the day'
  },
  exposure: {
    name: 'Exposure [stops]',
    control: { type: 'range', min: -4, max: 20, step: 0.25 },
    description: '0 suits daylight; one more is twice as bright'
  }
}

export const rendererArgTypes: ArgTypes<RendererArgs> = {
  forceWebGL: {
    name: 'WebGL 2',
    control: 'boolean',
    description: 'Draw with WebGL 2 instead of WebGPU'
  },
  path: {
    name: 'Air',
    options: ['forward', 'post'],
    control: 'inline-radio',
    description: 'Drawn by the materials, or over the finished picture'
  },
  frame: {
    name: 'One frame',
    control: 'boolean',
    description: 'Draw one reproducible frame, without mouse or animation'
  }
}

/** Sliders of light shafts, and of what they depend on. */
export const shaftArgTypes = {
  strength: {
    name: 'Strength',
    control: { type: 'range', min: 0, max: 3, step: 0.05 },
    description: 'Part of the light that shadowed air loses: 1 is physical, 0 has no shafts'
  },
  turbidity: {
    name: 'Haze',
    control: { type: 'range', min: 1, max: 12, step: 0.25 },
    description: 'Turbidity of the air: 1 is clear, 6 thick haze'
  },
  azimuth: {
    name: 'Azimuth [°]',
    control: { type: 'range', min: 0, max: 360, step: 1 },
    description: 'Clockwise from north'
  },
  exposure: {
    name: 'Exposure [stops]',
    control: { type: 'range', min: -4, max: 4, step: 0.25 },
    description: '0 as exposureFor says'
  }
} satisfies ArgTypes

const POST_EFFECTS = { table: { category: 'Post effects' } }

/** Switch of a post effect. */
export const effect = (name: string, description: string): object => ({
  name,
  description,
  control: 'boolean',
  ...POST_EFFECTS
})

/** Switches of post effects. */
export const effectArgTypes: ArgTypes<PostEffects> = {
  antialiasing: {
    name: 'Smooth edges',
    ...choiceOf(ANTIALIASING),
    ...POST_EFFECTS
  },
  occlusion: effect('Ambient occlusion', 'Of the light of the sky alone (GTAO)'),
  localExposure: effect(
    'Local exposure',
    'Land under a bright sky is brighter and the sky darker, as in a print that is dodged and burned'
  ),
  bloom: effect('Bloom', 'A halo about what is bright'),
  depthOfField: effect(
    'Depth of field',
    'Sharp in the middle; the nearer that is, the more is blurred'
  ),
  motionBlur: effect('Motion blur', 'While the camera turns or flies')
}

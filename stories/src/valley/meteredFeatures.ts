import type { MeteredFeature } from './FeatureMeter'
import type { ValleyState } from './Valley'

/** Names of features that are switched by a key of the state of the same meaning. */
const SWITCHED = {
  clouds: 'all clouds',
  mist: 'mist',
  cloudShadows: "clouds' shadows",
  shadows: 'shadows of things',
  shafts: 'light shafts',
  haze: 'haze',
  precipitation: 'rain and snow',
  rainbow: 'rainbow',
  wetGround: 'wet ground and snow cover',
  flashes: 'lightning',
  moon: 'moon',
  moonlight: 'moonlight on the land',
  stars: 'stars',
  milkyWay: 'Milky Way',
  airglow: 'airglow',
  flare: "sun's halo",
  trees: 'trees',
  village: 'village',
  lamps: 'lamps',
  water: 'lake',
  environment: 'sky in the lake',
  reflections: 'reflections',
  occlusion: 'ambient occlusion',
  localExposure: 'local exposure',
  bloom: 'bloom',
  depthOfField: 'depth of field',
  motionBlur: 'motion blur'
} as const satisfies Partial<Record<keyof ValleyState, string>>

/** Features of the valley that are on, and how each is switched off. */
export function meteredFeatures(state: ValleyState): MeteredFeature<Partial<ValleyState>>[] {
  const keys = (Object.keys(SWITCHED) as (keyof typeof SWITCHED)[]).filter(key => state[key])
  const features = keys.map(key => ({ name: SWITCHED[key] as string, off: { [key]: false } }))
  if (state.antialiasing === 'none') return features
  return [...features, { name: 'smooth edges', off: { antialiasing: 'none' } }]
}

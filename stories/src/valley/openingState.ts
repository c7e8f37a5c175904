import type { ValleyState } from './Valley'

/** State in which the story *Valley, all day* opens. */
export const openingState = {
  weather: 'fair' as const,
  latitude: 46,
  season: 0.2,
  hour: 9,
  dayLength: 1200,
  paused: false,
  quality: 'medium' as const,
  clouds: true,
  shafts: true,
  mist: true,
  nightSky: true,
  trees: true,
  village: true,
  water: true,
  antialiasing: 'none' as const,
  occlusion: false,
  bloom: true,
  depthOfField: false,
  motionBlur: false,
  haze: 1,
  twilightSaturation: 1,
  shaftStrength: 1,
  starlight: 1,
  airglow: 1,
  earthshine: 1,
  ambient: 1,
  purkinjeShift: 1
} satisfies ValleyState

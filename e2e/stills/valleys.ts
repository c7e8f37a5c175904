import type { ValleyStill } from './Still'

/** The valley, at hours and in weathers that differ much. */
export const valleys: ValleyStill[] = [
  {
    name: 'valley-morning',
    about: 'mist over the lake, in the shadow of a mountain and in the sun',
    valley: { view: 'slope', hour: 7, weather: 'mist' }
  },
  {
    name: 'valley-day',
    about: 'village, forests in sun and shade of clouds, mountains in the lake',
    valley: { view: 'village', hour: 8 }
  },
  {
    name: 'valley-noon',
    about: 'the lake: waves, sky and mountains in it',
    valley: { view: 'shore', hour: 12 }
  },
  {
    name: 'valley-evening',
    about: 'the last sun on summits and clouds, and in the lake',
    valley: { view: 'shore', hour: 19 }
  },
  {
    name: 'valley-west',
    about: 'the sun goes behind the mountains across the lake, among broken clouds',
    valley: { view: 'west', hour: 18, weather: 'broken' }
  },
  {
    name: 'valley-night',
    about: 'windows of the village, moonlit mountains, stars: dark, not black',
    valley: { view: 'village', hour: 22.5, date: Date.UTC(2026, 8, 26) }
  },
  {
    name: 'valley-moonlight',
    about: 'a full moon high over winter: shadows of mountains, trees and clouds',
    valley: { view: 'slope', hour: 22, date: Date.UTC(2026, 11, 24), weather: 'broken' }
  },
  {
    name: 'valley-moonlit-village',
    about: 'the same before the village: shadows of houses and trees beside the lamps',
    valley: { view: 'village', hour: 23.5, date: Date.UTC(2026, 11, 24) }
  },
  {
    name: 'valley-finish',
    about: 'ambient occlusion about trees and houses',
    valley: { view: 'village', hour: 16, occlusion: true, motionBlur: true }
  },
  {
    name: 'valley-shower',
    about: 'a low sun behind: shafts of rain before mountains with a bow in them, wet ground',
    valley: { view: 'village', hour: 12.3, date: Date.UTC(2026, 10, 1), weather: 'shower' }
  },
  {
    name: 'valley-storm',
    about:
      'dark clouds over the valley in the afternoon, shafts of rain below them, wet ground and roofs',
    valley: { view: 'village', hour: 15, weather: 'storm' }
  },
  {
    name: 'valley-snow',
    about: 'snow on ground and roofs, flakes around the camera, mountains lost in what falls',
    valley: { view: 'village', hour: 11, date: Date.UTC(2026, 11, 19), weather: 'snow' }
  },
  {
    name: 'valley-above',
    about: 'over cumulus among snowy summits, the lake between them',
    valley: { view: 'above', hour: 9 }
  },
  {
    name: 'valley-effects',
    about: 'afternoon with all post effects on',
    valley: {
      view: 'village',
      hour: 16,
      occlusion: true,
      antialiasing: 'traa',
      depthOfField: true,
      motionBlur: true
    }
  },
  {
    name: 'valley-upscaled',
    about: 'morning, added up of frames with a quarter of the pixels',
    valley: { view: 'village', hour: 8, antialiasing: 'taau' }
  }
]

import { readFileSync } from 'node:fs'
import { fileURLToPath } from 'node:url'
import { PNG } from 'pngjs'
import { expect, it } from 'vitest'
import { toneFault, tonesOf } from '../harness/tones'

/** Pictures of stories that expose themselves, which visual tests compare, and luminances for which they do [cd/m²]: a day's, a night's. */
const pictures = {
  'valley-day': 2400,
  'globe-street': 3000,
  'globe-valley': 3000,
  'globe-orbit': 3000,
  'lightshafts-towers': 2000,
  'streetweather-snowfall': 0.6,
  'day-moonrise': 0.01
}

it.each(Object.entries(pictures))(
  '%s is neither clipped nor white nor black',
  (name, luminance) => {
    const file = fileURLToPath(new URL(`../visual/baselines/${name}.png`, import.meta.url))
    const tones = tonesOf(PNG.sync.read(readFileSync(file)).data, 255)
    expect(toneFault(tones, luminance)).toBeUndefined()
  }
)

import type { PNG } from 'pngjs'
import { FIELD_OF_VIEW as SKY_LENS, VIEWS as SKIES, type View } from '../../stories/src/halosViews'
import { BOW_SUN, FIELD_OF_VIEW, VIEWS } from '../../stories/src/rainViews'
import { degreesOf, RINGS, type RingView } from './rings'

/** Rings that a picture is of: how its camera stands to the sun, and least degrees of each. */
interface Subject {
  readonly view: RingView
  readonly least: Partial<Record<keyof typeof RINGS, number>>
}

const viewOf = ({ lens = SKY_LENS, pitch, sun, azimuth }: View): RingView => ({
  fieldOfView: lens,
  pitch,
  sun,
  aside: azimuth
})

const { azimuth, heading, pitch } = VIEWS.bow

/** Subjects by the names of their pictures. */
const subjects: Partial<Record<string, Subject>> = {
  'rain-bow': {
    view: { fieldOfView: FIELD_OF_VIEW, pitch, sun: BOW_SUN, aside: azimuth - heading },
    least: { primary: 72, secondary: 36 }
  },
  'halos-halo': { view: viewOf(SKIES.halo), least: { halo: 220 } }
}

/** Fault of a picture whose subject is not in it; undefined where none is found. */
export function wrongIn(name: string, picture: PNG): string | undefined {
  const subject = subjects[name]
  if (subject === undefined) return undefined
  const missing = Object.entries(subject.least).flatMap(([ring, least]) => {
    const seen = degreesOf(RINGS[ring as keyof typeof RINGS], picture, subject.view)
    return seen < least ? [`${seen}° of its ${ring}, not ${least}°`] : []
  })
  return missing.length > 0 ? `one sees ${missing.join(', ')}` : undefined
}

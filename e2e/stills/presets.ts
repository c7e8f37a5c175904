import type { CloudPresetName } from '@welkin/clouds'
import type { Still } from './Still'

/** View of a preset. */
interface PresetView extends Pick<Still, 'place'> {
  azimuth: number
  pitch: number
  /** Altitude of the camera, default 2 [m]. */
  altitude?: number
}

/** The presets as they are, from the ground; fog from above. */
const presets: Record<CloudPresetName, PresetView> = {
  fairWeather: { azimuth: 330, pitch: 14 },
  stratocumulus: { azimuth: 30, pitch: 14 },
  overcast: { azimuth: 30, pitch: 10 },
  cumulonimbus: { azimuth: 20, pitch: 14, place: { longitude: 139.853, latitude: 35.845 } },
  congestus: { azimuth: 330, pitch: 14 },
  altocumulus: { azimuth: 30, pitch: 24 },
  cirrus: { azimuth: 20, pitch: 18 },
  mixed: { azimuth: 300, pitch: 14 },
  shower: { azimuth: 45, pitch: 12, place: { longitude: 139.853, latitude: 35.845 } },
  nimbostratus: { azimuth: 30, pitch: 7, place: { longitude: 22.3, latitude: 46.7 } },
  snowShower: { azimuth: 110, pitch: 9, place: { longitude: 20.3, latitude: 45.2 } },
  hailstorm: { azimuth: 20, pitch: 10, place: { longitude: 139.853, latitude: 35.845 } },
  fog: { azimuth: 30, pitch: -5, altitude: 750 }
}

/** Suns of the presets: elevation, and azimuth from where the camera looks [°]. */
const suns = {
  aside: { elevation: 42, turn: -80, about: 'form and shading, shadows on the hills' },
  behind: { elevation: 28, turn: 0, about: 'sun behind the clouds: silver linings, dark cores' },
  low: { elevation: 5, turn: 15, about: 'reddened light, long shadows in haze' },
  set: { elevation: -3, turn: 15, about: 'after sunset: only high clouds still have sun' }
}

/** Each preset under each sun. */
export const fromTheGround: Still[] = Object.entries(presets).flatMap(
  ([preset, { place, altitude = 2, ...view }]) =>
    Object.entries(suns).map(([name, { elevation, turn, about }]) => ({
      name: `${preset}-${name}`,
      about,
      clouds: { preset: preset as CloudPresetName },
      altitude,
      sun: { elevation, azimuth: (view.azimuth + turn + 360) % 360 },
      view,
      place,
      // Light of a low sun, or of one ahead, comes through much air, and not where clouds stand before it.
      shafts: elevation < 30 ? (true as const) : undefined,
      land: 'hills' as const
    }))
)

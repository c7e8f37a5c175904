import type { CloudLayerParameters, CloudPrecipitation, CloudPresetName } from '@welkin/clouds'
import type { ValleyState } from '../../stories/src/valley/Valley'
import type { ValleyName } from '../../stories/src/valley/views'

/** A still: what is in it, where the sun stands, and where the camera looks. */
export interface Still {
  name: string
  /** Features to look for. */
  about: string
  /** Preset of clouds; default: a clear sky. */
  clouds?: {
    preset: CloudPresetName
    coverage?: number
    precipitation?: CloudPrecipitation
    /** Other parameters of the first layer. */
    layer?: Partial<CloudLayerParameters>
  }
  /** Effective radius of the clouds' droplets [µm]; default: lobes of fair weather. */
  dropletRadius?: number
  /** Fog about the ground: extinction [1/m], altitude over which it falls to 1/e [m]; radius of its droplets [µm], default: a smooth phase function. */
  fog?: { density: number; falloff: number; dropletRadius?: number }
  /** A flash whose light the picture gathers: its kind, azimuth [°] and distance over the ground [m]. */
  lightning?: { kind: 'ground' | 'cloud'; azimuth: number; distance: number }
  /** Rain all about, in a layer that thins to 1/e over 250 m [mm/h]. */
  rain?: number
  /** Light shafts, of land and clouds, in the light of the sun or of the moon where there is one. */
  shafts?: true
  /** Shadow on the clouds of an aeroplane that the camera looks out of. Needs `shafts`. */
  aeroplane?: true
  /** Elevation and azimuth of a full moon, clockwise from north, whatever the date [°]. */
  moon?: { elevation: number; azimuth: number }
  /** Turbidity of the air; by default that of the standard Earth. */
  turbidity?: number
  planet?: 'mars'
  /** Place of the camera, default Tokyo [°], and its altitude above the ellipsoid [m]. */
  place?: { longitude: number; latitude: number }
  altitude: number
  /** Elevation and azimuth of the sun, clockwise from north [°]; or a date, which sets moon and stars too. */
  sun: { elevation: number; azimuth: number } | Date
  /** Azimuth, clockwise from north, and pitch of the camera [°]. */
  view: { azimuth: number; pitch: number }
  /** Vertical field of view [°]; default 55. */
  fieldOfView?: number
  /** True where black space fills most of the picture. */
  inSpace?: true
  /** Exposure over what is metered [EV]: for a part of the picture. */
  compensation?: number
  /** Hills and trees about the camera, the same under snow, towers and streets, or the bare planet. */
  land: 'hills' | 'snow' | 'ridge' | 'city' | 'planet'
}

/** A still of the story *Valley, all day*: a view, and what differs from how the story opens. */
export interface ValleyStill {
  name: string
  /** Features to look for. */
  about: string
  valley: { view: ValleyName } & Partial<ValleyState>
}

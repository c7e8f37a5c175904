import type { LightSource } from '@welkin/atmosphere'
import type { CloudField } from '../../density/CloudField'
import type { WeatherMap } from '../../density/WeatherMap'
import type { CloudSample } from '../../density/tsl/sample'
import type { WeatherCache } from '../../density/tsl/sampler'
import type { QualityUniforms } from '../../march/quality'
import type { LayersAt } from '../../march/tsl/layerBoundaries'
import type { CloudShadows } from '../../shadow/tsl/sampleShadows'
import type { Bool, Float, Vec3 } from '../../tsl-types'
import type { CloudLight } from '../CloudLightTable'

/** Inputs of shading that are the same for all rays of a picture. */
export interface ShadingContext {
  readonly field: CloudField
  /** Weather around the camera; left out, it is looked up at each place itself. */
  readonly weatherMap?: WeatherMap
  readonly light: CloudLight
  readonly shadows: CloudShadows
  readonly quality: QualityUniforms
}

/** Place in the clouds that is to be shaded. */
export interface ShadedSample {
  readonly sample: CloudSample
  readonly weather: WeatherCache
  /** Direction of the view ray on which it is seen, unit length, in the mapped space. */
  readonly direction: Vec3
  /** Transmittance of the clouds between it and the camera, in [0, 1]. */
  readonly transmittance: Float
  /** Transmittance between the camera and the far side of the cloud that it is in, in [0, 1]. */
  readonly past: Float
  /** Part of the light that casters besides the clouds leave, in [0, 1]; left out, all. */
  readonly lit?: Float
  /** The layers around it. */
  readonly layers: Pick<LayersAt, 'base' | 'top' | 'layered' | 'density'>
}

/** Light source that clouds are shaded for: sun or moon. */
export interface ShadingLight {
  /** Direction to it, unit length, in the mapped space. */
  readonly direction: Vec3
  readonly isMoonlit: Bool
  /** 1 if the shadow maps are of this light, else 0. */
  readonly isMapped: Float
  /** Cosine between it and the zenith. */
  readonly cosine: Float
}

/** Something besides the clouds that shades them, in one light. */
export interface CloudCaster {
  /** Grows whenever its shader changes. */
  readonly version: number
  /** The light: sun or moon. */
  readonly source: LightSource
  /**
   * Part of the light that passes, in [0, 1].
   *
   * @param ray - View ray of the clouds' camera; noise in (0, 1).
   * @param distance - Distance from the camera [m].
   */
  litAt(ray: { direction: Vec3; jitter: Float }, distance: Float): Float
}

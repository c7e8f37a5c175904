import type { Vector3 } from 'three'
import type { NodeFrame, Renderer } from 'three/webgpu'
import { fail } from '@welkin/geo'
import type { Spectrum } from '../parameters/AtmosphereParameters'
import type { AtmosphereView, ViewedAtmosphere } from './AtmosphereView'
import type { LightSource } from './LightSource'
import type { Bool, Float, Vec3, Vec4 } from '../tsl-types'
import type { MediumSegment, VolumeSegment } from '../skyVolume/tsl/skyVolume'
import type { ViewRay } from '../skyVolume/tsl/viewRay'
import type { ViewUniforms } from './ViewUniforms'

/** Air this many times as bright as something faint in the sky hides it: less than half a grey level. */
export const MASKING_RATIO = 10_000

/** View ray into the sky, as shader nodes. */
export interface SkyRay extends Readonly<ViewRay> {
  /** Uniforms and tables of the camera's view. */
  readonly view: ViewUniforms
  /** Unit length, in the mapped space. */
  readonly direction: Vec3
  /** ν, against the source of light. */
  readonly cosViewLight: Float
  /** True if there is air in this direction. */
  readonly meetsAir: Bool
  /** Angle that a pixel covers [rad]. */
  readonly pixel: Float
  /** Light of the air and of layers in it so far: what is far fainter need not be drawn. */
  readonly airlight: Vec4
}

/** View ray to a point, or into the sky as far as ground or air go, as shader nodes. */
export interface LayerRay extends Pick<SkyRay, 'view' | 'direction' | 'cosView' | 'cosViewLight'> {
  /** Distance to a point [m]; absent for the sky. */
  readonly distance?: Float
  /** True if the planet is in the way of the sky. */
  readonly hitsGround?: Bool
  /** Look-up of the sky volumes up to the point; absent where they are not sampled. */
  readonly segment?: VolumeSegment
}

/** Distance from which on shadows take a ray for one into the sky, or to the planet that is drawn with it [m]. */
export const SKY_DISTANCE = 1e9

/** A layer's medium on a view ray, for shadows that fall into it. Light is for unit irradiance of their source [1/sr]. */
export interface ShadowedMedium {
  /** Distance up to which the air's light is in front of the medium [m]. */
  readonly front: Float
  /** Part of the light from farther away that passes the medium, in [0, 1]. */
  readonly transmittance: Float
  /** Part of the air's light that is in front of it, given the optical depth of the air on the ray; absent for none. */
  readonly ahead?: (depth: Vec4) => Vec4
  /** Light that it adds, scattered once; null where the source does not light it: then it only dims. */
  readonly singleScattered: Vec4 | null
  /** Light that it adds, scattered more often than once. */
  readonly multiplyScattered: Vec4
  /** Distance up to which it has added a part of its light, given in [0, 1] [m]. */
  distanceAt(part: Float): Float
}

/** View ray to a point, with the part of the sky volumes up to it. */
export interface PointRay extends LayerRay {
  /** Distance to the point [m]. */
  readonly distance: Float
  /** Look-up of the sky volumes up to it. */
  readonly segment: VolumeSegment
}

/**
 * Something in the sky besides air and sun: moon, stars, airglow. `atmosphere.add(layer)` shows it in
 * every node that draws this atmosphere's sky and haze.
 *
 * All light is radiance over `solarIrradiance` at the four wavelengths [1/sr], as sunlight that a white
 * plane reflects is.
 */
export interface SkyLayer {
  /** True if {@link background} only adds light and hides nothing. */
  readonly isAdditive?: boolean
  /** Called before it is added. @throws If it cannot be added to this atmosphere. */
  attach?(atmosphere: ViewedAtmosphere): void
  /** The light that it sends to the planet, if it lights more than its own picture. */
  readonly source?: LightSource
  /** Part of the sun's light that it leaves at a position in world space. */
  eclipse?(position: Vector3): Spectrum
  /**
   * Counts changes of settings that light other than {@link background} depends on: what is drawn once and kept, such as environment maps,
   * is drawn again. Changes that follow camera, sun and date do not count.
   */
  readonly version?: number
  /** Bakes what the layer needs. Called before a render; of a frame, unless what is drawn is kept. */
  prepare?(renderer: Renderer, view: AtmosphereView, frame?: NodeFrame): void
  /** Sets uniforms for the camera that renders. */
  update?(view: AtmosphereView): void
  /**
   * Background: light from beyond the air, given what is farther; the air dims what is returned.
   * Called inside a branch in which the ray does not hit the ground: no derivatives.
   */
  background?(ray: SkyRay, farther: Vec4): Vec4
  /**
   * Sunlight scattered by the air up to the ground, and by the ground, given the model's, of even albedo; returns what is given where the
   * ray misses the ground. Before `glow`; no derivatives.
   */
  ground?(ray: SkyRay, model: Vec4): Vec4
  /** Light of all the air in this direction, given that without this layer. */
  glow?(ray: SkyRay, without: Vec4): Vec4
  /**
   * Light of the layer that the air below it and the ground scatter to the camera. `isSeen` tells where it shows; `light`, given the air's
   * transmittance, is called in branches in which that or something beyond the air shows.
   */
  below?(ray: SkyRay): { isSeen: Bool; light: (transmittance: Vec4) => Vec4 }
  /** In-scattered light between the viewpoint and a point, given that without this layer. */
  inScatter?(ray: PointRay, without: Vec4): Vec4
  /** Factor by which {@link medium} multiplies the optical depth of the air, if it does nothing else: shadows follow it. */
  readonly airDensity?: Float
  /** Medium along a ray, in front of the sky too, given what air and layers before are. */
  medium?(ray: LayerRay, air: MediumSegment): MediumSegment
  /** True if its medium is not in front of the sky. */
  readonly leavesSky?: boolean
  /** Light of the sky as the layer shows it, for a medium after it that is drawn in that light: `distanceFog`. */
  skyLight?(light: Vec4): Vec4
  /** Extinction of its medium at the camera, as of the last {@link update} [1/m]. */
  readonly extinction?: number
  /**
   * Its medium as shadows see it, in the light of the source of `ray.view`; null if it is none in that light.
   *
   * @param ray - View ray, to {@link SKY_DISTANCE} or farther for the sky.
   * @param isSun - True if that source is the atmosphere's sun.
   */
  shadowed?(ray: LayerRay & { distance: Float }, isSun: boolean): ShadowedMedium | null
  /** Frees GPU memory. */
  dispose?(): void
}

/** Members of which a layer needs one at least: nothing else changes the sky. */
const EFFECTS = ['eclipse', 'background', 'ground', 'glow', 'below', 'inScatter', 'medium'] as const

/** @throws If it is no layer. */
export function checkLayer(where: string, layer: SkyLayer): void {
  if (!EFFECTS.some(name => typeof layer?.[name] === 'function')) {
    fail(where, 'layer must be a SkyLayer or forwardShafts()', layer)
  }
}

import type { Camera, RenderTarget } from 'three'
import type { Renderer } from 'three/webgpu'
import type { Atmosphere } from '../Atmosphere'
import type { Float, Vec3, Vec4 } from '../tsl-types'
import type { AirShadows } from '../view/AirShadows'
import type { AtmosphereView } from '../view/AtmosphereView'
import type { ViewUniforms } from '../view/ViewUniforms'
import type { ParallelLight } from './shadowMaps'

/**
 * A point in the air that a camera looks through, as shader nodes.
 *
 * Its place is in the mapped space: metres along the axes of ECEF (x to the equator at 0° E, z to the north pole), of which each
 * is scaled so that the planet's ellipsoid is a sphere of radius `parameters.bottomRadius`, for Earth by 0.3 % at most.
 */
export interface AirPoint {
  /** The camera's view in the light whose shadow it is; `view.localCoordinates(offset)` has altitude and zenith. */
  readonly view: ViewUniforms
  /** Displacement from the camera, in the mapped space, and its length [m]. */
  readonly offset: Vec3
  readonly distance: Float
  /** Position in world space [world units]. */
  readonly positionWorld: () => Vec3
  /** Noise in (0, 1), for what is read in steps. */
  readonly jitter: Float
}

/** A view ray through the air, as shader nodes. */
export interface AirViewRay extends Pick<AirPoint, 'view' | 'jitter'> {
  /** Unit length, in the mapped space. */
  readonly direction: Vec3
  /** Receiver of the light on the ray, if that is not air: its own shadow does not count. */
  readonly receiver?: object
}

/** Light shafts as what casts shadows into them sees them. */
export interface ShadowedShafts extends AirShadows {
  readonly atmosphere: Atmosphere
  /** Camera whose picture has the shafts. */
  readonly camera: Camera
  /** Light whose shadows fall into the air. */
  readonly light: ParallelLight
  /** True if there are shadows to be drawn, as of the last `prepare` for the camera. */
  readonly isActive: boolean
  /** Grows whenever shaders with {@link litAt} must be compiled anew. */
  readonly version: number
  /**
   * Part of the light that arrives at a place on a view ray of the camera, in [0, 1], for what takes light there, such as
   * clouds: past the shadow maps of the light and all that was added. To be called within a shader function.
   *
   * @param distance - Distance from the camera [m].
   */
  litAt(ray: Omit<AirViewRay, 'view'>, distance: Float): Float
}

/** Rows of a half-float texture that has something else besides: a shader that reads both samples one texture. */
export interface SharedRows {
  /** Undefined once it has been disposed of. */
  readonly target: RenderTarget | undefined
  /** First row, and how many there are [texels]. */
  readonly first: number
  readonly count: number
}

/** Shadow that something casts into the air, in one light. */
export interface AirShadow {
  /** False while there is nothing that takes light; left out, there always may be. */
  readonly isCast?: boolean
  /** Sets uniforms, and draws tables, for the camera whose air it is. Called before it is drawn. */
  update?(view: AtmosphereView, renderer: Renderer): void
  /**
   * Part of the light that arrives at places of a view ray, in [0, 1]: 1 where there is no shadow. Called once for each ray;
   * the function that it returns is called in a loop and in branches.
   */
  transmittance(ray: AirViewRay): (place: AirPoint) => Float
  /**
   * Diffuse light at a place, which air scatters again, over that without this occluder, at the four wavelengths [–]:
   * less under clouds that are thick, more under thin ones and above them. Left out, 1.
   */
  diffuse?(point: AirPoint): Vec4
  /** Makes room in its own texture for what materials read that draw the shafts. Left out, they sample one texture more. */
  makeRoom?(): SharedRows
  /** Frees what it has drawn, which is drawn again at the next `update`: called when the shafts are disposed of. */
  free?(): void
  /** Called when it is taken out. */
  dispose?(): void
}

/**
 * Something that casts shadows into the air by a rule of its own, such as clouds or the hills of a terrain:
 * see `LightShafts.add`.
 */
export interface AirOccluder {
  /** Called when it is added. @throws If it cannot be added to these shafts. */
  castInto(shafts: ShadowedShafts): AirShadow
}

import { Matrix3, Vector3 } from 'three'
import type { Camera } from 'three'
import type { Renderer } from 'three/webgpu'
import type { Ellipsoid } from '@welkin/geo'
import type { AtmosphereParameters, Spectrum } from '../parameters/AtmosphereParameters'
import { viewpointScalars } from './cpu/viewpoint'
import type { SphericalSpace } from './cpu/spherical'
import type { Air } from '../scattering/tsl/ray'
import type { LightSource } from './LightSource'
import type { SkyVolumes, VolumeOrigins } from '../skyVolume/SkyVolumes'
import type { Vec4 } from '../tsl-types'
import type { ViewpointScalars } from './tsl/viewpoint'

/** Cosine of the source's zenith angle, 25° below the horizon. */
const DEEP_NIGHT = -0.42

const _position = new Vector3()
const _direction = new Vector3()

/** Part of an atmosphere that a camera's view and layers of the sky read. */
export interface ViewedAtmosphere {
  readonly parameters: AtmosphereParameters
  readonly ellipsoid: Ellipsoid
  readonly date: Date | null
  /** World space to the space in which the planet is a sphere. */
  readonly space: SphericalSpace
  /** Layers of the sky, as far as they light the planet. */
  readonly layers: readonly { readonly source?: LightSource; skyLight?(light: Vec4): Vec4 }[]
  /** `version` is 0 until the first bake is done. */
  readonly tables: {
    readonly version: number
    readonly volumes: Pick<SkyVolumes, 'volumeFor'>
    readonly air: Air
  }
}

/** A camera in the space where the planet is a sphere, computed in float64. */
export class AtmosphereView {
  /** Height above the ground, which may be negative [m]. */
  height = 0
  /** Zenith, unit length. */
  readonly up = new Vector3()
  /** Direction to the source of light, unit length. */
  readonly lightDirection = new Vector3()
  /** Displacements in view space [world units] to the mapped space [m]. */
  readonly viewToMapped = new Matrix3()
  /** Irradiance of the source, over the bare sun's. */
  irradiance: Spectrum = [1, 1, 1, 1]
  /** True if the source can light any air that is seen. */
  isLit = true
  viewpoint: ViewpointScalars<number> | null = null
  /** Its sky volume; null if there is none. */
  volume: VolumeOrigins | null = null
  readonly atmosphere: ViewedAtmosphere
  readonly camera: Camera
  readonly source: LightSource

  constructor(atmosphere: ViewedAtmosphere, camera: Camera, source: LightSource) {
    this.atmosphere = atmosphere
    this.camera = camera
    this.source = source
  }

  /** Follows the camera, and sees that there is a sky volume for it. */
  update(renderer: Renderer): void {
    const { space, parameters, tables } = this.atmosphere
    const { matrixWorld } = this.camera
    space.position(_position.setFromMatrixPosition(matrixWorld), this.up)
    const radius = this.up.length()
    this.height = radius - parameters.bottomRadius
    // At the very centre any direction is up.
    if (radius > 0) this.up.divideScalar(radius)
    else this.up.set(0, 0, 1)
    this.irradiance = this.source.irradianceAt(_position)
    this.source.direction(_direction, _position)
    space.direction(_direction, this.lightDirection)
    space.displacement(matrixWorld, this.viewToMapped)
    const cosLight = Math.min(Math.max(this.up.dot(this.lightDirection), -1), 1)
    // From inside the air a line of sight gets 16° nearer to the sun at most, where dusk ends at −9°.
    this.isLit = cosLight > DEEP_NIGHT || radius > parameters.topRadius
    // Then only the depth of the air counts, which one volume holds for all the night.
    this.viewpoint = viewpointScalars(parameters, this.height, this.isLit ? cosLight : DEEP_NIGHT)
    // Before the first bake is done there is no light to compute a volume from.
    if (tables.version === 0 || !this.source.lightsAir) return
    this.volume = tables.volumes.volumeFor(renderer, this.viewpoint, tables.version)
  }
}

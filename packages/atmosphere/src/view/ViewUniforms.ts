import type { Camera } from 'three'
import { offsetPoint } from '@welkin/geo'
import { matrix3, number, vector3 } from '../uniforms'
import type { AtmosphereTables } from '../tables/AtmosphereTables'
import { ViewpointUniforms } from '../skyVolume/SkyVolumes'
import type { Air } from '../scattering/tsl/ray'
import type { Texels } from '../tables/TableAtlas'
import type { Float, Mat3, Vec3 } from '../tsl-types'
import type { AtmosphereView } from './AtmosphereView'
import type { ViewpointScalars } from './tsl/viewpoint'
import type { LightSource } from './LightSource'

/** Uniforms and textures of an atmosphere as a camera sees it in the light of one source. */
export class ViewUniforms {
  readonly source: LightSource
  /** Camera of the view; null for whichever renders. */
  readonly camera: Camera | null
  readonly air: Air
  /** Atlas of its sky volumes. */
  readonly volume: Texels
  readonly viewpoint = new ViewpointUniforms()
  /** Height of the camera above the ground, which may be negative [m]. */
  readonly height = number()
  /** 1 where light of the source can reach what the camera sees of the air, 0 deep in the night. */
  readonly isLit = number(1)
  /** Zenith at the camera, in the mapped space. */
  readonly up = vector3()
  /** Direction to the source, in the mapped space. */
  readonly lightDirection = vector3()
  /** Displacements in view space [world units] to the mapped space [m]. */
  readonly viewToMapped = matrix3()

  constructor(tables: AtmosphereTables, source: LightSource, camera: Camera | null) {
    this.source = source
    this.camera = camera
    this.air = tables.air
    this.volume = tables.atlas
  }

  /** Takes the values of a view. */
  protected set(view: AtmosphereView, viewpoint: ViewpointScalars<number>): void {
    this.viewpoint.set(viewpoint, view.volume)
    this.source.irradiance.value.set(...view.irradiance)
    this.height.value = view.height
    this.isLit.value = view.isLit ? 1 : 0
    this.up.value.copy(view.up)
    this.lightDirection.value.copy(view.lightDirection)
    this.viewToMapped.value.copy(view.viewToMapped)
  }

  /** A displacement in view space [world units] in the mapped space [m]. */
  toMapped(displacementView: Vec3): Vec3 {
    return (this.viewToMapped as unknown as Mat3).mul(displacementView)
  }

  /**
   * Local coordinates of a point: altitude [m], cosine between the light and the zenith, zenith in the mapped space.
   *
   * @param offset - Displacement from the camera, in the mapped space [m].
   */
  localCoordinates(offset: Vec3): { altitude: Float; cosLight: Float; up: Vec3 } {
    const { bottomRadius, thickness } = this.air.uniforms
    const { height, up } = offsetPoint(offset, this.up, this.height, bottomRadius)
    return {
      altitude: height.clamp(0, thickness).toConst(),
      cosLight: up.dot(this.lightDirection).clamp(-1, 1).toConst(),
      up
    }
  }
}

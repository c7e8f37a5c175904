import { Matrix3, Vector3 } from 'three'
import type { Camera } from 'three'
import { renderGroup, uniform } from 'three/tsl'
import type { NodeFrame, UniformNode } from 'three/webgpu'
import { fail } from '@welkin/geo'
import type { Atmosphere } from '../Atmosphere'
import type { AtmosphereView } from './AtmosphereView'
import type { LightSource } from './LightSource'
import { EyeUniforms } from '../skyVolume/SkyVolumes'
import type { Air } from '../scattering/tsl/scattering'
import type { Texels } from '../tables/TableAtlas'
import type { Float, Mat3, Vec3 } from '../tsl-types'

const vector = (): UniformNode<'vec3', Vector3> => uniform(new Vector3()).setGroup(renderGroup)

/** An atmosphere as seen from a camera in the light of one source: the uniforms and textures that shaders of a view share. */
export class ViewNodes {
  readonly atmosphere: Atmosphere
  readonly source: LightSource
  readonly air: Air
  /** Where its sky volumes are kept. */
  readonly volume: Texels
  readonly eye = new EyeUniforms()
  /** Height of the camera above the ground, which may be negative [m]. */
  readonly height = uniform(0).setGroup(renderGroup)
  /** 1 where light of the source can reach what the camera sees of the air, 0 deep in the night. */
  readonly isLit = uniform(1).setGroup(renderGroup)
  /** Zenith at the camera, in the mapped space. */
  readonly up = vector()
  /** Direction to the source, in the mapped space. */
  readonly sunDirection = vector()
  /** Displacements in view space [world units] to the mapped space [m]. */
  readonly viewToMapped = uniform(new Matrix3()).setGroup(renderGroup)
  /** Whose view it is; null for whichever renders. */
  readonly camera: Camera | null

  /** @param camera - The camera; null for whichever renders. */
  constructor(atmosphere: Atmosphere, camera: Camera | null, source: LightSource) {
    this.atmosphere = atmosphere
    this.source = source
    this.camera = camera
    this.air = atmosphere.tables.air
    this.volume = atmosphere.tables.atlas
  }

  /** Bakes what the camera that renders needs. To be called before a render starts. */
  prepare(frame: NodeFrame): AtmosphereView | undefined {
    const camera = this.camera ?? frame.camera
    if (frame.renderer === null || camera === null) return undefined
    return this.atmosphere.update(frame.renderer, camera, this.source)
  }

  /** Sets the uniforms for the camera that renders. */
  update(frame: Pick<NodeFrame, 'camera'>): AtmosphereView | undefined {
    const camera = this.camera ?? frame.camera
    const view = camera === null ? undefined : this.atmosphere.viewOf(camera, this.source)
    if (view === undefined || view.eye === null) return undefined
    this.eye.set(view.eye, view.volume)
    this.source.irradiance.value.set(...view.irradiance)
    this.height.value = view.height
    this.isLit.value = view.isLit ? 1 : 0
    this.up.value.copy(view.up)
    this.sunDirection.value.copy(view.sunDirection)
    this.viewToMapped.value.copy(view.viewToMapped)
    return view
  }

  /** A displacement in view space [world units] in the mapped space [m]. */
  toMapped(displacementView: Vec3): Vec3 {
    return (this.viewToMapped as unknown as Mat3).mul(displacementView)
  }

  /**
   * Altitude and sun of a point, without cancellation: h' = h + (2 r d·up + d²)/(r' + r).
   *
   * @param offset - From the camera, in the mapped space [m].
   */
  place(offset: Vec3): { altitude: Float; cosSun: Float; up: Vec3 } {
    const { bottomRadius, thickness } = this.air.uniforms
    const radius = bottomRadius.add(this.height).toConst()
    const rise = offset.dot(this.up).mul(radius).mul(2).add(offset.dot(offset)).toConst()
    const radiusThere = radius.mul(radius).add(rise).max(1).sqrt().toConst()
    const altitude = this.height.add(rise.div(radiusThere.add(radius))).clamp(0, thickness)
    const up = this.up.mul(radius).add(offset).div(radiusThere).toConst()
    return {
      altitude: altitude.toConst(),
      cosSun: up.dot(this.sunDirection).clamp(-1, 1).toConst(),
      up: up
    }
  }
}

/** @throws If it is no atmosphere. */
export function checkAtmosphere(where: string, value: Atmosphere): void {
  if (!value?.isAtmosphere) fail(where, 'atmosphere must be an Atmosphere', value)
}

const shared = new WeakMap<LightSource, WeakMap<object, ViewNodes>>()

/** The nodes of an atmosphere for a camera and a source of light, made once. */
export function viewNodes(
  atmosphere: Atmosphere,
  camera: Camera | null = null,
  source: LightSource = atmosphere.sun
): ViewNodes {
  const key = camera ?? atmosphere
  let views = shared.get(source)
  if (views === undefined) shared.set(source, (views = new WeakMap()))
  let view = views.get(key)
  if (view === undefined) views.set(key, (view = new ViewNodes(atmosphere, camera, source)))
  return view
}

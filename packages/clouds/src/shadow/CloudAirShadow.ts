import type {
  AirOccluder,
  AirPoint,
  AirViewRay,
  AirShadow,
  AtmosphereView,
  LightSource,
  ScreenShadows,
  ShadowedShafts,
  SharedRows
} from '@welkin/atmosphere'
import { fail } from '@welkin/geo'
import { If, float } from 'three/tsl'
import type { Renderer } from 'three/webgpu'
import { checkClouds } from '../check'
import { viewpointMapped } from '../density/CloudField'
import { meanDepthTowards, opticalDepthTowards } from '../density/tsl/columns'
import { decksAround } from '../environment/tsl/decks'
import { diffuseRatio } from '../environment/tsl/overcast'
import type { CloudsNode } from '../march/CloudsNode'
import type { CloudCaster } from '../light/tsl/shadingContext'
import type { Float, Vec3, Vec4 } from '../tsl-types'
import { number, vector3 } from '../uniforms'
import { CloudForeground } from './CloudForeground'
import { DiffuseRatioTable } from './DiffuseRatioTable'
import { sampleShadowsAlong } from './tsl/sampleShadows'

/** Shadow of clouds in the air, in one light: the part of it that arrives. */
class CastShadow implements AirShadow, CloudCaster {
  readonly #clouds: CloudsNode
  readonly #shafts: ShadowedShafts
  readonly #foreground: CloudForeground
  readonly #diffuse: DiffuseRatioTable
  /** The shafts as the clouds' node draws them, where both have the same camera. */
  readonly #screen: ScreenShadows | undefined
  /** Displacement from the clouds' camera, as their maps know it, to that of the shafts [m]. */
  readonly #shift = vector3()
  #room: SharedRows | undefined
  /** 1 while the maps are of the shafts' light. */
  readonly #isMapped = number(1)

  /** @throws If the clouds are of another atmosphere. */
  constructor(clouds: CloudsNode, shafts: ShadowedShafts) {
    if (shafts.atmosphere !== clouds.atmosphere)
      fail('CloudAirShadow', 'atmosphere must be that of the light shafts', clouds.atmosphere)
    this.#clouds = clouds
    this.#shafts = shafts
    this.#foreground = new CloudForeground(clouds)
    this.#diffuse = new DiffuseRatioTable(clouds.shadows, clouds.light.nodes)
    clouds.castsInto.add(shafts)
    if (shafts.camera !== clouds.camera) return
    this.#screen = shafts.upTo(clouds.depthNode, this.#foreground)
    clouds.screens.add(this.#screen)
    clouds.casters.add(this)
    clouds.needsUpdate = true
  }

  get isCast(): boolean {
    const { isDisposed, field } = this.#clouds
    const casts = [...field.layers].some(
      ({ parameters }) => parameters.shadow && parameters.coverage > 0
    )
    return !isDisposed && field.fadeIn > 0 && casts
  }

  update(view: AtmosphereView, renderer: Renderer): void {
    const { field, shadows } = this.#clouds
    this.#isMapped.value = shadows.source === this.#shafts.source ? 1 : 0
    viewpointMapped(view, this.#shift.value).sub(shadows.camera)
    // Other occluders may cast where these clouds do not: their shaders read the table, too.
    if (field.worldMap === null && !this.#clouds.isDisposed) this.#diffuse.update(renderer)
  }

  makeRoom(): SharedRows {
    const { shadows } = this.#clouds
    return (this.#room ??= shadows.left.pop() ?? shadows.makeRoom())
  }

  get version(): number {
    return this.#shafts.version
  }

  get source(): LightSource {
    return this.#shafts.source
  }

  litAt(ray: Pick<AirViewRay, 'direction' | 'jitter'>, distance: Float): Float {
    return this.#shafts.litAt({ ...ray, receiver: this.#clouds }, distance)
  }

  transmittance(ray: AirViewRay): (place: AirPoint) => Float {
    const { field, light, shadows } = this.#clouds
    const { view, direction, jitter, receiver } = ray
    if (receiver === this.#clouds) return () => float(1)
    const mapped = sampleShadowsAlong(shadows.nodes, this.#shift, direction, jitter)
    // After sunset light has passed its lowest place, with what clouds are there, far beyond the maps.
    const isFar = view.viewpoint.cosLight.lessThan(0).toConst()
    return ({ offset, distance }) => {
      const { shadow, inMap } = mapped(distance)
      const depth = shadow.mul(this.#isMapped).toVar()
      If(inMap.mul(this.#isMapped).equal(0).or(isFar), () => {
        const { altitude, cosLight, up } = view.localCoordinates(offset)
        let mean: Float
        if (field.worldMap === null) mean = meanDepthTowards(field, altitude, cosLight)
        else {
          const shifted = offset.add(this.#shift).toConst() as Vec3
          const seen = shifted.length().toConst() as Float
          const sample = { offset: shifted, altitude, up, distance: seen }
          mean = opticalDepthTowards(field, sample, view.lightDirection)
        }
        depth.assign(depth.max(mean))
      })
      // What is scattered within the forward peak arrives with the sun.
      return depth.mul(light.nodes.depthScale).negate().exp()
    }
  }

  diffuse({ view, offset }: AirPoint): Vec4 {
    const { field, light, shadows } = this.#clouds
    const { altitude, cosLight, up } = view.localCoordinates(offset)
    if (field.worldMap === null) return this.#diffuse.sample(altitude, cosLight)
    const shifted = offset.add(this.#shift).toConst() as Vec3
    const decks = decksAround(field, light.nodes, shifted, altitude, up, cosLight, shadows.falling)
    return diffuseRatio(view, decks, altitude, cosLight)
  }

  dispose(): void {
    this.#diffuse.dispose()
    this.#clouds.castsInto.delete(this.#shafts)
    if (this.#room) this.#clouds.shadows.left.push(this.#room)
    this.#foreground.isRemoved = true
    if (this.#screen === undefined) return
    this.#clouds.screens.delete(this.#screen)
    this.#clouds.casters.delete(this)
    this.#screen.dispose?.()
    this.#clouds.needsUpdate = true
  }
}

/**
 * Shadows of clouds in the air, for light shafts.
 *
 * ```ts
 * shafts.add(cloudAirShadow(cloudsNode)) // before the first render, or set pipeline.needsUpdate
 * ```
 *
 * They are read from the clouds' shadow maps, up to 2,000 km above the ground; beyond them the mean cover of the layers says how much passes, or the
 * weather if there is a map of the world. Shafts of the clouds' camera are drawn by the clouds' node then, before and
 * behind the clouds, and all else that casts into them shades the clouds, too: the light's shadow maps, and hills.
 */
export class CloudAirShadow implements AirOccluder {
  /** Shared, not owned. */
  readonly clouds: CloudsNode

  /** @throws If the clouds are missing. */
  constructor(clouds: CloudsNode) {
    checkClouds('CloudAirShadow', clouds)
    this.clouds = clouds
  }

  /** Called by `LightShafts.add`. @throws If the shafts are of another atmosphere. */
  castInto(shafts: ShadowedShafts): AirShadow {
    return new CastShadow(this.clouds, shafts)
  }
}

/** Shadows of clouds in the air: see {@link CloudAirShadow}. */
export const cloudAirShadow = (clouds: CloudsNode): CloudAirShadow => new CloudAirShadow(clouds)

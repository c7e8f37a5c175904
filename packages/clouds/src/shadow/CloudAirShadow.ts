import type { AirPlace, AirShadow, AtmosphereView, ShadowedShafts } from '@welkin/atmosphere'
import { fail } from '@welkin/geo'
import { If } from 'three/tsl'
import { viewpointMapped, type CloudField } from '../density/CloudField'
import { meanDepthTowards, opticalDepthTowards } from '../density/tsl/columns'
import { decksAround, meanDecks } from '../environment/tsl/decks'
import { diffuseRatio } from '../environment/tsl/overcast'
import type { CloudLight } from '../light/CloudLightTable'
import type { Float, Vec3, Vec4 } from '../tsl-types'
import { number, vector3 } from '../uniforms'
import type { CloudShadowMap } from './CloudShadowMap'
import { sampleShadows } from './tsl/sampleShadows'

/** Clouds as their shadow needs them: a `CloudsNode`. */
interface ShadowingClouds {
  readonly field: CloudField
  readonly light: { readonly nodes: CloudLight }
  readonly shadows: CloudShadowMap
  readonly isDisposed: boolean
}

/**
 * Shadow of clouds in the air: the part of the light of sun or moon that arrives. It is read from the shadow
 * maps; beyond them the mean cover of the layers says how much passes, or the weather if there is a map of the world.
 */
export class CloudAirShadow implements AirShadow {
  readonly #clouds: ShadowingClouds
  readonly #shafts: ShadowedShafts
  /** Called when it is taken out. */
  onDispose: (() => void) | null = null
  /** Displacement from the clouds' camera, as their maps know it, to that of the shafts [m]. */
  readonly #shift = vector3()
  /** 1 while the maps are of the shafts' light. */
  readonly #isMapped = number(1)

  /** @throws If the clouds are of another atmosphere. */
  constructor(clouds: ShadowingClouds, shafts: ShadowedShafts) {
    if (shafts.atmosphere !== clouds.field.atmosphere)
      fail('CloudsNode', 'atmosphere must be that of the light shafts', clouds.field.atmosphere)
    this.#clouds = clouds
    this.#shafts = shafts
  }

  get isCast(): boolean {
    const { isDisposed, field } = this.#clouds
    const casts = [...field.layers].some(
      ({ parameters }) => parameters.shadow && parameters.coverage > 0
    )
    return !isDisposed && field.fadeIn > 0 && casts
  }

  update(view: AtmosphereView): void {
    const { shadows } = this.#clouds
    this.#isMapped.value = shadows.source === this.#shafts.source ? 1 : 0
    viewpointMapped(view, this.#shift.value).sub(shadows.camera)
  }

  transmittance({ view, offset, jitter }: AirPlace): Float {
    const { field, light, shadows } = this.#clouds
    const shifted = offset.add(this.#shift).toConst() as Vec3
    const { shadow, known } = sampleShadows(shadows.nodes, shifted, jitter)
    const depth = shadow.toVar()
    If(known.mul(this.#isMapped).equal(0), () => {
      const { altitude, cosLight, up } = view.localCoordinates(offset)
      if (field.worldMap === null) depth.assign(meanDepthTowards(field, altitude, cosLight))
      else {
        const sample = {
          offset: shifted,
          altitude,
          up,
          distance: shifted.length().toConst() as Float
        }
        depth.assign(opticalDepthTowards(field, sample, view.lightDirection))
      }
    })
    // What is scattered within the forward peak arrives with the sun.
    return depth.mul(light.nodes.depthScale).negate().exp()
  }

  diffuse({ view, offset }: AirPlace): Vec4 {
    const { field, light } = this.#clouds
    const { altitude, cosLight, up } = view.localCoordinates(offset)
    const shifted = offset.add(this.#shift).toConst() as Vec3
    const decks =
      field.worldMap === null
        ? meanDecks(field, light.nodes, altitude, cosLight)
        : decksAround(field, light.nodes, shifted, altitude, up, cosLight)
    return diffuseRatio(view, decks, altitude, cosLight)
  }

  dispose(): void {
    this.onDispose?.()
  }
}

import type { Renderer } from 'three/webgpu'
import { fail } from '@welkin/geo'
import type { AtmosphereView } from '../view/AtmosphereView'
import type { AirOccluder, AirShadow, ShadowedShafts } from './AirOccluder'

/** Shadows that were added to light shafts, by what casts them. */
export class CastShadows {
  readonly #shadows = new Map<AirOccluder, AirShadow>()

  get all(): AirShadow[] {
    return [...this.#shadows.values()]
  }

  /** @throws If an occluder is none, is there already, or cannot be added; then nothing is added. */
  add(shafts: ShadowedShafts, occluders: readonly AirOccluder[]): void {
    const where = 'LightShafts.add'
    occluders.forEach((occluder, i) => {
      if (typeof occluder?.castInto !== 'function')
        fail(where, 'occluder must be an AirOccluder, such as cloudAirShadow()', occluder)
      if (this.#shadows.has(occluder) || occluders.indexOf(occluder) < i)
        fail(where, 'occluder must not have been added already', occluder)
    })
    try {
      for (const occluder of occluders) this.#shadows.set(occluder, occluder.castInto(shafts))
    } catch (error) {
      this.remove(occluders)
      throw error
    }
  }

  /** Takes out those of some occluders that are there. */
  remove(occluders: readonly AirOccluder[]): void {
    for (const occluder of occluders) {
      this.#shadows.get(occluder)?.dispose?.()
      this.#shadows.delete(occluder)
    }
  }

  /** Frees what they have drawn. */
  free(): void {
    for (const shadow of this.all) shadow.free?.()
  }

  /** Sets uniforms, and draws tables, for a camera's air. @returns True if any shadow is cast. */
  update(view: AtmosphereView, renderer: Renderer): boolean {
    return this.all.reduce((isCast, shadow) => {
      shadow.update?.(view, renderer)
      return isCast || (shadow.isCast ?? true)
    }, false)
  }
}

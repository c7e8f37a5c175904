import { checkRange } from '@welkin/atmosphere'
import { fail } from '@welkin/geo'
import { CloudLayer, type CloudLayerParameters } from './CloudLayer'

/**
 * The one to four layers that make up a sky's clouds. Layers may overlap in altitude.
 *
 * ```ts
 * const layers = new CloudLayers([{ coverage: 0.5 }, { baseAltitude: 8500, topAltitude: 9500 }])
 * layers.at(0).set({ coverage: 0.7 })
 * ```
 */
export class CloudLayers implements Iterable<CloudLayer> {
  /** A shader evaluates every layer at every sample: this many fit its uniforms. */
  static readonly maxLayers = 4

  readonly #layers: readonly CloudLayer[]

  /**
   * @param layers - Layers, shared with the caller, or parameters of new ones. Left out: one
   *   layer of scattered fair-weather cumulus.
   * @param count - How many layers there are at least, for a later `copy`: further ones cover nothing.
   * @throws Error when there is no layer, more than four, or a parameter is out of its range.
   */
  constructor(layers: readonly (CloudLayer | Partial<CloudLayerParameters>)[] = [{}], count = 1) {
    if (!Array.isArray(layers) || layers.length < 1 || layers.length > CloudLayers.maxLayers) {
      const got = Array.isArray(layers) ? layers.length : layers
      fail('CloudLayers', `layers must be 1 to ${CloudLayers.maxLayers}`, got)
    }
    checkRange('CloudLayers', 'count', count, 1, CloudLayers.maxLayers)
    const all: (CloudLayer | Partial<CloudLayerParameters>)[] = [...layers]
    while (all.length < count) all.push({ coverage: 0 })
    this.#layers = all.map(layer => (layer instanceof CloudLayer ? layer : new CloudLayer(layer)))
  }

  get length(): number {
    return this.#layers.length
  }

  /**
   * Takes the parameters of other layers; what is left over covers nothing then.
   *
   * @throws Error when there are more of them than here.
   */
  copy(other: CloudLayers): this {
    if (other.length > this.length) {
      fail('CloudLayers', `layers must be at most ${this.length}`, other.length)
    }
    this.#layers.forEach((layer, i) => {
      layer.set(i < other.length ? other.at(i).parameters : { coverage: 0 })
    })
    return this
  }

  /** @throws Error when there is no layer of this index. */
  at(index: number): CloudLayer {
    const layer = this.#layers[index]
    if (layer === undefined) fail('CloudLayers', `index must be 0 to ${this.length - 1}`, index)
    return layer
  }

  [Symbol.iterator](): Iterator<CloudLayer> {
    return this.#layers[Symbol.iterator]()
  }
}

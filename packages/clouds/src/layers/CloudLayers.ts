import { fail } from '@welkin/geo'
import { CloudLayer, type CloudLayerParameters } from './CloudLayer'

const clear = { coverage: 0 }

/**
 * The one to four layers that make up a sky's clouds. Layers may overlap in altitude.
 *
 * ```ts
 * const layers = new CloudLayers([{ coverage: 0.5 }, { baseAltitude: 8500, topAltitude: 9500 }])
 * layers.at(0).set({ coverage: 0.7 })
 * ```
 */
export class CloudLayers implements Iterable<CloudLayer> {
  /** Most layers of a sky: a shader evaluates each at every sample, by uniforms for so many. */
  static readonly maxLayers = 4

  readonly #layers: readonly CloudLayer[]

  /**
   * @param layers - Layers, shared with the caller, or parameters of new ones. Left out: one
   *   layer of scattered fair-weather cumulus.
   * @param count - Least number of layers, for a later `copy`: further ones cover nothing.
   * @throws Error when there is no layer, more than four, or a parameter is out of its range.
   */
  constructor(layers: readonly (CloudLayer | Partial<CloudLayerParameters>)[] = [{}], count = 0) {
    if (!Array.isArray(layers)) fail('CloudLayers', 'layers must be an array', layers)
    checkCount('CloudLayers', count)
    const length = Math.max(layers.length, count)
    if (!(length >= 1 && length <= CloudLayers.maxLayers)) {
      fail('CloudLayers', `layers must be 1 to ${CloudLayers.maxLayers}`, length)
    }
    this.#layers = Array.from({ length }, (_, i) => {
      const layer = layers[i] ?? clear
      return layer instanceof CloudLayer ? layer : new CloudLayer(layer)
    })
  }

  get length(): number {
    return this.#layers.length
  }

  /**
   * Copies the parameters of other layers; layers that are left over cover nothing then.
   *
   * @throws Error when they are no layers, or more than here.
   */
  copy(other: CloudLayers): this {
    if (!(other instanceof CloudLayers)) {
      fail('CloudLayers.copy', 'other must be CloudLayers', other)
    }
    const { length } = other
    if (length > this.length) fail('CloudLayers', `layers must be 1 to ${this.length}`, length)
    this.#layers.forEach((layer, i) => layer.set(other.#layers[i]?.parameters ?? clear))
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

/** @throws If it is no number of layers. */
export function checkCount(where: string, count: number): void {
  if (!(Number.isInteger(count) && count >= 0 && count <= CloudLayers.maxLayers)) {
    fail(where, `count must be 0 to ${CloudLayers.maxLayers}`, count)
  }
}

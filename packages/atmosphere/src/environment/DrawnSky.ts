import { Matrix3, Vector3 } from 'three'
import type { Atmosphere } from '../Atmosphere'
import type { AtmosphereView } from '../view/AtmosphereView'
import type { SkyLayer } from '../view/SkyLayer'

const RADIANS = Math.PI / 180
/** Cameras lower than this see the same sky [m]. */
const LOW = 500
/** Change of the sun's irradiance, in an eclipse say, that shows. */
const DIMMING = 0.02
/** Factor of the luminance scale up to which half floats resolve a tenth of a grey level. */
const RESCALING = 1000

/** State of the sky when it was last drawn: all that its picture depends on. */
export class DrawnSky {
  readonly #atmosphere: Atmosphere
  #height = NaN
  #tablesVersion = -1
  #scale = NaN
  #layers: readonly SkyLayer[] = []
  #versions: readonly (number | undefined)[] = []
  readonly #sun = new Vector3()
  readonly #up = new Vector3()
  readonly #axes = new Matrix3()
  readonly #irradiance = [0, 0, 0, 0]
  readonly #toMapped = new Matrix3()

  constructor(atmosphere: Atmosphere) {
    this.#atmosphere = atmosphere
  }

  /** World to mapped axes, of which columns of unit length count. */
  #axesOf({ camera, viewToMapped }: AtmosphereView): Matrix3 {
    const rotation = this.#toMapped.setFromMatrix4(camera.matrixWorld).transpose()
    return rotation.premultiply(viewToMapped)
  }

  set(view: AtmosphereView): void {
    this.#height = view.height
    this.#tablesVersion = this.#atmosphere.tables.version
    this.#scale = this.#atmosphere.luminanceScale
    this.#layers = [...this.#atmosphere.layers]
    this.#versions = this.#layers.map(({ version }) => version)
    this.#sun.copy(view.lightDirection)
    this.#up.copy(view.up)
    this.#axes.copy(this.#axesOf(view))
    view.irradiance.forEach((value, i) => (this.#irradiance[i] = value))
  }

  resembles(view: AtmosphereView, angle: number, climb: number): boolean {
    const chord = 2 * Math.sin((Math.min(angle, 180) * RADIANS) / 2)
    const axes = this.#axesOf(view).elements
    const scale = Math.hypot(axes[0], axes[1], axes[2]) || 1
    const { layers, luminanceScale, tables } = this.#atmosphere
    return (
      tables.version === this.#tablesVersion &&
      layers.length === this.#layers.length &&
      layers.every(
        (layer, i) => layer === this.#layers[i] && layer.version === this.#versions[i]
      ) &&
      Math.abs(Math.log(luminanceScale / this.#scale)) <= Math.log(RESCALING) &&
      this.#sun.distanceTo(view.lightDirection) <= chord &&
      this.#up.distanceTo(view.up) <= chord &&
      this.#axes.elements.every((value, i) => Math.abs(value - axes[i]) <= chord * scale) &&
      Math.abs(view.height - this.#height) <= climb * Math.max(Math.abs(this.#height), LOW) &&
      view.irradiance.every((value, i) => Math.abs(value - this.#irradiance[i]) <= DIMMING * value)
    )
  }
}

import { DataUtils } from 'three'
import type { Renderer } from 'three/webgpu'
import type { AtmosphereParameters } from '../parameters/AtmosphereParameters'
import { AtmosphereUniforms } from '../air/AtmosphereUniforms'
import { DiffuseLightTable } from '../diffuseLight/DiffuseLightTable'
import type { DiffuseLightData } from '../diffuseLight/cpu/diffuseLight'
import { SkyVolumes } from '../skyVolume/SkyVolumes'
import { TransmittanceTable } from '../transmittance/TransmittanceTable'
import { checkOwner } from '../view/renderers'

/** Tables of an atmosphere on the GPU: transmittance, diffuse light, and the sky volumes made from them. */
export class AtmosphereTables {
  readonly uniforms = new AtmosphereUniforms()
  readonly transmittance = new TransmittanceTable(this.uniforms)
  readonly diffuseLight = new DiffuseLightTable(this.uniforms, this.transmittance.target)
  readonly volumes = new SkyVolumes(
    this.uniforms,
    this.transmittance.target,
    this.diffuseLight.target
  )
  /** Counts the times that the tables were finished; 0 before the first. */
  version = 0
  /** The diffuse-light table as numbers, or null until it was read back. */
  data: DiffuseLightData | null = null
  #renderer: Renderer | null = null
  #parametersVersion = -1
  #scale = NaN
  #work: Generator<void, void, void> | null = null
  #reading: Promise<void> | null = null

  /**
   * Brings the tables up to date, or some steps nearer to it.
   *
   * @param steps - Most steps of the solution to take; there are 20 in all.
   */
  update(
    renderer: Renderer,
    parameters: AtmosphereParameters,
    luminanceScale: number,
    steps: number
  ): void {
    checkOwner('Atmosphere', this.#renderer, renderer)
    if (renderer !== this.#renderer) {
      // Textures went with the renderer before.
      this.#work?.return()
      this.#work = null
      this.volumes.invalidate()
      this.#renderer = renderer
      this.#parametersVersion = -1
    }
    for (let step = 0; step < steps; step++) {
      // What changed during a bake is baked after it.
      if (this.#work === null) {
        if (parameters.version === this.#parametersVersion) break
        this.#parametersVersion = parameters.version
        this.#setUniforms(parameters, luminanceScale)
        this.#work = this.#bake(renderer)
      }
      if (this.#work.next().done === true) this.#finish(renderer)
    }
    if (luminanceScale !== this.#scale) this.#setUniforms(parameters, luminanceScale)
  }

  #setUniforms(parameters: AtmosphereParameters, luminanceScale: number): void {
    this.uniforms.update(parameters, luminanceScale)
    this.#scale = luminanceScale
  }

  *#bake(renderer: Renderer): Generator<void, void, void> {
    this.transmittance.bake(renderer)
    yield* this.diffuseLight.bake(renderer)
  }

  #finish(renderer: Renderer): void {
    this.#work = null
    this.version++
    this.#reading = this.#read(renderer)
    // Whoever awaits it in read() learns of an error; nobody has to.
    this.#reading.catch(() => undefined)
  }

  async #read(renderer: Renderer): Promise<void> {
    const { target } = this.diffuseLight
    const version = this.version
    const { width, height } = target
    const halves = await renderer
      .readRenderTargetPixelsAsync(target, 0, 0, width, height)
      .catch((error: unknown) => {
        // Nobody misses what was disposed of or baked anew meanwhile.
        if (version === this.version) throw error
      })
    if (version !== this.version) return
    const values = Float32Array.from(halves as Uint16Array, half => DataUtils.fromHalfFloat(half))
    // WebGL reads from the bottom row up, which texture coordinates there call the first.
    const backend = renderer.backend as { isWebGPUBackend?: boolean }
    this.data = { values, isFlipped: backend.isWebGPUBackend !== true }
  }

  /** Resolves when the tables that were last finished have been read back. */
  async read(): Promise<void> {
    await this.#reading
  }

  /** Bytes of GPU memory that the tables and volumes take. */
  get bytes(): number {
    const targets = [this.transmittance.target, this.diffuseLight.target, ...this.volumes.targets]
    const bytesPerTexel = 8
    return targets.reduce(
      (sum, { width, height, textures }) => sum + width * height * textures.length * bytesPerTexel,
      0
    )
  }

  /** Frees all of it. The next {@link update} starts from nothing. */
  dispose(): void {
    this.#work?.return()
    this.#work = null
    this.#renderer = null
    this.version++
    this.data = null
    for (const part of [this.transmittance, this.diffuseLight, this.volumes]) part.dispose()
  }
}

import { DataUtils } from 'three'
import type { Renderer } from 'three/webgpu'
import type { AtmosphereParameters } from './AtmosphereParameters'
import { AtmosphereUniforms } from './AtmosphereUniforms'
import { DiffuseLightTable } from './DiffuseLightTable'
import type { DiffuseLightData } from './cpu/diffuseLight'
import { SkyVolume, SkyVolumeBaker } from './SkyVolume'
import { TransmittanceTable } from './TransmittanceTable'
import type { EyeScalars } from './tsl/eye'

/** Most sky volumes that are kept for different places at a time. */
const MOST_VOLUMES = 4

/** What an atmosphere keeps on the GPU: its two tables and the sky volumes made from them. */
export class AtmosphereTables {
  readonly uniforms = new AtmosphereUniforms()
  readonly transmittance = new TransmittanceTable(this.uniforms)
  readonly diffuseLight = new DiffuseLightTable(this.uniforms, this.transmittance.target)
  readonly volumes: SkyVolume[] = []
  /** Counts the times that the tables were finished; 0 before the first. */
  version = 0
  /** The diffuse-light table as numbers, or null until it was read back. */
  data: DiffuseLightData | null = null
  readonly #volumeBaker = new SkyVolumeBaker(
    this.uniforms,
    this.transmittance.target,
    this.diffuseLight.target
  )
  #renderer: Renderer | null = null
  #parametersVersion = -1
  #scale = NaN
  #work: Generator<void, void, void> | null = null
  #reading: Promise<void> | null = null
  #uses = 0

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
    const stale = renderer !== this.#renderer || parameters.version !== this.#parametersVersion
    if (stale || luminanceScale !== this.#scale) {
      this.uniforms.update(parameters, luminanceScale)
      this.#scale = luminanceScale
    }
    if (stale) {
      this.#work?.return()
      // Another renderer shares no textures with the last one.
      if (renderer !== this.#renderer) for (const volume of this.volumes) volume.eye = null
      this.#renderer = renderer
      this.#parametersVersion = parameters.version
      this.#work = this.#bake(renderer)
    }
    for (let step = 0; this.#work !== null && step < steps; step++) {
      if (this.#work.next().done === true) this.#finish(renderer)
    }
  }

  *#bake(renderer: Renderer): Generator<void, void, void> {
    this.transmittance.bake(renderer)
    yield* this.diffuseLight.bake(renderer)
  }

  #finish(renderer: Renderer): void {
    this.#work = null
    this.version++
    this.#reading = this.#read(renderer)
  }

  async #read(renderer: Renderer): Promise<void> {
    const { target } = this.diffuseLight
    const version = this.version
    const { width, height } = target
    const halves = await renderer.readRenderTargetPixelsAsync(target, 0, 0, width, height)
    if (version !== this.version) return
    const values = Float32Array.from(halves as Uint16Array, DataUtils.fromHalfFloat)
    // WebGL reads from the bottom row up, which texture coordinates there call the first.
    const backend = renderer.backend as { isWebGPUBackend?: boolean }
    this.data = { values, isFlipped: backend.isWebGPUBackend !== true }
  }

  /** Resolves when the tables that were last finished have been read back. */
  async read(): Promise<void> {
    await this.#reading
  }

  /**
   * A sky volume for an eye: one that is there already, or `last` computed anew, or another.
   *
   * @param last - Volume that the same camera used last.
   */
  volumeFor(renderer: Renderer, eye: EyeScalars<number>, last: SkyVolume | null): SkyVolume {
    const fits = ({ eye: other, tablesVersion }: SkyVolume): boolean =>
      other !== null && tablesVersion === this.version && isSameEye(other, eye)
    let volume = last !== null && fits(last) ? last : this.volumes.find(fits)
    if (volume === undefined) {
      volume = this.#reusable(last)
      volume.tablesVersion = this.version
      this.#volumeBaker.bake(renderer, volume, eye)
    }
    volume.lastUsed = ++this.#uses
    return volume
  }

  #reusable(last: SkyVolume | null): SkyVolume {
    if (last !== null && last.users <= 1 && this.volumes.includes(last)) return last
    if (this.volumes.length < MOST_VOLUMES) {
      const volume = new SkyVolume()
      this.volumes.push(volume)
      return volume
    }
    return this.volumes.reduce((oldest, other) =>
      other.lastUsed < oldest.lastUsed ? other : oldest
    )
  }

  /** Bytes of GPU memory that the tables and volumes take. */
  get bytes(): number {
    const targets = [
      this.transmittance.target,
      this.diffuseLight.target,
      this.#volumeBaker.scratch,
      ...this.volumes.flatMap(volume => [volume.light, volume.depth])
    ]
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
    const owned = [this.transmittance, this.diffuseLight, this.#volumeBaker, ...this.volumes]
    for (const part of owned) part.dispose()
    this.volumes.length = 0
  }
}

function isSameEye(a: EyeScalars<number>, b: EyeScalars<number>): boolean {
  return (
    Math.abs(a.altitude - b.altitude) <= 1e-4 * (b.altitude + 10) &&
    Math.abs(a.cosSun - b.cosSun) <= 1e-6
  )
}

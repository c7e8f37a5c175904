import type { Renderer } from 'three/webgpu'
import type { AtmosphereParameters } from '../parameters/AtmosphereParameters'
import { AtmosphereUniforms } from '../air/AtmosphereUniforms'
import { fail } from '@welkin/geo'
import { DiffuseLightTable } from '../diffuseLight/DiffuseLightTable'
import type { DiffuseLightData } from '../diffuseLight/cpu/diffuseLight'
import type { Air } from '../scattering/tsl/ray'
import { SkyVolumes, VOLUMES_WIDTH } from '../skyVolume/SkyVolumes'
import { TransmittanceTable } from '../transmittance/TransmittanceTable'
import { checkOwner } from '../view/renderers'
import { GAP, TableAtlas } from './TableAtlas'
import { DEPTH_SIZE, TRANSMITTANCE_SIZE, VOLUME_SLOTS } from './tableSizes'

/** Layout of the atlas: tables in a row at its top, and room for volumes beside them [texels]. */
const DIFFUSE_X = TRANSMITTANCE_SIZE[0] + GAP
const DEPTH_X = DIFFUSE_X + DiffuseLightTable.size[0] + GAP
const DEPTH_Y = DEPTH_SIZE[1] + 1 + GAP
const VOLUMES_Y = 2 * DEPTH_Y

/**
 * Tables of some air on the GPU: transmittance, diffuse light, and the sky volumes made from them, all
 * in one texture. Several atmospheres and shells can share them; the last that is disposed of frees them.
 */
export class AtmosphereTables {
  /** Composition of the air, shared. */
  readonly parameters: AtmosphereParameters
  /** Output of every node per luminance, > 0 [1/(cd/m²)]. */
  luminanceScale = 1e-4
  /** Most steps of baking in one frame, ≥ 1; a bake has 20. */
  bakeStepsPerFrame = Infinity
  readonly uniforms = new AtmosphereUniforms()
  readonly atlas = new TableAtlas('Welkin.Atmosphere', VOLUMES_WIDTH, VOLUMES_Y)
  readonly transmittance = new TransmittanceTable(
    this.uniforms,
    this.atlas.region(0, 0, ...TRANSMITTANCE_SIZE)
  )
  readonly diffuseLight = new DiffuseLightTable(
    this.uniforms,
    this.atlas.region(DIFFUSE_X, 0, ...DiffuseLightTable.size),
    this.transmittance.region
  )
  /** Tables as shaders read them. */
  readonly air: Air = {
    uniforms: this.uniforms,
    transmittance: this.transmittance.region,
    diffuse: this.diffuseLight.region
  }
  readonly volumes = new SkyVolumes(this.air, this.atlas, {
    top: VOLUMES_Y,
    depths: [
      [DEPTH_X, 0],
      [DEPTH_X, DEPTH_Y]
    ]
  })
  /** Counts the times that the tables were finished; 0 before the first. */
  version = 0
  /** The diffuse-light table as numbers, or null until it was read back. */
  data: DiffuseLightData | null = null
  #renderer: Renderer | null = null
  #parametersVersion = -1
  #scale = NaN
  #work: Generator<void, void, void> | null = null
  #reading: Promise<void> | null = null
  /** Sources of light that there is room for volumes for; an atmosphere stands for its sun. */
  readonly #sources = new Set<object>()
  /** Atmospheres and shells that use the tables. */
  readonly #users = new Set<object>()
  /** True when the atlas grew since it was filled. */
  #isLost = false

  constructor(parameters: AtmosphereParameters) {
    this.parameters = parameters
  }

  /** Frees the tables, unless another user has called {@link update} and not yet this. */
  release(user: object): void {
    this.#users.delete(user)
    this.removeSource(user)
    if (this.#users.size === 0) this.dispose()
  }

  /**
   * Makes room for the sky volumes of a source of light. Where the tables were baked before and there is
   * no room left, they are baked anew, at once.
   */
  addSource(source: object): void {
    this.#sources.add(source)
    if (!this.volumes.reserve(VOLUME_SLOTS * this.#sources.size)) return
    this.#isLost = this.version > 0
    this.#startAgain()
  }

  /** Leaves that room to the next source. */
  removeSource(source: object): void {
    this.#sources.delete(source)
  }

  #startAgain(): void {
    this.#work?.return()
    this.#work = null
    this.volumes.invalidate()
    this.#parametersVersion = -1
  }

  /**
   * Brings the tables up to date, or some steps nearer to it.
   *
   * @param user - Atmosphere or shell that uses the tables from now on, until it calls {@link release}.
   * @param steps - Most steps of the solution to take; there are 20 in all.
   */
  update(renderer: Renderer, user: object, steps = this.bakeStepsPerFrame): void {
    checkOwner('Atmosphere', this.#renderer, renderer)
    this.#users.add(user)
    if (renderer !== this.#renderer) {
      // Textures went with the renderer before.
      this.#startAgain()
      this.#renderer = renderer
    }
    const most = this.#isLost ? Infinity : steps
    this.#isLost = false
    for (let step = 0; step < most; step++) {
      // What changed during a bake is baked after it.
      if (this.#work === null) {
        if (this.parameters.version === this.#parametersVersion) break
        this.#parametersVersion = this.parameters.version
        this.#setUniforms()
        this.#work = this.#bake(renderer)
      }
      if (this.#work.next().done === true) this.#finish(renderer)
    }
    if (this.luminanceScale !== this.#scale) this.#setUniforms()
  }

  #setUniforms(): void {
    this.uniforms.update(this.parameters, this.luminanceScale)
    this.#scale = this.luminanceScale
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
    const version = this.version
    // Nobody misses what was disposed of or baked anew meanwhile.
    const isWanted = (): boolean => version === this.version
    try {
      const values = await this.diffuseLight.region.read(renderer)
      if (isWanted()) this.data = { values }
    } catch (error) {
      if (isWanted()) throw error
    }
  }

  /** Resolves when the tables that were last finished have been read back. */
  async read(): Promise<void> {
    await this.#reading
  }

  /** Frees all of it. The next {@link update} starts from nothing. */
  dispose(): void {
    this.#work?.return()
    this.#work = null
    this.#renderer = null
    this.version++
    this.data = null
    for (const part of [this.transmittance, this.diffuseLight, this.volumes, this.atlas]) {
      part.dispose()
    }
  }
}

/** @throws If they are no tables, or of other parameters. */
export function checkTables(
  where: string,
  tables: AtmosphereTables,
  parameters: AtmosphereParameters
): void {
  if (!(tables instanceof AtmosphereTables)) {
    fail(where, "tables must be an atmosphere's", tables)
  }
  if (tables.parameters !== parameters) {
    fail(where, 'parameters must be tables.parameters, the same object', parameters)
  }
}

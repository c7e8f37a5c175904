import { NearestFilter, Vector4 } from 'three'
import { texture, uniform } from 'three/tsl'
import type { Renderer, UniformNode } from 'three/webgpu'
import type { AtmosphereUniforms } from '../air/AtmosphereUniforms'
import { gaussLegendre } from '../math/cpu/quadrature'
import { FragmentPass, tableTarget } from '../tables/FragmentPass'
import { TableAtlas, type Table, type TableRegion } from '../tables/TableAtlas'
import { DIFFUSE_LAYOUT, DIFFUSE_SIZE } from '../tables/tableSizes'
import { BAKE_ROWS, bakeRays, reduceRays, sumOrders } from './tsl/diffuseLightBake'
import type { Air } from '../scattering/tsl/ray'
import { sampleLevel0, vec4Array } from '../tsl-types'

const [COLUMNS, ROWS] = DIFFUSE_SIZE
/** Columns and rows of the table [texels]. */
const [WIDTH, HEIGHT] = [COLUMNS * DIFFUSE_LAYOUT[0], ROWS * DIFFUSE_LAYOUT[1]] as const

/**
 * Directions and steps of a round, and where its nodes start in the rule: sunlight has a sharp peak,
 * light scattered before has none.
 */
const SUN_ROUND = { elevations: 12, azimuths: 12, steps: 8, offset: 0 }
const DIFFUSE_ROUND = { elevations: 8, azimuths: 6, steps: 4, offset: SUN_ROUND.elevations }
const MOST_RAYS = 2 * SUN_ROUND.elevations * SUN_ROUND.azimuths

/** Orders of scattering that are computed; those beyond are summed as a geometric series. */
const ORDERS = 5

const integer = (): UniformNode<'int', number> => uniform(0, 'int')

/** Bake resources: textures and passes that the finished table does not need. */
class BakeResources {
  readonly rays = tableTarget('DiffuseLight.rays', MOST_RAYS, BAKE_ROWS * COLUMNS, 1, NearestFilter)
  readonly orders = Array.from({ length: ORDERS }, (_, order) =>
    new TableAtlas(`DiffuseLight.order${order}`, WIDTH, HEIGHT).region(0, 0, WIDTH, HEIGHT)
  )
  readonly #elevations = integer()
  readonly #azimuths = integer()
  readonly #offset = integer()
  readonly #firstRow = integer()
  readonly #previous = texture(this.orders[0].atlas.target.texture)
  readonly #sunRays: FragmentPass
  readonly #diffuseRays: FragmentPass
  readonly #reduce: FragmentPass
  readonly #sum: FragmentPass

  constructor(uniforms: AtmosphereUniforms, transmittance: Table) {
    const rounds = [SUN_ROUND, DIFFUSE_ROUND].flatMap(({ elevations }) => {
      const { nodes, weights } = gaussLegendre(elevations)
      return nodes.map((node, i) => new Vector4(node, weights[i], 0, 0))
    })
    const directions = {
      elevations: this.#elevations,
      azimuths: this.#azimuths,
      rule: vec4Array(rounds),
      offset: this.#offset
    }
    const sunOnly: Air = { uniforms, transmittance, diffuse: null }
    const previous: Table = { sample: at => sampleLevel0(this.#previous, at) }
    const diffuseOnly: Air = { ...sunOnly, diffuse: previous }
    const row = this.#firstRow
    this.#sunRays = new FragmentPass(
      'Welkin.DiffuseLight.sunRays',
      bakeRays(sunOnly, directions, row, MOST_RAYS, SUN_ROUND.steps)
    )
    this.#diffuseRays = new FragmentPass(
      'Welkin.DiffuseLight.diffuseRays',
      bakeRays(diffuseOnly, directions, row, MOST_RAYS, DIFFUSE_ROUND.steps)
    )
    this.#reduce = new FragmentPass(
      'Welkin.DiffuseLight.reduce',
      reduceRays(sunOnly, texture(this.rays.texture), directions, row, MOST_RAYS)
    )
    this.#sum = new FragmentPass('Welkin.DiffuseLight.sum', sumOrders(this.orders))
  }

  /** Gathers one order of scattering for some rows of the table. */
  gather(renderer: Renderer, order: number, firstRow: number): void {
    const round = order === 0 ? SUN_ROUND : DIFFUSE_ROUND
    this.#elevations.value = round.elevations
    this.#azimuths.value = round.azimuths
    this.#offset.value = round.offset
    this.#firstRow.value = firstRow
    if (order > 0) this.#previous.value = this.orders[order - 1].atlas.target.texture
    const rays = order === 0 ? this.#sunRays : this.#diffuseRays
    rays.render(renderer, this.rays)
    this.orders[order].render(renderer, this.#reduce)
  }

  /** Sums all orders into the table. */
  finish(renderer: Renderer, region: TableRegion): void {
    region.render(renderer, this.#sum)
  }

  /** Frees the textures, but not the shaders: the next bake compiles nothing. */
  release(): void {
    for (const each of [this.rays, ...this.orders.map(order => order.atlas)]) each.dispose()
  }

  dispose(): void {
    this.release()
    for (const owned of [this.#sunRays, this.#diffuseRays, this.#reduce, this.#sum]) owned.dispose()
  }
}

/**
 * Moments (l ≤ 2) of the diffuse light in the air, by altitude and angle of the light, all orders of scattering
 * and the ground's reflection included, for unit irradiance of the light source.
 *
 * Solved by successive orders: sunlight scattered once, then light scattered n times from light
 * scattered n − 1 times. Each order gathers rays in every direction from every cell.
 */
export class DiffuseLightTable {
  /** Columns and rows of the table [texels]. */
  static readonly size = [WIDTH, HEIGHT] as const
  /** Region of the atlas that holds the table: tiles as `DIFFUSE_LAYOUT` has them; values × `RADIANCE_SCALE`. */
  readonly region: TableRegion
  readonly #uniforms: AtmosphereUniforms
  readonly #transmittance: Table
  #resources: BakeResources | null = null

  /**
   * @param region - Region of {@link size}; its atlas frees it.
   * @param transmittance - Baked before this one.
   */
  constructor(uniforms: AtmosphereUniforms, region: TableRegion, transmittance: Table) {
    this.region = region
    this.#uniforms = uniforms
    this.#transmittance = transmittance
  }

  /**
   * Computes the table from the uniforms, step by step. Until the last step is done the old table
   * stands.
   */
  *bake(renderer: Renderer): Generator<void, void, void> {
    const resources = (this.#resources ??= new BakeResources(this.#uniforms, this.#transmittance))
    try {
      for (let order = 0; order < ORDERS; order++) {
        for (let row = 0; row < ROWS; row += BAKE_ROWS) {
          resources.gather(renderer, order, row)
          yield
        }
      }
      resources.finish(renderer, this.region)
    } finally {
      resources.release()
    }
  }

  /** Frees its shaders. */
  dispose(): void {
    this.#resources?.dispose()
    this.#resources = null
  }
}

import { withDefaults } from '../../check'
import {
  checkParameters,
  spectrumOf,
  type AtmosphereParameters
} from '../../parameters/AtmosphereParameters'
import { DIFFUSE_SIZE, DIFFUSE_TILES, RADIANCE_SCALE } from '../../tables/tableSizes'
import { distanceToGround, distanceToTop } from '../../air/cpu/boundary'
import {
  diffuseColumn,
  diffuseColumnCosine,
  diffuseTexel,
  type DiffuseLightData
} from './diffuseLight'
import { densities, homogeneousHeight } from '../../air/cpu/medium'
import { asymmetryMoments, cornetteShanksPhase, rayleighPhase } from '../../air/cpu/phase'
import { gaussLegendre } from '../../math/cpu/quadrature'
import { discTransmittance, visibleDisc } from '../../transmittance/cpu/transmittance'

const [COLUMNS, ROWS] = DIFFUSE_SIZE
const PER_CELL = 4 * DIFFUSE_TILES

/** Resolution with which light is gathered. The defaults are those of the shaders. */
export interface DiffuseLightQuality {
  /** Directions above and below the horizon each, over half a turn, and steps, for sunlight. */
  sun: { elevations: number; azimuths: number; steps: number }
  /** Counts for light that was scattered before. */
  diffuse: { elevations: number; azimuths: number; steps: number }
  /** Orders of scattering; those beyond are summed as a geometric series. */
  orders: number
}

const STANDARD: DiffuseLightQuality = {
  sun: { elevations: 12, azimuths: 12, steps: 8 },
  diffuse: { elevations: 8, azimuths: 6, steps: 4 },
  orders: 5
}

/** Bilinear look-up among rows × columns of `size` values each. */
function interpolate(
  values: Float64Array,
  columns: number,
  rows: number,
  size: number,
  x: number,
  y: number,
  target: Float64Array
): void {
  const column = Math.min(Math.max(Math.floor(x), 0), columns - 2)
  const row = Math.min(Math.max(Math.floor(y), 0), rows - 2)
  const u = Math.min(Math.max(x - column, 0), 1)
  const v = Math.min(Math.max(y - row, 0), 1)
  const a = (row * columns + column) * size
  const b = a + columns * size
  for (let i = 0; i < size; i++) {
    const lower = values[a + i] * (1 - u) + values[a + size + i] * u
    const upper = values[b + i] * (1 - u) + values[b + size + i] * u
    target[i] = lower * (1 - v) + upper * v
  }
}

/** Part of the sun's light that arrives at a point, tabulated: marches ask millions of times. */
class Sunlight {
  static readonly #columns = 256
  static readonly #rows = 64
  readonly #depth: Float64Array
  readonly #p: AtmosphereParameters
  readonly #chord: number

  constructor(p: AtmosphereParameters) {
    const [columns, rows] = [Sunlight.#columns, Sunlight.#rows]
    this.#p = p
    this.#chord = Math.sqrt(p.topRadius ** 2 - p.bottomRadius ** 2)
    this.#depth = new Float64Array(4 * columns * rows)
    for (let row = 0; row < rows; row++) {
      const horizon = (this.#chord * row) / (rows - 1)
      const radius = Math.hypot(horizon, p.bottomRadius)
      const shortest = p.topRadius - radius
      for (let column = 0; column < columns; column++) {
        const longest = horizon + this.#chord
        const distance = shortest + ((longest - shortest) * column) / (columns - 1)
        const cosine = (this.#chord ** 2 - horizon ** 2 - distance ** 2) / (2 * radius * distance)
        const cosView = distance > 1 ? Math.min(Math.max(cosine, -1), 1) : 1
        // Thick air's transmittance underflows, but a depth must be finite.
        const depth = discTransmittance(p, radius, cosView).map(
          value => -Math.log(Math.max(value, 1e-300))
        )
        this.#depth.set(depth, 4 * (row * columns + column))
      }
    }
  }

  transmittance(radius: number, cosLight: number, target: Float64Array): void {
    const visible = visibleDisc(this.#p, radius, cosLight)
    if (visible === 0) {
      target.fill(0)
      return
    }
    const { bottomRadius, topRadius } = this.#p
    const horizon = Math.sqrt(Math.max(radius ** 2 - bottomRadius ** 2, 0))
    const distance = distanceToTop(radius, Math.max(cosLight, -horizon / radius), topRadius)
    const shortest = topRadius - radius
    const x = (distance - shortest) / Math.max(horizon + this.#chord - shortest, 1)
    const [columns, rows] = [Sunlight.#columns, Sunlight.#rows]
    const y = (horizon / this.#chord) * (rows - 1)
    interpolate(this.#depth, columns, rows, 4, x * (columns - 1), y, target)
    for (let i = 0; i < 4; i++) target[i] = visible * Math.exp(-target[i])
  }
}

/** Scratch space of a march; its radiance and optical depth are read off after it. */
class Gatherer {
  readonly radiance = new Float64Array(4)
  readonly depth = new Float64Array(4)
  readonly #p: AtmosphereParameters
  readonly #sunlight: Sunlight
  /** Approximate scale height of the air [m]. */
  readonly #height: number
  readonly #mie: [number, number, number][]
  readonly #sun = new Float64Array(4)
  readonly #cell = new Float64Array(PER_CELL)
  readonly #extinctions = [new Float64Array(4), new Float64Array(4)] as const

  constructor(p: AtmosphereParameters) {
    this.#p = p
    this.#sunlight = new Sunlight(p)
    this.#height = homogeneousHeight(p)
    this.#mie = spectrumOf(p.mieAsymmetry).map(asymmetryMoments)
  }

  /** Moments of light scattered before at a point, into the scratch cell. */
  #lookUp(light: Float64Array, altitude: number, cosLight: number): void {
    const { topRadius, bottomRadius } = this.#p
    const part = Math.min(Math.max(altitude / (topRadius - bottomRadius), 0), 1)
    const x = diffuseColumn(cosLight) * (COLUMNS - 1)
    interpolate(light, COLUMNS, ROWS, PER_CELL, x, Math.sqrt(part) * (ROWS - 1), this.#cell)
  }

  /** Legendre-weighted field in a direction, for one wavelength of the scratch cell. */
  #field(i: number, basis: readonly number[], weight1: number, weight2: number): number {
    const cell = this.#cell
    const first = cell[4 + i] * basis[1] + cell[8 + i] * basis[2]
    const second = cell[12 + i] * basis[3] + cell[16 + i] * basis[4] + cell[20 + i] * basis[5]
    return cell[i] * basis[0] + weight1 * first + weight2 * second
  }

  /**
   * Marches a ray: light scattered in it from the sun or, with `light`, from what that holds.
   *
   * @param endAltitude - At the end of the ray, from which its steps are chosen.
   */
  march(
    light: Float64Array | null,
    radius: number,
    cosView: number,
    cosLight: number,
    cosViewLight: number,
    distance: number,
    endAltitude: number,
    steps: number
  ): void {
    const p = this.#p
    this.radiance.fill(0)
    this.depth.fill(0)
    const rise = endAltitude - (radius - p.bottomRadius)
    const growth = Math.min(Math.max((0.3 * rise) / this.#height, -4), 4)
    const exponent = Math.abs(growth) < 0.05 ? 0.05 : growth
    const at = (x: number): number => (distance * Math.expm1(exponent * x)) / Math.expm1(exponent)
    const molecularPhase = rayleighPhase(cosViewLight)
    const aerosolPhases = spectrumOf(p.mieAsymmetry).map(g => cornetteShanksPhase(g, cosViewLight))
    for (let step = 0; step < steps; step++) {
      const start = at(step / steps)
      const half = (at((step + 1) / steps) - start) / 2
      const nodes = [1 - 1 / Math.sqrt(3), 1 + 1 / Math.sqrt(3)].map((node, which) => {
        const t = start + half * node
        const r = Math.sqrt(radius ** 2 + 2 * radius * cosView * t + t ** 2)
        const altitude = Math.max(r - p.bottomRadius, 0)
        const density = densities(p, altitude)
        const extinction = this.#extinctions[which]
        for (let i = 0; i < 4; i++) {
          extinction[i] =
            p.rayleighScattering[i] * density[0] +
            p.mieExtinction[i] * density[1] +
            p.absorptionExtinction[i] * density[2]
        }
        return { t, r, altitude, density, node }
      })
      const [first, second] = this.#extinctions
      for (const { t, r, altitude, density, node } of nodes) {
        const cosThere = (radius * cosView + t) / r
        const sunThere = Math.min(Math.max((radius * cosLight + t * cosViewLight) / r, -1), 1)
        if (light === null) this.#sunlight.transmittance(r, sunThere, this.#sun)
        else this.#lookUp(light, altitude, sunThere)
        const basis = light === null ? [] : harmonics(cosThere, sunThere, cosViewLight)
        for (let i = 0; i < 4; i++) {
          const byMolecules = p.rayleighScattering[i] * density[0]
          const byAerosols = p.mieScattering[i] * density[1]
          const source =
            light === null
              ? (byMolecules * molecularPhase + byAerosols * aerosolPhases[i]) * this.#sun[i]
              : byMolecules * this.#field(i, basis, 0, 0.1) +
                byAerosols * this.#field(i, basis, this.#mie[i][1], this.#mie[i][2])
          // Extinction as the line through both nodes, integrated from the step's start.
          const mean = (first[i] + second[i]) / 2
          const slope = ((second[i] - first[i]) * Math.sqrt(3)) / 2
          const before = half * (mean * node + (slope * ((node - 1) ** 2 - 1)) / 2)
          this.radiance[i] += source * half * Math.exp(-this.depth[i] - Math.max(before, 0))
        }
      }
      for (let i = 0; i < 4; i++) this.depth[i] += half * (first[i] + second[i])
    }
  }

  /** Adds the Lambertian ground at the end of the last ray marched. */
  addGround(light: Float64Array | null, cosLight: number): void {
    const p = this.#p
    if (light === null) this.#sunlight.transmittance(p.bottomRadius, cosLight, this.#sun)
    else this.#lookUp(light, 0, cosLight)
    for (let i = 0; i < 4; i++) {
      const irradiance = light === null ? this.#sun[i] * Math.max(cosLight, 0) : this.#cell[24 + i]
      const reflected = (irradiance * p.groundAlbedo[i]) / Math.PI
      this.radiance[i] += reflected * Math.exp(-this.depth[i])
    }
  }
}

/** The six basis functions that go with moments that were divided by powers of sin θ_s. */
function harmonics(cosView: number, cosLight: number, cosViewLight: number): number[] {
  const along = cosViewLight - cosView * cosLight
  const squares = (1 - cosView ** 2) * (1 - cosLight ** 2)
  const [y1, y2] = [Math.sqrt(3 / (4 * Math.PI)), Math.sqrt(15 / (4 * Math.PI))]
  return [
    Math.sqrt(1 / (4 * Math.PI)),
    y1 * cosView,
    y1 * along,
    (y2 / Math.sqrt(12)) * (3 * cosView ** 2 - 1),
    y2 * cosView * along,
    (y2 / 2) * (2 * along ** 2 - squares)
  ]
}

/** One order of scattering in every cell, from the sun or from the order before. */
function gatherOrder(
  p: AtmosphereParameters,
  gatherer: Gatherer,
  light: Float64Array | null,
  { elevations, azimuths, steps }: DiffuseLightQuality['sun']
): Float64Array {
  const result = new Float64Array(COLUMNS * ROWS * PER_CELL)
  const rule = gaussLegendre(elevations)
  for (let cell = 0; cell < COLUMNS * ROWS; cell++) {
    const part = Math.floor(cell / COLUMNS) / (ROWS - 1)
    const radius = p.bottomRadius + Math.max((p.topRadius - p.bottomRadius) * part ** 2, 1)
    const cosLight = Math.min(diffuseColumnCosine(cell % COLUMNS), 0.9998)
    const sinLight = Math.sqrt(1 - cosLight ** 2)
    const dip = Math.acos(p.bottomRadius / radius)
    for (let ray = 0; ray < 2 * elevations * azimuths; ray++) {
      const index = Math.floor(ray / azimuths)
      const up = index < elevations
      const x = rule.nodes[index % elevations]
      const span = Math.PI / 2 + (up ? dip : -dip)
      const angle = span * (0.3 * x + 0.7 * x * x)
      const elevation = (up ? angle : -angle) - dip
      const level = Math.cos(elevation)
      const width = span * (0.3 + 1.4 * x) * rule.weights[index % elevations]
      const weight = (width * level * 2 * Math.PI) / azimuths
      const cosView = Math.sin(elevation)
      const towards = level * Math.cos((Math.PI * ((ray % azimuths) + 0.5)) / azimuths)
      const cosViewLight = Math.min(Math.max(towards * sinLight + cosView * cosLight, -1), 1)
      const distance = up
        ? distanceToTop(radius, cosView, p.topRadius)
        : distanceToGround(radius, cosView, p.bottomRadius)
      const end = up ? p.topRadius - p.bottomRadius : 0
      gatherer.march(light, radius, cosView, cosLight, cosViewLight, distance, end, steps)
      if (!up) {
        gatherer.addGround(light, (radius * cosLight + distance * cosViewLight) / p.bottomRadius)
      }
      // The basis of `harmonics` has powers of sin θ_s in it that the moments must be rid of.
      const basis = harmonics(cosView, cosLight, cosViewLight)
      const weights = [
        basis[0],
        basis[1],
        basis[2] / sinLight ** 2,
        basis[3],
        basis[4] / sinLight ** 2,
        basis[5] / sinLight ** 4,
        Math.max(cosView, 0),
        Math.max(-cosView, 0)
      ]
      for (let tile = 0; tile < DIFFUSE_TILES; tile++) {
        for (let i = 0; i < 4; i++) {
          const at = cell * PER_CELL + 4 * tile + i
          result[at] += weights[tile] * weight * gatherer.radiance[i]
        }
      }
    }
  }
  return result
}

/**
 * The diffuse-light table by successive orders of scattering, without a GPU; takes seconds.
 *
 * @param p - Spectra may be of any four wavelengths: nothing but the numbers counts.
 * @param quality - Resolution with which light is gathered.
 * @throws If an option is unknown.
 */
export function solveDiffuseLight(
  p: AtmosphereParameters,
  quality: Partial<DiffuseLightQuality> = {}
): DiffuseLightData {
  checkParameters('solveDiffuseLight', p)
  const { sun, diffuse, orders } = withDefaults('solveDiffuseLight', STANDARD, quality)
  const gatherer = new Gatherer(p)
  const total = new Float64Array(COLUMNS * ROWS * PER_CELL)
  let before: Float64Array | null = null
  for (let order = 0; order < orders; order++) {
    const light: Float64Array = gatherOrder(p, gatherer, before, order === 0 ? sun : diffuse)
    light.forEach((value, i) => (total[i] += value))
    if (order === orders - 1 && before !== null) addTail(total, before, light)
    before = light
  }
  // To the layout of the texture.
  const values = new Float32Array(total.length)
  for (let cell = 0; cell < COLUMNS * ROWS; cell++) {
    for (let tile = 0; tile < DIFFUSE_TILES; tile++) {
      const row = Math.floor(cell / COLUMNS)
      const texel = diffuseTexel(tile, cell % COLUMNS, row)
      for (let i = 0; i < 4; i++) {
        values[4 * texel + i] = RADIANCE_SCALE * total[cell * PER_CELL + 4 * tile + i]
      }
    }
  }
  return { values }
}

/** Adds the orders after the last, each less than the one before by the ratio of the last two. */
function addTail(total: Float64Array, before: Float64Array, last: Float64Array): void {
  for (let cell = 0; cell < COLUMNS * ROWS; cell++) {
    for (let i = 0; i < 4; i++) {
      const [a, b] = [before[cell * PER_CELL + i], last[cell * PER_CELL + i]]
      const ratio = a > 0 ? Math.min(b / a, 0.95) : 0
      for (let tile = 0; tile < DIFFUSE_TILES; tile++) {
        const at = cell * PER_CELL + 4 * tile + i
        total[at] += (last[at] * ratio) / (1 - ratio)
      }
    }
  }
}

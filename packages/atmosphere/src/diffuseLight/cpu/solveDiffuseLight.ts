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
import { densities, extinction, homogeneousHeight } from '../../air/cpu/medium'
import { asymmetryMoments, cornetteShanksPhase, rayleighPhase } from '../../air/cpu/phase'
import { interpolate } from '../../math/cpu/interpolate'
import { gaussLegendre } from '../../math/cpu/quadrature'
import { Sunlight } from './Sunlight'

const [COLUMNS, ROWS] = DIFFUSE_SIZE
const PER_CELL = 4 * DIFFUSE_TILES

/** Factors of spherical harmonics of degree 0, 1 and 2. */
const Y0 = /*#__PURE__*/ Math.sqrt(1 / (4 * Math.PI))
const Y1 = /*#__PURE__*/ Math.sqrt(3 / (4 * Math.PI))
const Y2 = /*#__PURE__*/ Math.sqrt(15 / (4 * Math.PI))

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

/** Point of a ray where light that is scattered towards its start is looked up. */
interface RayNode {
  /** Distance from the start of the ray [m]. */
  distance: number
  radius: number
  /** Cosine between ray and local up. */
  cosView: number
  /** Row of the altitude in the table. */
  row: number
  /** Scattering by molecules and by aerosols that arrives at the start, per radiance and phase function, per wavelength. */
  molecules: Float64Array
  aerosols: Float64Array
}

/**
 * Gathers light along rays. What air does on the way of a ray depends neither on the sun nor on the azimuth: it is found
 * once, by {@link follow}.
 */
class Gatherer {
  /** Light that the last {@link gather} found. */
  readonly radiance = new Float64Array(4)
  readonly #p: AtmosphereParameters
  readonly #sunlight: Sunlight
  /** Approximate scale height of the air [m]. */
  readonly #height: number
  readonly #asymmetries: readonly number[]
  readonly #mie: [number, number, number][]
  #start = { radius: 0, cosView: 0, distance: 0 }
  #nodes: RayNode[] = []
  /** Transmittance of the ray, per wavelength. */
  readonly #transmittance = new Float64Array(4)
  readonly #sun = new Float64Array(4)
  readonly #cell = new Float64Array(PER_CELL)
  readonly #basis = new Float64Array(6)
  readonly #phases = new Float64Array(4)

  constructor(p: AtmosphereParameters) {
    this.#p = p
    this.#sunlight = new Sunlight(p)
    this.#height = homogeneousHeight(p)
    this.#asymmetries = spectrumOf(p.mieAsymmetry)
    this.#mie = this.#asymmetries.map(asymmetryMoments)
  }

  /**
   * Takes a ray whose light is then gathered.
   *
   * @param endAltitude - At the end of the ray, from which its steps are chosen.
   */
  follow(
    radius: number,
    cosView: number,
    distance: number,
    endAltitude: number,
    steps: number
  ): void {
    const p = this.#p
    this.#start = { radius, cosView, distance }
    this.#nodes = []
    const depth = [0, 0, 0, 0]
    const rise = endAltitude - (radius - p.bottomRadius)
    const growth = Math.min(Math.max((0.3 * rise) / this.#height, -4), 4)
    const exponent = Math.abs(growth) < 0.05 ? 0.05 : growth
    const at = (x: number): number => (distance * Math.expm1(exponent * x)) / Math.expm1(exponent)
    for (let step = 0; step < steps; step++) {
      const start = at(step / steps)
      const half = (at((step + 1) / steps) - start) / 2
      const places = [1 - 1 / Math.sqrt(3), 1 + 1 / Math.sqrt(3)].map(place => {
        const t = start + half * place
        const r = Math.sqrt(radius ** 2 + 2 * radius * cosView * t + t ** 2)
        const altitude = Math.max(r - p.bottomRadius, 0)
        const density = densities(p, altitude)
        return { place, t, r, altitude, density, extinctions: extinction(p, density) }
      })
      const [first, second] = places.map(({ extinctions }) => extinctions)
      for (const { place, t, r, altitude, density } of places) {
        // Extinction as the line through both nodes, integrated from the step's start.
        const passing = depth.map((value, i) => {
          const mean = (first[i] + second[i]) / 2
          const slope = ((second[i] - first[i]) * Math.sqrt(3)) / 2
          const before = half * (mean * place + (slope * ((place - 1) ** 2 - 1)) / 2)
          return half * Math.exp(-value - Math.max(before, 0))
        })
        this.#nodes.push({
          distance: t,
          radius: r,
          cosView: (radius * cosView + t) / r,
          row: rowOf(p, altitude),
          molecules: Float64Array.from(passing, (x, i) => x * p.rayleighScattering[i] * density[0]),
          aerosols: Float64Array.from(passing, (x, i) => x * p.mieScattering[i] * density[1])
        })
      }
      for (let i = 0; i < 4; i++) depth[i] += half * (first[i] + second[i])
    }
    depth.forEach((value, i) => (this.#transmittance[i] = Math.exp(-value)))
  }

  /** Moments of light scattered before at a point, into the scratch cell. */
  #lookUp(light: Float64Array, row: number, cosLight: number): void {
    const x = diffuseColumn(cosLight) * (COLUMNS - 1)
    interpolate(light, COLUMNS, ROWS, PER_CELL, x, row, this.#cell)
  }

  /** Adds light that air scatters into the ray at a node from the sun. */
  #addSunlight(node: RayNode, cosLight: number, molecularPhase: number): void {
    this.#sunlight.transmittance(node.radius, cosLight, this.#sun)
    for (let i = 0; i < 4; i++) {
      const scattered = node.molecules[i] * molecularPhase + node.aerosols[i] * this.#phases[i]
      this.radiance[i] += scattered * this.#sun[i]
    }
  }

  /** Adds light that air scatters into the ray at a node after it was scattered before. */
  #addDiffuse(node: RayNode, light: Float64Array, cosLight: number, cosViewLight: number): void {
    this.#lookUp(light, node.row, cosLight)
    harmonics(node.cosView, cosLight, cosViewLight, this.#basis)
    const [cell, basis] = [this.#cell, this.#basis]
    for (let i = 0; i < 4; i++) {
      const mean = cell[i] * basis[0]
      const first = cell[4 + i] * basis[1] + cell[8 + i] * basis[2]
      const second = cell[12 + i] * basis[3] + cell[16 + i] * basis[4] + cell[20 + i] * basis[5]
      const [, weight1, weight2] = this.#mie[i]
      // Legendre coefficients of molecules are 1, 0 and 0.1.
      this.radiance[i] +=
        node.molecules[i] * (mean + 0.1 * second) +
        node.aerosols[i] * (mean + weight1 * first + weight2 * second)
    }
  }

  /** Gathers light scattered in the ray from the sun or, with `light`, from what that holds. */
  gather(light: Float64Array | null, cosLight: number, cosViewLight: number): void {
    this.radiance.fill(0)
    const { radius } = this.#start
    const molecularPhase = rayleighPhase(cosViewLight)
    for (let i = 0; i < 4; i++) {
      this.#phases[i] = cornetteShanksPhase(this.#asymmetries[i], cosViewLight)
    }
    for (const node of this.#nodes) {
      const cosThere = (radius * cosLight + node.distance * cosViewLight) / node.radius
      const cosLightThere = Math.min(Math.max(cosThere, -1), 1)
      if (light === null) this.#addSunlight(node, cosLightThere, molecularPhase)
      else this.#addDiffuse(node, light, cosLightThere, cosViewLight)
    }
  }

  /** Adds the light of Lambertian ground at the end of the ray. */
  addGround(light: Float64Array | null, cosLight: number, cosViewLight: number): void {
    const p = this.#p
    const { radius, distance } = this.#start
    const cosThere = (radius * cosLight + distance * cosViewLight) / p.bottomRadius
    if (light === null) this.#sunlight.transmittance(p.bottomRadius, cosThere, this.#sun)
    else this.#lookUp(light, 0, cosThere)
    for (let i = 0; i < 4; i++) {
      const irradiance = light === null ? this.#sun[i] * Math.max(cosThere, 0) : this.#cell[24 + i]
      const reflected = (irradiance * p.groundAlbedo[i]) / Math.PI
      this.radiance[i] += reflected * this.#transmittance[i]
    }
  }
}

/** Row of an altitude in the table. */
function rowOf({ topRadius, bottomRadius }: AtmosphereParameters, altitude: number): number {
  const part = Math.min(Math.max(altitude / (topRadius - bottomRadius), 0), 1)
  return Math.sqrt(part) * (ROWS - 1)
}

/** The six basis functions that go with moments that were divided by powers of sin θ_s. */
function harmonics(
  cosView: number,
  cosLight: number,
  cosViewLight: number,
  target: Float64Array
): void {
  const along = cosViewLight - cosView * cosLight
  const squares = (1 - cosView ** 2) * (1 - cosLight ** 2)
  target[0] = Y0
  target[1] = Y1 * cosView
  target[2] = Y1 * along
  target[3] = (Y2 / Math.sqrt(12)) * (3 * cosView ** 2 - 1)
  target[4] = Y2 * cosView * along
  target[5] = (Y2 / 2) * (2 * along ** 2 - squares)
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
  const cosines = Array.from({ length: COLUMNS }, (_, column) =>
    Math.min(diffuseColumnCosine(column), 0.9998)
  )
  const weights = new Float64Array(DIFFUSE_TILES)
  for (let row = 0; row < ROWS; row++) {
    const part = row / (ROWS - 1)
    const radius = p.bottomRadius + Math.max((p.topRadius - p.bottomRadius) * part ** 2, 1)
    const dip = Math.acos(p.bottomRadius / radius)
    for (let direction = 0; direction < 2 * elevations; direction++) {
      const up = direction < elevations
      const x = rule.nodes[direction % elevations]
      const span = Math.PI / 2 + (up ? dip : -dip)
      const angle = span * (0.3 * x + 0.7 * x * x)
      const elevation = (up ? angle : -angle) - dip
      const level = Math.cos(elevation)
      const width = span * (0.3 + 1.4 * x) * rule.weights[direction % elevations]
      const weight = (width * level * 2 * Math.PI) / azimuths
      const cosView = Math.sin(elevation)
      const distance = up
        ? distanceToTop(radius, cosView, p.topRadius)
        : distanceToGround(radius, cosView, p.bottomRadius)
      gatherer.follow(radius, cosView, distance, up ? p.topRadius - p.bottomRadius : 0, steps)
      for (const [column, cosLight] of cosines.entries()) {
        const sinLight = Math.sqrt(1 - cosLight ** 2)
        const start = (row * COLUMNS + column) * PER_CELL
        for (let azimuth = 0; azimuth < azimuths; azimuth++) {
          const towards = level * Math.cos((Math.PI * (azimuth + 0.5)) / azimuths)
          const cosViewLight = Math.min(Math.max(towards * sinLight + cosView * cosLight, -1), 1)
          gatherer.gather(light, cosLight, cosViewLight)
          if (!up) gatherer.addGround(light, cosLight, cosViewLight)
          harmonics(cosView, cosLight, cosViewLight, weights)
          // They have powers of sin θ_s in them that the moments must be rid of.
          weights[2] /= sinLight ** 2
          weights[4] /= sinLight ** 2
          weights[5] /= sinLight ** 4
          weights[6] = Math.max(cosView, 0)
          weights[7] = Math.max(-cosView, 0)
          for (let tile = 0; tile < DIFFUSE_TILES; tile++) {
            for (let i = 0; i < 4; i++) {
              result[start + 4 * tile + i] += weights[tile] * weight * gatherer.radiance[i]
            }
          }
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

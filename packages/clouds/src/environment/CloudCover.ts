import type { CloudedPoint, CloudedSky } from '@welkin/atmosphere'
import { checkOptions, fail } from '@welkin/geo'
import { CloudLayers } from '../layers/CloudLayers'
import { columnDensityAt, meanColumnOf } from '../layers/meanColumn'
import { regionalCoverages } from '../layers/regionalCoverages'
import { CloudLightTable } from '../light/CloudLightTable'
import { fallColumnOf, fallDepthOver } from '../precipitation/cpu/fallColumn'
import { fairWeatherPhase, scalePhase } from '../light/cpu/cloudPhase'
import { deckFootprint, stackDecks, type BrokenClouds, type CloudDeck } from './cpu/decks'
import { cloudyIrradiance } from './cpu/overcast'

/** Options of {@link CloudCover}. */
export interface CloudCoverOptions {
  /** Light table, whose droplets count: `cloudsNode.light`, shared, not owned; left out, those of fair weather. */
  light?: CloudLightTable
}

/** Clouds above or below a place, and the altitude of their tops; its own where there are none [m]. */
type PlacedDeck = CloudDeck & { readonly top: number }

/**
 * Clouds in questions about light, answered on the CPU: give it as `clouds` to `skyIlluminanceAt`, `sunIlluminanceAt`,
 * `moonIlluminanceAt` and `exposureFor`.
 *
 * ```ts
 * const cover = new CloudCover(layers)
 * atmosphere.luminanceScale = 1e-4 * exposureFor(atmosphere, camera, { clouds: cover })
 * ```
 *
 * It is the mean over the planet of what `cloudSkyLight` and `cloudShadow` have, with the layers' precipitation; single clouds and a map of the world
 * have no part in it, nor have layers whose `shadow` is false.
 */
export class CloudCover implements CloudedSky {
  /** Shared, not owned; they may change at any time. */
  readonly layers: CloudLayers
  readonly light: CloudLightTable | null

  /** @throws If an argument is missing or of the wrong kind. */
  constructor(layers: CloudLayers, options: CloudCoverOptions = {}) {
    if (!(layers instanceof CloudLayers)) fail('CloudCover', 'layers must be CloudLayers', layers)
    const { light } = checkOptions('CloudCover', options, 'light')
    if (light !== undefined && !(light instanceof CloudLightTable)) {
      fail('CloudCover', 'light must be a CloudLightTable', light)
    }
    this.layers = layers
    this.light = light ?? null
  }

  beam({ altitude, cosLight }: Pick<CloudedPoint, 'altitude' | 'cosLight'>): number {
    return this.#decks(altitude, cosLight)?.above.beam ?? 1
  }

  irradiance(point: CloudedPoint, cosNormal: number, clear: readonly number[]): readonly number[] {
    const { altitude, cosLight, groundAlbedo } = point
    const decks = this.#decks(altitude, cosLight)
    if (decks === null) return clear
    const { above, below } = decks
    const direct = { above: point.direct(above.top), below: point.direct(below.top) }
    const [here, onClouds] = [point.diffuse(altitude), point.diffuse(below.top)]
    return clear.map((plane, i) => {
      const light = {
        direct: { above: direct.above[i], below: direct.below[i] },
        sky: { here: here.up[i], below: onClouds.up[i] },
        ground: here.down[i],
        plane,
        albedo: groundAlbedo[i]
      }
      return cloudyIrradiance(light, above, below, cosNormal)
    })
  }

  /** Clouds above and below an altitude [m], null if there are none: float64 of `meanDecks` in tsl/decks.ts. */
  #decks(altitude: number, cosLight: number): { above: PlacedDeck; below: PlacedDeck } | null {
    const { depthScale, moments } = scalePhase(this.light?.phase ?? fairWeatherPhase)
    const oneMinusAsymmetry = 1 - moments[1]
    const parts = [...this.layers].flatMap(({ parameters }) => {
      const { baseAltitude, topAltitude, coverage, density, shadow } = parameters
      if (!shadow || coverage === 0) return []
      const column = meanColumnOf(parameters, depthScale)
      const thickness = topAltitude - baseAltitude
      const over = Math.min(Math.max(topAltitude - altitude, 0), thickness)
      const rise = Math.abs((baseAltitude + topAltitude) / 2 - altitude)
      const covers = regionalCoverages(parameters, deckFootprint(rise))
      const falls = fallColumnOf(parameters)
      const [fallOver, fallAll] = [altitude, -Infinity].map(at => falls && fallDepthOver(falls, at))
      const part = (length: number, depth: number): BrokenClouds[] =>
        covers.map(cover => ({
          coverage: cover,
          thickness: density * columnDensityAt(column, cover) * depthScale * length,
          fall: { share: falls?.share ?? 0, thickness: depth }
        }))
      return {
        top: topAltitude,
        over: part(over, fallOver ?? 0),
        under: part(thickness - over, (fallAll ?? 0) - (fallOver ?? 0))
      }
    })
    if (parts.length === 0) return null
    /** Tops count by how much light their layer takes. */
    const deck = (side: 'over' | 'under', highest: number): PlacedDeck => {
      const series = parts.map(
        part => 1 / stackDecks([part[side]], cosLight, oneMinusAsymmetry).diffuse - 1
      )
      const sum = series.reduce((total, value) => total + value, 0)
      const tops = parts.reduce(
        (total, { top }, i) => total + series[i] * Math.min(top, highest),
        0
      )
      const layers = parts.map(part => part[side])
      return {
        ...stackDecks(layers, cosLight, oneMinusAsymmetry),
        top: sum > 1e-6 ? tops / sum : altitude
      }
    }
    return { above: deck('over', Infinity), below: deck('under', altitude) }
  }
}

import { MathUtils } from 'three'
import type { CloudLayerParameters } from '../../layers/CloudLayer'
import { dry } from '../../layers/precipitation'
import { DIFFRACTED, extinctionForm, fallForm } from '../fallForm'

/** Rain and snow under the columns of a layer from which they fall, in the mean, for the light of the sky. */
export interface FallColumn {
  /** Share of the clouded columns. */
  readonly share: number
  /** Altitude above which nothing falls [m]. */
  readonly ceiling: number
  /** Optical depths of the three thirds of the path down to altitude 0, from above, without what is only diffracted. */
  readonly parts: readonly [number, number, number]
}

/** Ranks of columns, and altitudes of a third, over which means are taken. */
const RANKS = 16
const ALTITUDES = 8

/** Extinction by a column of a rank at an altitude [1/m]: float64 of `fallenFrom` and `fallExtinction` of tsl/fall.ts, without streaks. */
function extinctionOf(layer: CloudLayerParameters, rank: number, altitude: number): number {
  const { baseAltitude: base, topAltitude } = layer
  const { rate, virgaDepth, freezingLevel, hail } = { ...dry, ...layer.precipitation }
  const { core, evaporation: b, onset, melting, hailFrom } = fallForm
  const falling = (core + 1) * rate * rank ** core
  const depth = Math.max(base - altitude, 0)
  const evaporated = virgaDepth > 0 ? (rate ** b * depth) / virgaDepth : 0
  const left = Math.max(falling ** b - evaporated, 0) ** (1 / b)
  const begun = MathUtils.clamp(1 - (altitude - base) / ((topAltitude - base) * onset), 0, 1)
  const stones = left * begun * hail * MathUtils.smoothstep(rank, ...hailFrom)
  const drops = left * begun - stones
  const snow = MathUtils.smoothstep(altitude, freezingLevel - melting, freezingLevel)
  const of = ([factor, exponent]: readonly [number, number]): number => factor * drops ** exponent
  const perKm = MathUtils.lerp(of(extinctionForm.rain), of(extinctionForm.snow), snow)
  return (perKm + extinctionForm.hail * stones) / 1000
}

/** Rain and snow from a layer, in the mean over the columns from which it falls; null if nothing does. */
export function fallColumn(layer: CloudLayerParameters): FallColumn | null {
  const { baseAltitude, topAltitude } = layer
  const { rate, share } = { ...dry, ...layer.precipitation }
  if (rate === 0) return null
  const ceiling = baseAltitude + (topAltitude - baseAltitude) * fallForm.onset
  const third = Math.max(ceiling, 1) / 3
  const parts = [0, 1, 2].map(part => {
    let sum = 0
    for (let i = 0; i < RANKS; i++)
      for (let k = 0; k < ALTITUDES; k++)
        sum += extinctionOf(
          layer,
          (i + 0.5) / RANKS,
          ceiling - third * (part + (k + 0.5) / ALTITUDES)
        )
    return (1 - DIFFRACTED) * (sum / RANKS / ALTITUDES) * third
  })
  return { share, ceiling, parts: parts as [number, number, number] }
}

const _columns = new WeakMap<CloudLayerParameters, FallColumn | null>()

/** {@link fallColumn} of parameters that do not change any more, computed once. */
export function fallColumnOf(layer: CloudLayerParameters): FallColumn | null {
  let column = _columns.get(layer)
  if (column === undefined) _columns.set(layer, (column = fallColumn(layer)))
  return column
}

/** Optical depth of what falls over an altitude [m]; in each third it grows evenly on the way down. */
export function fallDepthOver({ ceiling, parts }: FallColumn, altitude: number): number {
  const place = (3 * (ceiling - altitude)) / Math.max(ceiling, 1)
  return parts.reduce((sum, part, i) => sum + part * MathUtils.clamp(place - i, 0, 1), 0)
}

import { withDefaults } from '@welkin/atmosphere'
import { checkRanges } from '../check'

/** Rain, snow and hail from a layer of clouds. */
export interface CloudPrecipitation {
  /**
   * Mean rate under the columns from which it falls, as water, in [0, 300] [mm/h]: drizzle has 0.5, a shower 10, a cloudburst
   * 50. In the strongest columns it is three times as much.
   */
  readonly rate: number
  /**
   * Share of the clouded area from which it falls, in (0, 1]; default 0.5: under the strongest columns; of storms, that part of each, about
   * its tower.
   */
  readonly share?: number
  /**
   * Depth of fall in which rain of the given rate evaporates, in [0, 20,000] [m]: less leaves virga. Heavier rain reaches
   * deeper. Default: 0, none evaporates.
   */
  readonly virgaDepth?: number
  /** Altitude above which it falls as snow, in [−1000, 30,000] [m]; default 2300, that of the standard atmosphere. */
  readonly freezingLevel?: number
  /** Share of the rate that falls as hail where it is heaviest, in [0, 1]; default 0. */
  readonly hail?: number
  /**
   * Factor of the contrast of streaks, in [0, 3]; default 1. 0 makes even curtains, 2 single trails under single cloudlets, as of
   * virga. The mean rate stays; none has more than six times its column's.
   */
  readonly streaks?: number
}

/** Defaults of {@link CloudPrecipitation}. */
export const dry: Required<CloudPrecipitation> = {
  rate: 0,
  share: 0.5,
  virgaDepth: 0,
  freezingLevel: 2300,
  hail: 0,
  streaks: 1
}

const ranges = {
  rate: [0, 300],
  share: [Number.MIN_VALUE, 1],
  virgaDepth: [0, 20_000],
  freezingLevel: [-1000, 30_000],
  hail: [0, 1],
  streaks: [0, 3]
} as const

/**
 * Precipitation with all its parameters, frozen.
 *
 * @param before - The layer's so far, of which what is not given stays.
 * @throws If one is unknown or out of its range.
 */
export function checkedPrecipitation(
  given: CloudPrecipitation,
  before: CloudPrecipitation | null
): Required<CloudPrecipitation> {
  const where = 'CloudLayer.precipitation'
  const all = withDefaults(where, { ...dry, ...before }, given)
  checkRanges(where, all, ranges)
  return Object.freeze(all)
}

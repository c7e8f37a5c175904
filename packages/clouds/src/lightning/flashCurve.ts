import { normal, type Random } from './random'

/** One stroke, or one pulse in a cloud. */
export interface Stroke {
  /** Time after the flash began [s]. */
  readonly time: number
  /** Light that it emits [lm s]. */
  readonly energy: number
  /** True if branches are lit as well: those of the leader, in the first stroke alone. */
  readonly lightsBranches: boolean
}

/** Light of a flash over time. */
export interface FlashCurve {
  readonly strokes: readonly Stroke[]
  /** Continuing current after a stroke: from when, for how long [s], and its light [lm]. */
  readonly continuing: { readonly time: number; readonly duration: number; readonly power: number }
  /** Time after which it is dark [s]. */
  readonly duration: number
}

/** Goal of a flash: to the ground, or from charge to charge in the cloud. */
export type FlashKind = 'ground' | 'cloud'

/**
 * Time constants of a stroke's light: it rises to its peak in 84 µs, and is 0.4 ms wide seen through its cloud.
 *
 * @see Guo & Krider 1982, "The optical and radiation field signatures produced by lightning return strokes", J. Geophys. Res. 87, pp. 8913–8922
 * @see Christian & Goodman 1987, "Optical observations of lightning from a high-altitude airplane", J. Atmos. Oceanic Technol. 4, pp. 701–711
 */
const RISE = 30e-6
const FALL = 400e-6

/** Peak optical power of first and of later strokes, 0.4 to 1.1 µm [W]: Guo & Krider 1982. */
const FIRST_PEAK = 2.3e9
const LATER_PEAK = 4.8e8

/** Luminous efficacy of a body of 20,000 K between 0.4 and 1.1 µm [lm/W]. */
const EFFICACY = 155

/** Light of a continuing current of 150 A, as much per ampere as of a peak of 30 kA [lm] (Shindo & Uman 1989, J. Geophys. Res. 94, 5189). */
const CONTINUING_POWER = (FIRST_PEAK * EFFICACY * 150) / 30_000
/** Share of flashes to the ground that have one, and its mean duration [s]. */
const CONTINUING_SHARE = 0.4
const CONTINUING_DURATION = 0.1

/** Peak over energy of a pulse [1/s]. */
const PEAK_PER_ENERGY = ((): number => {
  const time = (Math.log(FALL / RISE) * FALL * RISE) / (FALL - RISE)
  return (Math.exp(-time / FALL) - Math.exp(-time / RISE)) / (FALL - RISE)
})()

/** Part of a pulse's light that is emitted until a time after its begin [s], in [0, 1]. */
export function emittedUntil(time: number): number {
  if (time <= 0) return 0
  return 1 - (FALL * Math.exp(-time / FALL) - RISE * Math.exp(-time / RISE)) / (FALL - RISE)
}

/**
 * Light of a flash to the ground: a first stroke, later ones 60 ms apart in the geometric mean, and perhaps a continuing current after the
 * last one; or of one in the cloud: more and weaker pulses in a glow.
 *
 * @see Rakov & Uman 2003, "Lightning: physics and effects", tables 1.1 and 4.2
 * @see Zhu et al. 2015, "Some properties of negative cloud-to-ground flashes", J. Atmos. Sol.-Terr. Phys. 136, pp. 16–22: 1085 flashes of 3.3 strokes in
 *   the mean, 62 ms apart in the geometric mean
 */
export function flashCurve(kind: FlashKind, random: Random): FlashCurve {
  const isGround = kind === 'ground'
  const count = isGround ? 3 + Math.floor(2 * random()) : 6 + Math.floor(6 * random())
  const strokes: Stroke[] = []
  let time = 0
  for (let i = 0; i < count; i++) {
    const isFirst = isGround && i === 0
    const peak = (isFirst ? FIRST_PEAK : LATER_PEAK) * Math.exp(0.5 * normal(random) - 0.125)
    const energy = (peak * EFFICACY) / PEAK_PER_ENERGY
    strokes.push({ time, energy, lightsBranches: isFirst || !isGround })
    time += (isGround ? 0.06 : 0.035) * Math.exp(0.4 * normal(random))
  }
  const last = strokes[count - 1].time
  const lasts = isGround
    ? random() < CONTINUING_SHARE
      ? -CONTINUING_DURATION * Math.log(1 - random())
      : 0
    : last
  const continuing = {
    time: isGround ? last : 0,
    duration: lasts,
    power: isGround ? CONTINUING_POWER : CONTINUING_POWER / 2
  }
  return { strokes, continuing, duration: Math.max(last + 10 * FALL, continuing.time + lasts) }
}

/**
 * Light of a flash between two times after its begin: exact integrals [lm s].
 *
 * @returns All of it, and that which branches emit as well.
 */
export function lightBetween(
  { strokes, continuing }: FlashCurve,
  from: number,
  to: number
): { all: number; branches: number } {
  let [all, branches] = [0, 0]
  for (const { time, energy, lightsBranches } of strokes) {
    const light = energy * (emittedUntil(to - time) - emittedUntil(from - time))
    all += light
    if (lightsBranches) branches += light
  }
  const { time, duration, power } = continuing
  const lit = Math.min(to, time + duration) - Math.max(from, time)
  return { all: all + power * Math.max(lit, 0), branches }
}

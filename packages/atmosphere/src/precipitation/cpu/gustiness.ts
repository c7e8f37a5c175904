/** Periods of gusts [s], about those between which wind near the ground changes most (van der Hoven 1957), and their phases. */
const waves = [
  [97, 0.3],
  [53, 2.1],
  [29, 4.4],
  [13, 1.2],
  [5.3, 5.2]
] as const

const amplitude = Math.sqrt(2 / waves.length)

/**
 * Gusts: deviation of the wind's speed from its mean, of standard deviation 1, and its integral since time 0.
 *
 * @param time - Time [s].
 * @returns Deviation [–] and its integral [s].
 */
export function gustiness(time: number): { speed: number; way: number } {
  let speed = 0
  let way = 0
  for (const [period, phase] of waves) {
    const frequency = (2 * Math.PI) / period
    speed += amplitude * Math.sin(frequency * time + phase)
    way -= (amplitude / frequency) * (Math.cos(frequency * time + phase) - Math.cos(phase))
  }
  return { speed, way }
}

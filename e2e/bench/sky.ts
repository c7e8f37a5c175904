import { airglow, milkyWay, moon, stars, sunFlare } from '@welkin/atmosphere'
import type { Atmosphere } from '@welkin/atmosphere'
import { PerspectiveCamera, Vector3 } from 'three'
import type { HeadlessDevice } from '../headless/device'
import { timeFrame } from './frame'
import { placeCamera, type Path } from './scene'

/** Height of the camera [m]. */
const ALTITUDE = 2

/** Milliseconds of GPU that each part of a sky adds to the parts before it. */
export interface SkyCost {
  path: Path
  name: string
  /** All of the scene with its air, without other parts. */
  bareMs: number
  /** Sun's flare, full moon without its light in the air, and 5,044 stars: the goal's figure. */
  sunMoonStarsMs: number
  /** The air in the light of the moon. */
  moonlitAirMs: number
  milkyWayMs: number
  airglowMs: number
  /** The whole frame with all of it. */
  wholeMs: number
}

interface SkyCase {
  name: string
  /** Elevation of the sun [°]. */
  elevation: number
  /** True if the moon is in the picture rather than opposite the sun. */
  showsMoon?: boolean
}

const CASES: SkyCase[] = [
  { name: 'day', elevation: 40 },
  { name: 'day, sun in view', elevation: 12 },
  { name: 'dusk', elevation: -6 },
  { name: 'night', elevation: -40 },
  { name: 'night, moon in view', elevation: -40, showsMoon: true }
]

/** Some way off the middle of the picture, 12° high [world]. */
function inView(): Vector3 {
  const camera = new PerspectiveCamera()
  placeCamera(camera, ALTITUDE)
  const forward = camera.getWorldDirection(new Vector3())
  const right = new Vector3().crossVectors(forward, camera.up)
  return forward.addScaledVector(camera.up, 0.21).addScaledVector(right, 0.2).normalize()
}

/** Layers one after another, far to near. */
function parts({ showsMoon = false }: SkyCase): ((atmosphere: Atmosphere) => void)[] {
  const luna = (lightsAir: boolean) =>
    moon({ lightsAir, phase: 0.5, direction: showsMoon ? inView() : null })
  return [
    () => undefined,
    sky => sky.add(sunFlare(), stars(), luna(false)),
    sky => sky.add(sunFlare(), stars(), luna(true)),
    sky => sky.add(sunFlare(), milkyWay(), stars(), luna(true)),
    sky => sky.add(sunFlare(), milkyWay(), stars(), luna(true), airglow())
  ]
}

/** Times the sky of day, dusk and night, part by part. */
export async function timeSky(
  device: HeadlessDevice,
  size: readonly [number, number],
  frames: number,
  paths: readonly Path[],
  cases: readonly SkyCase[] = CASES
): Promise<SkyCost[]> {
  const costs: SkyCost[] = []
  for (const path of paths) {
    for (const sky of cases) {
      const times: number[] = []
      for (const decorate of parts(sky)) {
        const { elevation } = sky
        const timed = { path, altitude: ALTITUDE, decorate, elevation }
        times.push((await timeFrame(device, size, frames, timed)).gpu)
      }
      const [bareMs, withStars, withMoonlight, withMilkyWay, wholeMs] = times
      costs.push({
        path,
        name: sky.name,
        bareMs,
        sunMoonStarsMs: withStars - bareMs,
        moonlitAirMs: withMoonlight - withStars,
        milkyWayMs: withMilkyWay - withMoonlight,
        airglowMs: wholeMs - withMilkyWay,
        wholeMs
      })
    }
  }
  return costs
}

/** A line of a report. */
export function skyLine(cost: SkyCost): string {
  const ms = (value: number): string => value.toFixed(3)
  return (
    `${cost.path.padEnd(8)} ${cost.name.padEnd(20)} air ${ms(cost.bareMs)}` +
    `   + sun, moon, stars ${ms(cost.sunMoonStarsMs)}   + moonlit air ${ms(cost.moonlitAirMs)}` +
    `   + Milky Way ${ms(cost.milkyWayMs)}   + airglow ${ms(cost.airglowMs)}` +
    `   whole ${ms(cost.wholeMs)} ms`
  )
}

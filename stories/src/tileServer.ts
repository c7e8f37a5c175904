import { tileUrl } from '@welkin/terrain'

/** Time in which a server must answer [ms]. */
const PATIENCE = 6000

/** Coarsest levels that a source of tiles may begin with. */
const LEVELS = [0, 1, 2, 3, 4, 5, 6, 7, 8]

/** Answer of a server of tiles: its coarsest level, or a reason why its tiles cannot be used. */
export type ServerAnswer = { minZoom: number } | { problem: string }

/** Column and row of the Web Mercator tile around a place [°]. */
function tileAround(longitude: number, latitude: number, zoom: number): [number, number] {
  const sine = Math.sin((latitude * Math.PI) / 180)
  const x = longitude / 360 + 0.5
  const y = 0.5 - Math.log((1 + sine) / (1 - sine)) / (4 * Math.PI)
  return [Math.floor(x * 2 ** zoom), Math.floor(y * 2 ** zoom)]
}

/**
 * Asks a server of tiles for its coarsest level: many begin with one that is not 0.
 *
 * @param template - With {z}, {x} and {y}.
 * @param place - Place that its tiles must show [°].
 */
export async function askServer(
  template: string,
  place: { longitude: number; latitude: number }
): Promise<ServerAnswer> {
  let problem = ''
  for (const zoom of LEVELS) {
    try {
      const [x, y] = tileAround(place.longitude, place.latitude, zoom)
      const response = await fetch(tileUrl(template)(zoom, x, y), {
        signal: AbortSignal.timeout(PATIENCE)
      })
      if (response.ok) return { minZoom: zoom }
      problem ||= `the server answers ${response.status}`
    } catch (error) {
      // No answer at all: finer levels have none either.
      return { problem: error instanceof Error ? error.message : String(error) }
    }
  }
  return { problem }
}

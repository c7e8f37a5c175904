import type { Atmosphere } from '@welkin/atmosphere'
import type { CloudField } from '@welkin/clouds'
import { Ellipsoid } from '@welkin/geo'
import type { GeodeticLike } from '@welkin/geo'
import {
  ClampToEdgeWrapping,
  Data3DTexture,
  LinearFilter,
  RedFormat,
  RepeatWrapping,
  Vector3
} from 'three'
import type { Camera } from 'three'
import { float, texture3D, uniform, vec2, vec3 } from 'three/tsl'

/** Cells of the simulation, east, north and up, which repeat east and north, and their size [m]. */
const CELLS = { x: 640, y: 640, z: 128, size: 10 } as const

/** Steps that extinction is stored in, and the greatest [1/m]. */
const STEPS = 31
export const MOST_EXTINCTION = 0.226

/** Thickness of the simulated layer [m]. */
export const SIMULATED_THICKNESS = CELLS.z * CELLS.size

/** Extinction of trade-wind cumulus, out of a large-eddy simulation: {@link MOST_EXTINCTION} is 1. */
export async function loadSimulation(): Promise<Data3DTexture> {
  const url = new URL('world-data/simulated/simulated-clouds.bin', document.baseURI)
  const response = await fetch(url)
  if (!response.ok || response.body === null) throw new Error(`${url.href}: ${response.status}`)
  const cells = response.body.pipeThrough(new DecompressionStream('gzip'))
  const bytes = new Uint8Array(await new Response(cells).arrayBuffer())
  for (let i = 0; i < bytes.length; i++) bytes[i] = (255 * bytes[i]) / STEPS
  const map = new Data3DTexture(bytes, CELLS.x, CELLS.y, CELLS.z)
  map.format = RedFormat
  map.minFilter = map.magFilter = LinearFilter
  map.wrapS = map.wrapT = RepeatWrapping
  map.wrapR = ClampToEdgeWrapping
  map.needsUpdate = true
  return map
}

/**
 * Has a field draw a simulation in place of weather and noise.
 *
 * @param base - Corner of the simulation, at the altitude of its lowest cells.
 * @returns A function that follows a camera in an ECEF world.
 */
export function drawSimulation(
  map: Data3DTexture,
  atmosphere: Atmosphere,
  field: CloudField,
  base: Required<GeodeticLike>
): (camera: Camera) => void {
  const cells = texture3D(map)
  const frame = Ellipsoid.WGS84.eastNorthUpFrame(Ellipsoid.WGS84.geodeticToECEF(base))
  const toFrame = frame.clone().invert()
  const axis = (column: number) => {
    const direction = new Vector3().setFromMatrixColumn(frame, column)
    return uniform(atmosphere.space.direction(direction, new Vector3()).normalize())
  }
  const [east, north] = [axis(0), axis(1)]
  const origin = uniform(new Vector3())
  field.givenExtinction = offset => {
    const { altitude } = field.view.localCoordinates(offset)
    const across = vec2(offset.dot(east), offset.dot(north)).add(origin.xy)
    const size = [CELLS.x, CELLS.y, CELLS.z].map(cells => cells * CELLS.size)
    const place = vec3(across, altitude.sub(base.height)).div(vec3(size[0], size[1], size[2]))
    return cells.sample(place).level(float(0)).x.mul(MOST_EXTINCTION).toConst()
  }
  return camera => {
    origin.value.copy(camera.position).applyMatrix4(toFrame)
  }
}

import type { Atmosphere } from '@welkin/atmosphere'
import type { CloudSample } from '@welkin/clouds'
import { Ellipsoid } from '@welkin/geo'
import type { GeodeticLike } from '@welkin/geo'
import {
  ClampToEdgeWrapping,
  Data3DTexture,
  LinearFilter,
  Matrix4,
  RedFormat,
  RepeatWrapping,
  Vector3
} from 'three'
import type { Camera } from 'three'
import { float, texture3D, uniform, vec2, vec3 } from 'three/tsl'
import type { Node } from 'three/webgpu'

/** Cells of the simulation, east, north and up, which repeat east and north, and their size [m]. */
const CELLS = { x: 640, y: 640, z: 128, size: 10 } as const

/** Steps that extinction is stored in, and the greatest [1/m]. */
const STEPS = 31
export const MOST_EXTINCTION = 0.226

/** Thickness of the simulated layer [m]. */
export const SIMULATED_THICKNESS = CELLS.z * CELLS.size

const SIZE = new Vector3(CELLS.x, CELLS.y, CELLS.z).multiplyScalar(CELLS.size)

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

/** A simulation on a place, for a camera in an ECEF world. */
export class SimulatedClouds {
  readonly #cells
  readonly #base: Required<GeodeticLike>
  readonly #toFrame = new Matrix4()
  readonly #east
  readonly #north
  /** The camera in the frame of the simulation: east, north, up [m]. */
  readonly #camera = uniform(new Vector3())

  /** @param base - Corner of the simulation, at the altitude of its lowest cells. */
  constructor(map: Data3DTexture, { space }: Atmosphere, base: Required<GeodeticLike>) {
    this.#cells = texture3D(map)
    this.#base = base
    const { WGS84 } = Ellipsoid
    const frame = WGS84.eastNorthUpFrame(WGS84.geodeticToECEF(base))
    this.#toFrame.copy(frame).invert()
    const axis = (column: number) => {
      const direction = new Vector3().setFromMatrixColumn(frame, column)
      return uniform(space.direction(direction, new Vector3()).normalize())
    }
    this.#east = axis(0)
    this.#north = axis(1)
  }

  /** Extinction at a place [1/m], as `clouds` takes it. */
  readonly extinction = ({ offset, altitude }: CloudSample): Node<'float'> => {
    const across = vec2(offset.dot(this.#east), offset.dot(this.#north)).add(this.#camera.xy)
    const place = vec3(across, altitude.sub(this.#base.height)).div(vec3(SIZE))
    return this.#cells.sample(place).level(float(0)).x.mul(MOST_EXTINCTION)
  }

  follow({ position }: Camera): void {
    this.#camera.value.copy(position).applyMatrix4(this.#toFrame)
  }
}

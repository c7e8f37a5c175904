import { Atmosphere, type AtmosphereView } from '@welkin/atmosphere'
import { CloudField, cloudWorldMap, type CloudLayers } from '@welkin/clouds'
import {
  DataTexture,
  LinearFilter,
  LinearMipmapLinearFilter,
  PerspectiveCamera,
  RepeatWrapping,
  Vector3
} from 'three'
import type { Node, NodeFrame, WebGPURenderer } from 'three/webgpu'
import type { CloudState } from '../../../packages/clouds/test/twins/density'
import { cloudExtinction } from './cloud-extinction'
import { random } from './atmosphere'
import type { GpuContext } from './context'
import { expectTrue } from './expect'

export const mean = (values: ArrayLike<number>): number =>
  Array.from(values).reduce((a, b) => a + b, 0) / values.length

/** Degrees, metres. */
export type Place = { longitude: number; latitude: number; height?: number }

/** Clouds whose noise is drawn. */
export interface CloudScene {
  renderer: WebGPURenderer
  field: CloudField
  /** The camera from the planet's centre, in the mapped space. */
  viewpoint: Vector3
  /** Takes the camera's frame. @returns Its view. */
  update: (seconds?: number) => AtmosphereView
  extinction: (offset: Node<'vec3'>, distance: Node<'float'>, detail: boolean) => Node<'float'>
  state: () => CloudState
  dispose: () => void
}

/** Clouds whose noise is not drawn, for what needs none: streaks and shapes are even. */
export async function evenClouds(
  t: GpuContext,
  layers: CloudLayers,
  place: Place,
  map: DataTexture | null = null
): Promise<Pick<CloudScene, 'renderer' | 'field' | 'update' | 'dispose'>> {
  const renderer = await t.createRenderer()
  const atmosphere = new Atmosphere().place(place)
  const camera = new PerspectiveCamera()
  const field = new CloudField(atmosphere, layers, undefined, {
    worldMap: map && cloudWorldMap(map)
  })
  return {
    renderer,
    field,
    update(seconds = 0) {
      const view = atmosphere.update(renderer, camera)
      field.view.update({ renderer, camera } as unknown as NodeFrame)
      field.update(view, seconds)
      return view
    },
    dispose() {
      field.dispose()
      atmosphere.dispose()
    }
  }
}

/** Baked clouds, seen from a place. */
export async function cloudScene(
  t: GpuContext,
  layers: CloudLayers,
  place: Place,
  map: DataTexture | null = null
): Promise<CloudScene> {
  const even = await evenClouds(t, layers, place, map)
  const { renderer, field } = even
  const { atmosphere } = field
  const viewpoint = new Vector3()
  const update = (seconds = 0): AtmosphereView => {
    const view = even.update(seconds)
    viewpoint.copy(view.up).multiplyScalar(atmosphere.parameters.bottomRadius + view.height)
    return view
  }
  update()
  expectTrue(field.values[0].z === 0, 'clouds before their noise is drawn')
  field.bake(renderer)
  update()
  expectTrue(field.values[0].z > 0, 'no clouds when their noise is drawn')
  return {
    renderer,
    field,
    viewpoint,
    update,
    extinction(offset, distance, detail) {
      const { altitude, up } = field.view.localCoordinates(offset)
      return cloudExtinction(field, { offset, altitude, up, distance }, detail)
    },
    state: () => ({
      layers: [...layers].map(layer => layer.parameters),
      rotations: field.rotations,
      bottomRadius: atmosphere.parameters.bottomRadius,
      zenith: viewpoint.clone().normalize(),
      pixelAngle: field.pixelAngle.value,
      depthScale: field.depthScale.value,
      axialRatio: field.axialRatio,
      ...(map === null ? {} : { worldMap: coverOf(map), worldMapWidth: map.image.width })
    }),
    dispose: even.dispose
  }
}

/** A cover that is smooth on the sphere, as an equirectangular picture. */
export function worldMap(): DataTexture {
  const [width, height] = [512, 256]
  const bytes = new Uint8Array(4 * width * height)
  for (let y = 0; y < height; y++) {
    for (let x = 0; x < width; x++) {
      const longitude = ((x + 0.5) / width - 0.5) * 2 * Math.PI
      const latitude = ((y + 0.5) / height - 0.5) * Math.PI
      const across = Math.cos(latitude)
      const wave = Math.sin(3 * across * Math.cos(longitude) + 2 * across * Math.sin(longitude) + 1)
      bytes[4 * (y * width + x)] = 255 * (0.5 + 0.4 * wave)
    }
  }
  const map = new DataTexture(bytes, width, height)
  map.minFilter = LinearMipmapLinearFilter
  map.magFilter = LinearFilter
  map.generateMipmaps = true
  map.wrapS = RepeatWrapping
  map.needsUpdate = true
  return map
}

/** Look-up of a map's finest level as the GPU does it, by longitude and latitude [rad]. */
function coverOf(map: DataTexture): (longitude: number, latitude: number) => number {
  const { data, width, height } = map.image
  const texel = (x: number, y: number): number => {
    const row = Math.min(Math.max(y, 0), height - 1)
    return Number(data?.[4 * (row * width + ((x + width) % width))]) / 255
  }
  return (longitude, latitude) => {
    const x = (longitude / (2 * Math.PI) + 0.5) * width - 0.5
    const y = (latitude / Math.PI + 0.5) * height - 0.5
    const [i, j] = [Math.floor(x), Math.floor(y)]
    const row = (k: number): number => texel(i, k) + (texel(i + 1, k) - texel(i, k)) * (x - i)
    return row(j) + (row(j + 1) - row(j)) * (y - j)
  }
}

/** Offsets from a viewpoint to points at random altitudes, up to a horizontal distance away. */
export function offsets(
  viewpoint: Vector3,
  count: number,
  maximumDistance: number,
  seed: number,
  altitude = (share: number): number => 12_000 * share ** 2
): number[][] {
  const draw = random(seed)
  const up = viewpoint.clone().normalize()
  const side = new Vector3(up.y, up.z, up.x).cross(up).normalize()
  const other = side.clone().cross(up)
  const ground = viewpoint.length()
  return Array.from({ length: count }, () => {
    const angle = 2 * Math.PI * draw()
    const away = maximumDistance * Math.sqrt(draw())
    const point = viewpoint
      .clone()
      .addScaledVector(side, away * Math.cos(angle))
      .addScaledVector(other, away * Math.sin(angle))
      .setLength(ground + altitude(draw()))
      .sub(viewpoint)
    return [...point.toArray(), point.length()].map(Math.fround)
  })
}

/** Places on the planet where maps and noise have their edges. */
export const places: [string, Place][] = [
  ['in Europe', { longitude: 20, latitude: 45 }],
  ['at the date line', { longitude: 180, latitude: -17 }],
  ['at the pole', { longitude: 0, latitude: 90 }]
]

/** Altitudes in one of the layers each, by a number in [0, 1). */
export const altitudeIn =
  (layers: CloudLayers) =>
  (share: number): number => {
    const place = layers.length * share
    const { baseAltitude, topAltitude } = layers.at(Math.floor(place)).parameters
    return baseAltitude + (topAltitude - baseAltitude) * (place % 1)
  }

import { airlessParameters, Atmosphere } from '@welkin/atmosphere'
import {
  CloudField,
  CloudLayers,
  cloudQualities,
  CloudLightTable,
  CloudNoise,
  type CloudQualityName
} from '@welkin/clouds'
import {
  ClampToEdgeWrapping,
  Data3DTexture,
  FloatType,
  LinearFilter,
  PerspectiveCamera,
  RedFormat,
  RenderTarget,
  UnsignedByteType,
  Vector3
} from 'three'
import { Fn, float, screenCoordinate, texture3D, uniform, vec3, vec4 } from 'three/tsl'
import type { NodeFrame, WebGPURenderer } from 'three/webgpu'
import { FragmentPass } from '../../../packages/atmosphere/src/tables/FragmentPass'
import { viewNodes, type ViewNodes } from '../../../packages/atmosphere/src/view/ViewNodes'
import { QualityUniforms } from '../../../packages/clouds/src/march/quality'
import { litClouds } from '../../../packages/clouds/src/march/tsl/shadePoints'
import { CloudShadowMap } from '../../../packages/clouds/src/shadow/CloudShadowMap'
import { interleavedNoise } from '../../../packages/clouds/src/temporal/tsl/noisePattern'
import type { Float, LevelTexture, Vec2, Vec3 } from '../../../packages/clouds/src/tsl-types'
import { createContext } from '../../gpu/harness/context'
import { readPicture } from '../../gpu/harness/picture'
import type { Backend } from '../../harness/backend'

/** A cloud of voxels, and the pictures that are wanted of it. */
export interface CloudLightRequest {
  backend: Backend
  quality: CloudQualityName
  /** Voxels, bytes in base64, x fastest, y and z next; a cell's width, and extinction of 255 [m, 1/m]. */
  voxels: { text: string; nx: number; ny: number; nz: number; cell: number; scale: number }
  /** Blocks along an edge of a picture. */
  blocks: number
  pictures: CloudLightView[]
}

/** A picture: see `meta` of the reference. */
export interface CloudLightView {
  /** Elevation of the sun, in the north [°]. */
  sun: number
  /** Azimuth and angle below the horizon that the camera looks towards [°]. */
  azimuth: number
  down: number
  /** Half of the picture's width [m]. */
  halfWidth: number
}

declare global {
  interface Window {
    /** Mean radiance of each block, rows from the top, per picture [1/sr]. */
    welkinCloudLight: (request: CloudLightRequest) => Promise<number[][]>
  }
}

/** Rays along an edge of a block. */
const RAYS = 12

/** Distance of the camera from the middle of the cloud, which sets steps and level of detail [m]. */
const DISTANCE = 3000

/** Altitude of the voxels' lowest face [m]: the camera is below it when it looks up, and above ground. */
const BASE = 3000

/** Angle between pixels, at 1080 of them on 60° [rad]. */
const PIXEL_ANGLE = 1e-3

/** Frames in which shadow maps follow a change: strips of each cascade, and to spare. */
const FRAMES = 16

const degrees = Math.PI / 180

/** The texture of a cloud, which ends in cells without cloud on all sides. */
function voxelTexture({ text, nx, ny, nz }: CloudLightRequest['voxels']): Data3DTexture {
  const cells = Uint8Array.from(atob(text), letter => letter.codePointAt(0)!)
  const texels = new Uint8Array((nx + 2) * (ny + 2) * (nz + 2))
  for (let z = 0; z < nz; z++) {
    for (let y = 0; y < ny; y++) {
      const row = (z * ny + y) * nx
      texels.set(cells.subarray(row, row + nx), ((z + 1) * (ny + 2) + y + 1) * (nx + 2) + 1)
    }
  }
  const result = new Data3DTexture(texels, nx + 2, ny + 2, nz + 2)
  result.format = RedFormat
  result.type = UnsignedByteType
  result.minFilter = result.magFilter = LinearFilter
  result.wrapS = result.wrapT = result.wrapR = ClampToEdgeWrapping
  result.unpackAlignment = 1
  result.needsUpdate = true
  return result
}

/** View for rays that start aside of the camera, by a displacement in the mapped space [m]. */
function viewFrom(view: ViewNodes, shift: Vec3): ViewNodes {
  return Object.create(view, {
    height: { value: view.height.add(shift.dot(view.up)) },
    localCoordinates: { value: (offset: Vec3) => view.localCoordinates(offset.add(shift)) }
  }) as ViewNodes
}

async function draw(renderer: WebGPURenderer, request: CloudLightRequest): Promise<number[][]> {
  const { voxels, quality, blocks, pictures } = request
  const { nx, ny, nz, cell, scale } = voxels
  // No air, no light from the ground: what is left is sunlight of irradiance 1.
  const parameters = airlessParameters({ radius: 6_378_137, groundAlbedo: [0, 0, 0, 0] })
  const atmosphere = new Atmosphere({ parameters }).place({ longitude: 0, latitude: 0 })
  await atmosphere.bake(renderer)
  // Of the layer, light asks altitudes, and coverage: whether clouds are isolated.
  const layers = new CloudLayers([
    { baseAltitude: BASE, topAltitude: BASE + nz * cell, coverage: 0.2, density: scale }
  ])
  const light = new CloudLightTable()
  light.bake()
  const uniforms = new QualityUniforms()
  uniforms.set(cloudQualities[quality])

  const vector = (): { value: Vector3 } & Vec3 => uniform(new Vector3())
  const [east, north, up, direction, right, above, origin] = Array.from({ length: 7 }, vector)
  const halfWidth = uniform(1)
  const map = voxelTexture(voxels)
  const node = texture3D(map) as unknown as LevelTexture<Vec3>
  const size = vec3(nx + 2, ny + 2, nz + 2).mul(cell)
  const extinctionFrom =
    (shift: Vec3) =>
    ({ offset }: { offset: Vec3 }): Float => {
      const from = offset.add(shift).toConst() as Vec3
      const place = vec3(from.dot(east), from.dot(north), from.dot(up)).add(origin).add(cell)
      return node.sample(place.div(size)).level(0).x.mul(scale).toConst()
    }

  const noise = new CloudNoise()
  const view = viewNodes(atmosphere)
  const mapped = new CloudField(atmosphere, layers, view, {
    noise,
    extinction: extinctionFrom(vec3(0))
  })
  const shadows = new CloudShadowMap(mapped)

  const pixels = blocks * RAYS
  const pixel = screenCoordinate.xy.floor() as Vec2
  const at = pixel
    .add(0.5)
    .mul(2 / pixels)
    .sub(1)
  const shift = right.mul(at.x).sub(above.mul(at.y)).mul(halfWidth) as Vec3
  const marched = new CloudField(atmosphere, layers, viewFrom(view, shift), {
    noise,
    extinction: extinctionFrom(shift)
  })
  const fields = [mapped, marched]
  const target = new RenderTarget(pixels, pixels, { type: FloatType, depthBuffer: false })
  const pass = new FragmentPass(
    'CloudLight',
    Fn(() => {
      const maps = { ...shadows.nodes, shift } as unknown as typeof shadows.nodes
      const jitter = interleavedNoise(pixel, float(0))
      const ray = { direction, end: float(2 * DISTANCE), jitter }
      const context = { field: marched, light: light.nodes, shadows: maps, quality: uniforms }
      return vec4(litClouds(context, ray).radiance)
    })()
  )

  const camera = new PerspectiveCamera()
  const results: number[][] = []
  for (const picture of pictures) {
    const [azimuth, down] = [picture.azimuth * degrees, picture.down * degrees]
    const forward = new Vector3(Math.sin(azimuth), Math.cos(azimuth), 0).multiplyScalar(
      Math.cos(down)
    )
    forward.z = -Math.sin(down)
    const aside = new Vector3(Math.cos(azimuth), -Math.sin(azimuth), 0)
    const middle = new Vector3(nx, ny, nz).multiplyScalar(cell / 2)
    origin.value.copy(middle).addScaledVector(forward, -DISTANCE)
    // A scene whose y is up, and whose −z is north.
    camera.position.set(origin.value.x - middle.x, BASE + origin.value.z, middle.y - origin.value.y)
    camera.updateMatrixWorld()
    atmosphere.setSunAngles(picture.sun, 0)
    halfWidth.value = picture.halfWidth
    const axes: [{ value: Vector3 }, Vector3][] = [
      [east, new Vector3(1, 0, 0)],
      [north, new Vector3(0, 1, 0)],
      [up, new Vector3(0, 0, 1)],
      [direction, forward],
      [right, aside],
      [above, aside.clone().cross(forward)]
    ]
    for (const [axis, { x, y, z }] of axes) {
      atmosphere.space.direction(new Vector3(x, z, -y), axis.value).normalize()
    }
    for (let frame = 0; frame < FRAMES; frame++) {
      const seen = atmosphere.update(renderer, camera)
      view.update({ renderer, camera } as unknown as NodeFrame)
      for (const field of fields) {
        field.bake(renderer)
        field.pixelAngle.value = PIXEL_ANGLE
        field.depthScale.value = light.nodes.depthScale.value
        field.update(seen, 0)
      }
      shadows.update(renderer, seen)
    }
    pass.render(renderer, target)
    const { data } = await readPicture(renderer, target)
    const sums = Array.from({ length: blocks ** 2 }, () => 0)
    for (let i = 0; i < pixels ** 2; i++) {
      const [x, y] = [i % pixels, Math.floor(i / pixels)].map(n => Math.floor(n / RAYS))
      sums[y * blocks + x] += data[4 * i] / RAYS ** 2
    }
    results.push(sums)
  }
  for (const owned of [pass, target, map, shadows, light, noise, atmosphere, ...fields]) {
    owned.dispose()
  }
  return results
}

window.welkinCloudLight = async request => {
  const { context, finish } = createContext(request.backend)
  let results: number[][]
  let messages: string[]
  try {
    results = await draw(await context.createRenderer(), request)
  } finally {
    messages = (await finish()).messages
  }
  if (messages.length > 0) throw new Error(messages.join('\n'))
  return results
}

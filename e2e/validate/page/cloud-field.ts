import { Atmosphere } from '@welkin/atmosphere'
import { CloudField, cloudPreset, type CloudPresetName } from '@welkin/clouds'
import { FloatType, PerspectiveCamera, RenderTarget, Vector3 } from 'three'
import { Fn, float, screenCoordinate, uniform, vec4 } from 'three/tsl'
import type { Node, NodeFrame, WebGPURenderer } from 'three/webgpu'
import { FragmentPass } from '../../../packages/atmosphere/src/tables/FragmentPass'
import { cloudExtinction } from '../../gpu/harness/cloud-extinction'
import { createContext, type ContextHandle } from '../../gpu/harness/context'
import type { Backend } from '../../harness/backend'
import { readPicture } from '../../gpu/harness/picture'

/** Field of a preset's clouds, and the grid on which it is wanted. */
export interface CloudFieldRequest {
  backend: Backend
  preset: CloudPresetName
  /** Middle of the grid [°]. */
  longitude: number
  latitude: number
  /** Coverage of the lowest layer, in place of the preset's, and of the others in proportion. */
  coverage?: number | undefined
  /** Width of the grid, and of a cell [m]. */
  size: number
  cell: number
}

/** Extents of a grid that was opened. */
export interface CloudFieldExtents {
  nx: number
  ny: number
  nz: number
  /** Altitude of the lowest cells' bottom [m]. */
  z0: number
}

declare global {
  interface Window {
    /** Makes the clouds of a request; the page holds one field at a time. */
    welkinOpenCloudField: (request: CloudFieldRequest) => Promise<CloudFieldExtents>
    /** Extinction at a level's cells [1/m], float32 in base64; x towards the east, y towards the north. */
    welkinCloudFieldLevel: (level: number) => Promise<string>
    /** @throws If the renderer had anything to complain of. */
    welkinCloseCloudField: () => Promise<void>
  }
}

/** Samples of a cell along each axis: their mean is the cell's. */
const SAMPLES = 2

/** Levels of clear air below the lowest base. */
const CLEAR_LEVELS = 5

interface OpenField {
  renderer: WebGPURenderer
  pass: FragmentPass
  target: RenderTarget
  bottom: { value: number }
  z0: number
  cell: number
  handle: ContextHandle
  dispose: () => void
}

let open: OpenField | undefined

window.welkinOpenCloudField = async request => {
  const { backend, preset, longitude, latitude, coverage, size, cell } = request
  const handle = createContext(backend)
  const renderer = await handle.context.createRenderer()
  const atmosphere = new Atmosphere().place({ longitude, latitude })
  const layers = cloudPreset(preset)
  const first = layers.at(0).parameters.coverage
  const scale = coverage === undefined ? 1 : coverage / first
  for (const layer of layers) {
    layer.set({ coverage: Math.min(layer.parameters.coverage * scale, 1) })
  }
  const field = new CloudField(atmosphere, layers)
  field.bake(renderer)
  const camera = new PerspectiveCamera()
  camera.updateMatrixWorld()
  const view = atmosphere.update(renderer, camera)
  field.view.update({ renderer, camera } as unknown as NodeFrame)
  field.update(view, 0)
  // Details down to a sample's width are wanted.
  field.pixelAngle.value = 1

  const altitudes = [...layers].map(layer => layer.parameters)
  // Bases are edges only where clear air is below them.
  const z0 = Math.min(...altitudes.map(layer => layer.baseAltitude)) - CLEAR_LEVELS * cell
  const top = Math.max(...altitudes.map(layer => layer.topAltitude))
  const columns = Math.round(size / cell)
  const target = new RenderTarget(columns, columns, { type: FloatType, depthBuffer: false })

  // East is a Y-up scene's x.
  const up = view.up.clone()
  const east = atmosphere.space.direction(new Vector3(1, 0, 0), new Vector3())
  east.addScaledVector(up, -east.dot(up)).normalize()
  const north = up.clone().cross(east)
  const axis = ({ x, y, z }: Vector3): Node<'vec3'> => uniform(new Vector3(x, y, z))
  const axes = [axis(east), axis(north), axis(up)]
  const bottom = uniform(0)
  const sampleAt = (i: number, j: number, k: number): Node<'float'> => {
    const at = (n: number): number => (n + 0.5) / SAMPLES
    const column = screenCoordinate.xy.floor()
    const x = column.x.add(at(i) - columns / 2).mul(cell)
    // Rows are read from the top, which is the first row of the grid.
    const y = column.y.add(at(j) - columns / 2).mul(cell)
    const altitude = float(bottom as unknown as Node<'float'>).add(at(k) * cell)
    const radius = field.radius.add(altitude).toConst()
    const square = x.mul(x).add(y.mul(y)).toConst()
    const drop = square.div(radius.mul(radius).sub(square).sqrt().add(radius))
    const offset = axes[0]
      .mul(x)
      .add(axes[1].mul(y))
      .add(axes[2].mul(altitude.sub(drop).sub(field.view.height)))
      .toConst() as Node<'vec3'>
    const sample = {
      offset,
      ...field.view.localCoordinates(offset),
      distance: float(cell / SAMPLES)
    }
    return cloudExtinction(field, sample, true)
  }
  const pass = new FragmentPass(
    'CloudField',
    Fn(() => {
      const sum = float(0).toVar()
      const indices = Array.from({ length: SAMPLES }, (_, i) => i)
      for (const k of indices) {
        for (const j of indices) for (const i of indices) sum.addAssign(sampleAt(i, j, k))
      }
      return vec4(sum.div(SAMPLES ** 3), 0, 0, 1)
    })()
  )
  open = {
    renderer,
    pass,
    target,
    bottom,
    z0,
    cell,
    handle,
    dispose() {
      pass.dispose()
      target.dispose()
      field.dispose()
      atmosphere.dispose()
    }
  }
  return { nx: columns, ny: columns, nz: Math.ceil((top - z0) / cell), z0 }
}

window.welkinCloudFieldLevel = async level => {
  if (open === undefined) throw new Error('no cloud field is open')
  const { renderer, pass, target, bottom, z0, cell } = open
  bottom.value = z0 + level * cell
  pass.render(renderer, target)
  const { data } = await readPicture(renderer, target)
  const bytes = new Uint8Array(data.filter((_, i) => i % 4 === 0).buffer)
  let text = ''
  for (let i = 0; i < bytes.length; i += 0x8000) {
    text += String.fromCodePoint(...bytes.subarray(i, i + 0x8000))
  }
  return btoa(text)
}

window.welkinCloseCloudField = async () => {
  if (open === undefined) return
  const { handle, dispose } = open
  dispose()
  open = undefined
  const { messages } = await handle.finish()
  if (messages.length > 0) throw new Error(messages.join('\n'))
}

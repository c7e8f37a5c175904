import { Atmosphere } from '@welkin/atmosphere'
import { CloudField, cloudPreset, type CloudPresetName } from '@welkin/clouds'
import { FloatType, PerspectiveCamera, RenderTarget, Vector3 } from 'three'
import { Fn, If, float, screenCoordinate, uniform, vec4 } from 'three/tsl'
import type { Node, NodeFrame, WebGPURenderer } from 'three/webgpu'
import { FragmentPass } from '../../../packages/atmosphere/src/tables/FragmentPass'
import { billowForm } from '../../../packages/clouds/src/density/formConstants'
import { componentAt } from '../../../packages/clouds/src/density/tsl/componentAt'
import {
  forLayers,
  heightIn,
  isWithin,
  layerAt
} from '../../../packages/clouds/src/density/tsl/layer'
import type { CloudSample } from '../../../packages/clouds/src/density/tsl/sample'
import { sampleLayer } from '../../../packages/clouds/src/density/tsl/sampleLayer'
import { backgroundAt } from '../../../packages/clouds/src/density/tsl/sampler'
import { loop } from '../../../packages/clouds/src/tsl-types'
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
    /** Makes the clouds of a request, or moves those of the last one there, if only the place differs. */
    welkinOpenCloudField: (request: CloudFieldRequest) => Promise<CloudFieldExtents>
    /**
     * Extinction at four levels' cells [1/m], float32 in base64; x towards the east, y towards the north, the levels next to
     * each other.
     */
    welkinCloudFieldLevels: (first: number) => Promise<string>
    /** @throws If the renderer had anything to complain of. */
    welkinCloseCloudField: () => Promise<void>
  }
}

/** Samples of a cell along each axis: their mean is the cell's. */
const SAMPLES = 2

/** Levels of clear air below the lowest base. */
const CLEAR_LEVELS = 5

/** Levels of a drawing: components of a texel. */
const LEVELS = 4

interface OpenField {
  /** Request without its place. */
  about: string
  extents: CloudFieldExtents
  renderer: WebGPURenderer
  pass: FragmentPass
  target: RenderTarget
  bottom: { value: number }
  cell: number
  handle: ContextHandle
  moveTo: (request: CloudFieldRequest) => void
  dispose: () => void
}

let open: OpenField | undefined

const aboutOf = (request: CloudFieldRequest): string =>
  JSON.stringify({ ...request, longitude: 0, latitude: 0 })

async function openField(request: CloudFieldRequest): Promise<OpenField> {
  const { backend, preset, coverage, size, cell } = request
  const handle = createContext(backend)
  const renderer = await handle.context.createRenderer()
  const atmosphere = new Atmosphere()
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
  // Details and billows down to a sample's width are wanted.
  field.pixelAngle.value = 1 / billowForm.detailFootprints

  const altitudes = [...layers].map(layer => layer.parameters)
  // Bases are edges only where clear air is below them.
  const z0 = Math.min(...altitudes.map(layer => layer.baseAltitude)) - CLEAR_LEVELS * cell
  const top = Math.max(...altitudes.map(layer => layer.topAltitude))
  const columns = Math.round(size / cell)
  const target = new RenderTarget(columns, columns, { type: FloatType, depthBuffer: false })

  const directions = [new Vector3(), new Vector3(), new Vector3()]
  const axes = directions.map(direction => uniform(direction) as Node<'vec3'>)
  const moveTo = ({ longitude, latitude }: CloudFieldRequest): void => {
    atmosphere.place({ longitude, latitude })
    const view = atmosphere.update(renderer, camera)
    field.view.update({ renderer, camera } as unknown as NodeFrame)
    field.update(view, 0)
    const [east, north, up] = directions
    up.copy(view.up)
    // East is a Y-up scene's x.
    atmosphere.space.direction(new Vector3(1, 0, 0), east)
    east.addScaledVector(up, -east.dot(up)).normalize()
    north.copy(up).cross(east)
  }

  const bottom = uniform(0)
  const levels = Fn(() => {
    const sums = vec4(0).toVar()
    const column = screenCoordinate.xy.floor().toConst()
    loop('column', SAMPLES ** 2, index => {
      const part = float(index).toConst()
      const row = part.div(SAMPLES).floor().toConst()
      const inCell = (n: Node<'float'>): Node<'float'> => n.add(0.5).div(SAMPLES)
      const x = column.x.add(inCell(part.sub(row.mul(SAMPLES)))).sub(columns / 2)
      // Rows are read from the top, which is the first row of the grid.
      const y = column.y.add(inCell(row)).sub(columns / 2)
      const [east, north] = [x.mul(cell).toConst(), y.mul(cell).toConst()]
      const square = east.mul(east).add(north.mul(north)).toConst()
      const sampleAt = (altitude: Node<'float'>): CloudSample => {
        const radius = field.radius.add(altitude).toConst()
        const drop = square.div(radius.mul(radius).sub(square).sqrt().add(radius))
        const offset = axes[0]
          .mul(east)
          .add(axes[1].mul(north))
          .add(axes[2].mul(altitude.sub(drop).sub(field.view.height)))
          .toConst() as Node<'vec3'>
        const distance = float(cell / SAMPLES)
        return { offset, ...field.view.localCoordinates(offset), distance, billowFootprints: 1 }
      }
      const lowest = sampleAt(float(bottom as unknown as Node<'float'>).toConst())
      forLayers(field, number => {
        const layer = layerAt(field, number)
        // The weather is the same all the way up.
        const background = backgroundAt(field, layer, lowest)
        loop('height', LEVELS * SAMPLES, step => {
          const rise = float(step).toConst()
          const altitude = bottom.add(inCell(rise).mul(cell)).toConst() as Node<'float'>
          If(isWithin(layer, heightIn(layer, altitude)), () => {
            const sample = sampleAt(altitude)
            const found = sampleLayer(field, layer, background, sample, { detail: true })
            sums.addAssign(componentAt(rise.div(SAMPLES).floor()).mul(found.extinction))
          })
        })
      })
    })
    return sums.div(SAMPLES ** 3)
  })
  const pass = new FragmentPass('CloudField', levels())
  const extents = { nx: columns, ny: columns, nz: Math.ceil((top - z0) / cell), z0 }
  const dispose = (): void => {
    pass.dispose()
    target.dispose()
    field.dispose()
    atmosphere.dispose()
  }
  return {
    about: aboutOf(request),
    extents,
    renderer,
    pass,
    target,
    bottom,
    cell,
    handle,
    moveTo,
    dispose
  }
}

window.welkinOpenCloudField = async request => {
  if (open?.about !== aboutOf(request)) {
    await window.welkinCloseCloudField()
    open = await openField(request)
  }
  open.moveTo(request)
  return open.extents
}

window.welkinCloudFieldLevels = async first => {
  if (open === undefined) throw new Error('no cloud field is open')
  const { renderer, pass, target, bottom, extents, cell } = open
  bottom.value = extents.z0 + first * cell
  pass.render(renderer, target)
  const { data } = await readPicture(renderer, target)
  const bytes = new Uint8Array(data.buffer)
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

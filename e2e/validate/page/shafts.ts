import {
  aerialPerspective,
  aerialPerspectiveFog,
  Atmosphere,
  AtmosphereParameters,
  forwardShafts,
  skyBackground,
  SunDirectionalLight,
  type AtmosphereParametersInit,
  type LightShaftsQuality,
  type SpectralMatrix
} from '@welkin/atmosphere'
import { Ellipsoid } from '@welkin/geo'
import {
  BoxGeometry,
  FloatType,
  Matrix3,
  Matrix4,
  Mesh,
  MeshLambertMaterial,
  PerspectiveCamera,
  PlaneGeometry,
  RenderTarget,
  Scene,
  Vector3
} from 'three'
import { pass } from 'three/tsl'
import { RenderPipeline, type WebGPURenderer } from 'three/webgpu'
import { createContext } from '../../gpu/harness/context'
import { nextFrame } from '../../gpu/harness/graphics'
import { readPicture } from '../../gpu/harness/picture'
import { loadTexels } from '../../gpu/harness/kept-texels'
import { keepTables } from '../../gpu/harness/reuse-tables'
import type { Backend } from '../../harness/backend'

/** Opaque box: least and greatest x, y and z of a frame whose y is up [m]. */
export type Box = readonly [number, number, number, number, number, number]

/** Rays from one camera past boxes. */
export interface ShaftView {
  boxes: readonly Box[]
  camera: [number, number, number]
  /** Direction to the sun. */
  sun: [number, number, number]
  directions: [number, number, number][]
}

export interface ShaftRequest {
  backend: Backend
  parameters: AtmosphereParametersInit
  quality: LightShaftsQuality
  isReversed: boolean
  /** Sky and haze drawn by the scene's own materials, not by a post effect. */
  isForward: boolean
  views: ShaftView[]
}

declare global {
  interface Window {
    /** Light that boxes take from each ray, at the first three wavelengths, by views [W/m²/sr/nm]. */
    welkinShafts: (request: ShaftRequest) => Promise<number[][][]>
  }
}

/** Edge of a ray's picture [pixels], of which the middle half is read, and its angle [°]. */
const PIXELS = 8
const ANGLE = 0.01

const SHADOW_TEXELS = 4096

/** Matrix to XYZ of which linear sRGB is what it was: spectral radiance of the first three wavelengths. */
function unmixed(): SpectralMatrix {
  const matrix = new Matrix3().set(
    3.2404542,
    -1.5371385,
    -0.4985314,
    -0.969266,
    1.8760108,
    0.041556,
    0.0556434,
    -0.2040259,
    1.0572252
  )
  const { elements } = matrix.invert()
  const row = (i: number): [number, number, number, number] => [
    elements[i] / 683,
    elements[3 + i] / 683,
    elements[6 + i] / 683,
    0
  ]
  return [row(0), row(1), row(2)]
}

/** Fits a light's shadow map to boxes. */
function fitShadow(light: SunDirectionalLight, boxes: readonly Box[], toLight: Vector3): void {
  const axes = new Matrix4().lookAt(toLight, new Vector3(), new Vector3(0, 1, 0)).invert()
  const least = new Vector3(Infinity, Infinity, Infinity)
  const most = least.clone().negate()
  for (const box of boxes) {
    for (let i = 0; i < 8; i++) {
      const corner = new Vector3(box[i & 1 ? 3 : 0], box[i & 2 ? 4 : 1], box[i & 4 ? 5 : 2])
      corner.applyMatrix4(axes)
      least.min(corner)
      most.max(corner)
    }
  }
  const middle = least.clone().add(most).multiplyScalar(0.5)
  const half = most.clone().sub(least).multiplyScalar(0.505)
  light.target.position.copy(middle).applyMatrix4(axes.invert())
  light.distance = half.z + 1
  const { camera } = light.shadow
  Object.assign(camera, { left: -half.x, right: half.x, bottom: -half.y, top: half.y })
  Object.assign(camera, { near: 0.5, far: 2 * half.z + 2 })
  camera.updateProjectionMatrix()
}

/** The scene of a view; something that takes shadows is always drawn, so that three draws the map. */
function sceneOf({ boxes }: ShaftView, light: SunDirectionalLight): Scene {
  const scene = new Scene()
  const material = new MeshLambertMaterial()
  for (const [x, y, z, right, top, south] of boxes) {
    const mesh = new Mesh(new BoxGeometry(right - x, top - y, south - z), material)
    mesh.position.set((x + right) / 2, (y + top) / 2, (z + south) / 2)
    mesh.castShadow = mesh.receiveShadow = true
    scene.add(mesh)
  }
  const receiver = new Mesh(new PlaneGeometry(0, 0), material)
  receiver.frustumCulled = false
  receiver.receiveShadow = true
  scene.add(receiver, light, light.target)
  return scene
}

async function drawView(
  renderer: WebGPURenderer,
  atmosphere: Atmosphere,
  view: ShaftView,
  { quality, isForward }: Pick<ShaftRequest, 'quality' | 'isForward'>
): Promise<number[][]> {
  const toLight = new Vector3(...view.sun)
  atmosphere.sunDirection = toLight
  const light = new SunDirectionalLight(atmosphere)
  light.castShadow = true
  light.shadow.mapSize.setScalar(SHADOW_TEXELS)
  light.shadow.autoUpdate = false
  light.shadow.needsUpdate = true
  fitShadow(light, view.boxes, toLight)
  const scene = sceneOf(view, light)
  const camera = new PerspectiveCamera(ANGLE, 1, 1, 1e6)
  camera.position.set(...view.camera)
  const shafts = forwardShafts(atmosphere, camera, light, { quality })
  const scenePass = pass(scene, camera, { samples: 0, type: FloatType })
  const pipeline = new RenderPipeline(renderer)
  pipeline.outputColorTransform = false
  const [color, depth] = [scenePass.getTextureNode(), scenePass.getTextureNode('depth')]
  if (isForward) {
    atmosphere.add(shafts)
    scene.backgroundNode = skyBackground(atmosphere)
    scene.fogNode = aerialPerspectiveFog(atmosphere)
  } else pipeline.outputNode = aerialPerspective(color, depth, camera, atmosphere, { shafts })
  const target = new RenderTarget(PIXELS, PIXELS, { type: FloatType })
  const draw = async (): Promise<number[]> => {
    renderer.setRenderTarget(target)
    if (isForward) renderer.render(scene, camera)
    else pipeline.render()
    renderer.setRenderTarget(null)
    const picture = await readPicture(renderer, target)
    const sums = [0, 0, 0]
    for (let i = 0; i < PIXELS ** 2 / 4; i++) {
      const [x, y] = [i % (PIXELS / 2), Math.floor((2 * i) / PIXELS)]
      const pixel = picture.at(x + PIXELS / 4, y + PIXELS / 4)
      sums.forEach((_, k) => (sums[k] += pixel[k] / (PIXELS ** 2 / 4)))
    }
    return sums
  }
  // The sky is drawn before what takes shadows, by which three makes the map.
  if (isForward) await renderer.compileAsync(scene, camera)
  const lost: number[][] = []
  for (const direction of view.directions) {
    camera.lookAt(new Vector3(...direction).add(camera.position))
    camera.updateMatrixWorld()
    await nextFrame()
    shafts.enabled = true
    const shadowed = await draw()
    shafts.enabled = false
    const lit = await draw()
    lost.push(lit.map((value, k) => value - shadowed[k]))
  }
  atmosphere.remove(shafts)
  scene.traverse(object => (object as Partial<Mesh>).geometry?.dispose())
  for (const owned of [light, shafts, scenePass, pipeline, target]) owned.dispose()
  return lost
}

window.welkinShafts = async request => {
  await loadTexels()
  const { backend, parameters: init, isReversed, views } = request
  const { context, finish } = createContext(backend)
  const parameters = new AtmosphereParameters({ ...init, spectralToXYZ: unmixed() })
  const ellipsoid = new Ellipsoid(parameters.bottomRadius)
  const atmosphere = new Atmosphere({ parameters, ellipsoid, luminanceScale: 1 })
  const results: number[][][] = []
  let messages: string[]
  try {
    const size = { width: PIXELS, height: PIXELS }
    const renderer = await context.createRenderer({ ...size, reversedDepthBuffer: isReversed })
    renderer.shadowMap.enabled = true
    await atmosphere.bake(renderer)
    await keepTables()
    for (const view of views) results.push(await drawView(renderer, atmosphere, view, request))
  } finally {
    atmosphere.dispose()
    messages = (await finish()).messages
  }
  if (messages.length > 0) throw new Error(messages.join('\n'))
  return results
}

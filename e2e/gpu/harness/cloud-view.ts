import { Atmosphere, aerialPerspective } from '@welkin/atmosphere'
import { CloudLayers, CloudLightTable, CloudNoise, clouds } from '@welkin/clouds'
import type {
  CloudLayerParameters,
  CloudQuality,
  CloudsNode,
  PrecipitationShafts
} from '@welkin/clouds'
import { PerspectiveCamera, Scene } from 'three'
import { pass } from 'three/tsl'
import { RenderPipeline, type Node, type WebGPURenderer } from 'three/webgpu'
import { drawToFloat } from './atmosphere'
import type { GpuContext } from './context'
import { nextFrame } from './graphics'
import type { Picture } from './picture'

/** Size of the views' pictures. */
export const viewSize = { width: 24, height: 14 }

/** Quality for tests of features that do not depend on steps. */
export const coarse: CloudQuality = {
  steps: 32,
  stepGrowth: 0.02,
  shortestStep: 10,
  depthStep: 0.3,
  layerSteps: 6,
  lightSteps: 1,
  block: 2
}

/** Noise of which no more than so many slices are drawn in a frame: smooth clouds need none. */
export class SparseNoise extends CloudNoise {
  constructor(readonly slices = 0) {
    super()
  }

  override get isReady(): boolean {
    return this.slices === 0 || super.isReady
  }

  override update(renderer: WebGPURenderer): boolean {
    return this.slices > 0 ? super.update(renderer, this.slices) : true
  }
}

/** A layer without gaps or shapes: what light does in it is known. */
export const fog: Partial<CloudLayerParameters> = {
  baseAltitude: 500,
  topAltitude: 2500,
  coverage: 1,
  density: 0.004,
  shapeAmount: 0,
  detailAmount: 0,
  profileExponent: 8,
  edgeSoftness: 0,
  turbulence: 0,
  shear: 0,
  densityGrowth: 0,
  wind: { east: 0, north: 0 }
}

/** Parts that the views of a test share. */
export interface Shared {
  readonly noise: CloudNoise
  readonly light: CloudLightTable
}

/** A scene with air and clouds, seen by a camera. */
export class CloudView {
  readonly scene = new Scene()
  readonly camera = new PerspectiveCamera(60, viewSize.width / viewSize.height, 1, 1e6)
  readonly node: CloudsNode
  readonly #pipeline: RenderPipeline
  readonly #scenePass

  constructor(
    readonly renderer: WebGPURenderer,
    readonly atmosphere: Atmosphere,
    layers: CloudLayers,
    { noise, light, precipitation }: Partial<Shared> & { precipitation?: PrecipitationShafts },
    quality = coarse
  ) {
    const { camera, scene } = this
    this.#scenePass = pass(scene, camera, { samples: 0 })
    const depth = this.#scenePass.getTextureNode('depth')
    const air = aerialPerspective(this.#scenePass.getTextureNode(), depth, camera, atmosphere)
    const options = { quality, noise, light, precipitation }
    this.node = clouds(air, depth, camera, atmosphere, layers, options)
    this.node.time = 0
    this.#pipeline = new RenderPipeline(renderer)
    this.#pipeline.outputColorTransform = false
    this.#pipeline.outputNode = this.node
  }

  /** Shows another node than the clouds' own, one that draws them. */
  show(output: Node): void {
    this.#pipeline.outputNode = output
    this.#pipeline.needsUpdate = true
  }

  render(): void {
    this.camera.updateMatrixWorld()
    this.#pipeline.render()
  }

  /** Draws frames; the last is read back. */
  async draw(frames = 1): Promise<Picture> {
    for (let i = 1; i < frames; i++) {
      await nextFrame()
      this.render()
    }
    await nextFrame()
    return drawToFloat(this.renderer, () => this.render())
  }

  dispose(): void {
    this.node.dispose()
    this.#pipeline.dispose()
    this.#scenePass.dispose()
  }
}

/**
 * Has clouds that nobody looks at draw their shadow maps alone, and look-ups of their light: a software renderer takes longer to
 * compile the march of a view ray than for all of these.
 */
export function drawUnseen({ passes }: CloudsNode): void {
  passes.render = () => undefined
}

/** Atmosphere about a point at sea level, y up, under a sun 40° high. */
export const onGround = (): Atmosphere => {
  const atmosphere = new Atmosphere().place({ longitude: 20, latitude: 45 }).setSunAngles(40, 150)
  atmosphere.luminanceScale = 3e-5
  return atmosphere
}

/** A view from the middle of a fog, levelly. */
export function viewInFog(
  renderer: WebGPURenderer,
  atmosphere: Atmosphere,
  shared: Shared
): CloudView {
  const view = new CloudView(renderer, atmosphere, new CloudLayers([fog]), shared)
  view.camera.position.set(0, 1500, 0)
  return view
}

/** Brightness of the pixel in the middle. */
export const middle = (picture: Picture): number => {
  const [r, g, b] = picture.at(picture.width >> 1, picture.height >> 1)
  return (r + g + b) / 3
}

/** Hands a view from the middle of a fog to a test, and frees it after. */
export async function inFog(
  t: GpuContext,
  body: (view: CloudView, shared: Shared) => Promise<void>,
  options = {}
): Promise<void> {
  const renderer = await t.createRenderer({ ...viewSize, ...options })
  const atmosphere = onGround()
  const shared = { noise: new SparseNoise(), light: new CloudLightTable() }
  const view = viewInFog(renderer, atmosphere, shared)
  await body(view, shared)
  view.dispose()
  shared.noise.dispose()
  shared.light.dispose()
  atmosphere.dispose()
}

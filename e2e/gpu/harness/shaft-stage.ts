import {
  aerialPerspective,
  Atmosphere,
  AtmosphereParameters,
  forwardShafts,
  moon,
  MoonDirectionalLight,
  SunDirectionalLight,
  type ForwardShafts,
  type LightShaftsOptions,
  type SpectralMatrix
} from '@welkin/atmosphere'
import { Ellipsoid } from '@welkin/geo'
import {
  BoxGeometry,
  FloatType,
  Group,
  type Matrix4,
  Mesh,
  MeshLambertMaterial,
  PerspectiveCamera,
  PlaneGeometry,
  Scene,
  type Camera
} from 'three'
import { pass } from 'three/tsl'
import { RenderPipeline, type Node, type WebGPURenderer } from 'three/webgpu'
import { drawToFloat } from './atmosphere'
import { expectTrue } from './expect'
import { nextFrame } from './graphics'
import type { Picture } from './picture'

/** Size of the stage's pictures. */
export const stageSize = { width: 64, height: 36 }

/** Matrix to XYZ of which linear sRGB is the radiance at the first three wavelengths. */
const unmixed: SpectralMatrix = [
  [0.4124564 / 683, 0.3575761 / 683, 0.1804375 / 683, 0],
  [0.2126729 / 683, 0.7151522 / 683, 0.072175 / 683, 0],
  [0.0193339 / 683, 0.119192 / 683, 0.9503041 / 683, 0]
]

/** Air whose pictures have three wavelengths, per unit irradiance, on a sphere. */
export const parameters = (): AtmosphereParameters =>
  new AtmosphereParameters({ spectralToXYZ: unmixed, solarIrradiance: [1, 1, 1, 1] })

/** A scene with light shafts as a post effect. */
export interface Stage {
  scene: Scene
  camera: PerspectiveCamera
  atmosphere: Atmosphere
  light: SunDirectionalLight
  shafts: ForwardShafts
  pipeline: RenderPipeline
  /** The picture with shafts as a node, and its depth. */
  air: Node
  depth: Node
  /** The picture with shafts. */
  draw: () => Promise<Picture>
  dispose: () => void
}

/**
 * A scene with light shafts as a post effect; null for shafts draws the same without.
 *
 * @param elevation - Elevation of the sun in the north, or of the full moon while the sun is down [°].
 */
export function stage(
  renderer: WebGPURenderer,
  elevation: number,
  options: LightShaftsOptions | null = {},
  isMoonlit = false
): Stage {
  renderer.shadowMap.enabled = true
  const earth = parameters()
  const ellipsoid = new Ellipsoid(earth.bottomRadius)
  const atmosphere = new Atmosphere({ parameters: earth, ellipsoid, luminanceScale: 1 })
  atmosphere.setSunAngles(elevation, 0)
  const scene = new Scene()
  let light = new SunDirectionalLight(atmosphere, 6000)
  if (isMoonlit) {
    const luna = moon({ direction: atmosphere.sunDirection, mapSize: 64 })
    atmosphere.setSunAngles(-50, 180).add(luna)
    light = new MoonDirectionalLight(atmosphere, luna, 6000)
  }
  light.castShadow = true
  light.shadow.mapSize.setScalar(1024)
  Object.assign(light.shadow.camera, { left: -4000, right: 4000, bottom: -4000, top: 4000 })
  light.shadow.camera.far = 12_000
  // Always drawn and never seen: three draws shadow maps for what takes shadows.
  const receiver = new Mesh(new PlaneGeometry(0, 0), new MeshLambertMaterial())
  receiver.frustumCulled = false
  receiver.receiveShadow = true
  scene.add(light, light.target, receiver)
  const camera = new PerspectiveCamera(60, stageSize.width / stageSize.height, 1, 1e6)
  camera.position.y = 2
  const shafts = forwardShafts(atmosphere, camera, light, options ?? {})
  const scenePass = pass(scene, camera, { samples: 0, type: FloatType })
  const pipeline = new RenderPipeline(renderer)
  pipeline.outputColorTransform = false
  const [color, depth] = [scenePass.getTextureNode(), scenePass.getTextureNode('depth')]
  const given = options === null ? {} : { shafts }
  const air = aerialPerspective(color, depth, camera, atmosphere, given)
  pipeline.outputNode = air
  return {
    scene,
    camera,
    atmosphere,
    light,
    shafts,
    pipeline,
    air,
    depth,
    async draw() {
      camera.updateMatrixWorld()
      await nextFrame()
      return drawToFloat(renderer, () => pipeline.render())
    },
    dispose() {
      for (const owned of [scenePass, pipeline, shafts, light, atmosphere]) owned.dispose()
    }
  }
}

/** A box that casts shadows, by its middle and its edges [m]. */
export function addBox(
  scene: Scene,
  middle: [number, number, number],
  edges: [number, number, number]
) {
  const box = new Mesh(new BoxGeometry(...edges), new MeshLambertMaterial())
  box.position.set(...middle)
  box.castShadow = box.receiveShadow = true
  scene.add(box)
  return box
}

/** Fails if two pictures differ in any bit. */
export function expectSame(a: Picture, b: Picture, label: string): void {
  const differs = a.data.findIndex((value, i) => value !== b.data[i])
  expectTrue(differs < 0, `${label}: ${a.data[differs]} is not ${b.data[differs]} at ${differs}`)
}

/** Towers on the sun's side of the camera, as they stand in a frame. */
export function addTowers(set: Stage, frame: Matrix4): void {
  const group = new Group()
  for (const [x, width] of [
    [-300, 200],
    [50, 60],
    [260, 150]
  ])
    group.add(addBox(set.scene, [x, 200, -600], [width, 500, 60]))
  group.applyMatrix4(frame)
  set.scene.add(group)
}

/** A camera's own pipeline of the stage's scene, with shafts. */
export function secondCamera(
  { scene, atmosphere, light }: Stage,
  renderer: WebGPURenderer,
  camera: Camera
) {
  const shafts = forwardShafts(atmosphere, camera, light)
  const scenePass = pass(scene, camera, { samples: 0, type: FloatType })
  const pipeline = new RenderPipeline(renderer)
  pipeline.outputColorTransform = false
  const [color, depth] = [scenePass.getTextureNode(), scenePass.getTextureNode('depth')]
  pipeline.outputNode = aerialPerspective(color, depth, camera, atmosphere, { shafts })
  return {
    shafts,
    pipeline,
    dispose: () => {
      for (const owned of [scenePass, pipeline, shafts]) owned.dispose()
    }
  }
}

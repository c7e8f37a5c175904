import { exposureFor } from '@welkin/atmosphere'
import { Mesh, PerspectiveCamera, PointLight, Scene, SpotLight } from 'three'
import type { MeshStandardMaterial } from 'three'
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js'
import { Air } from './air'
import { footingOn } from './importedModel/footing'
import { squareURL } from './importedModel/square'
import { Explorer } from './moving/Explorer'
import { EYE_HEIGHT } from './moving/Walk'
import { createRenderer, dateOf, disposeMeshes, exposureOf, frameClock } from './scene'
import type { RendererArgs, SceneHandle, TimeArgs } from './scene'
import { storyHandle } from './storyHandle'

export interface ImportedModelArgs extends RendererArgs, TimeArgs {
  /** Sine of the sun's elevation under which lamps are lit. */
  lampsBelow: number
}

/** A model from a glTF file under the sky. */
export async function createImportedModel(
  canvas: HTMLCanvasElement,
  args: ImportedModelArgs
): Promise<SceneHandle<ImportedModelArgs>> {
  const renderer = await createRenderer(canvas, args.forceWebGL)
  const scene = new Scene()
  const camera = new PerspectiveCamera(55, 1, 0.1, 20_000)
  camera.position.set(3, EYE_HEIGHT, 17)
  camera.lookAt(0, 5, -8)
  const elapsed = frameClock(args.frame)
  const air = new Air(renderer, scene, camera, args.path)
  const { atmosphere } = air
  const url = await squareURL()
  // #region model
  // #shown const { scene: model } = await new GLTFLoader().loadAsync('square.glb')
  const { scene: model } = await new GLTFLoader().loadAsync(url) // #hidden
  scene.add(model)
  const lamps = new Map<PointLight | SpotLight, number>() // of KHR_lights_punctual, and candela
  model.traverse(part => {
    if (part instanceof Mesh) part.castShadow = part.receiveShadow = true
    if (part instanceof PointLight || part instanceof SpotLight) lamps.set(part, part.intensity)
  })
  // #endregion
  const meshes: Mesh[] = []
  model.traverse(part => {
    if (part instanceof Mesh) meshes.push(part)
  })
  URL.revokeObjectURL(url)
  const solid = meshes.filter(({ name }) => name === 'wall' || name === 'stone')
  const footingAt = footingOn(solid)
  const explorer = args.frame ? undefined : new Explorer(camera, canvas, { footingAt })
  const glowing = meshes.flatMap(({ name, material }) =>
    name === 'lamp' || name === 'window' ? (material as MeshStandardMaterial) : []
  )
  /** Luminance of lit windows and lamps [cd/m²]. */
  const luminances = glowing.map(({ name }) => (name === 'lamp' ? 2000 : 60))
  const { shadow } = air.sun
  air.sun.distance = 80
  shadow.mapSize.setScalar(2048)
  shadow.camera.left = shadow.camera.bottom = -35
  shadow.camera.right = shadow.camera.top = 35
  shadow.camera.far = 200
  shadow.normalBias = 0.04

  const current = { ...args }
  const apply = (): void => {
    atmosphere.date = dateOf(current.day, current.hour)
    renderer.toneMappingExposure = exposureOf(current.exposure)
  }
  const draw = (): void => {
    const { lampsBelow } = current
    explorer?.update(elapsed())
    camera.updateMatrixWorld()
    // #region lamps
    // Each frame. The floor is the lux of the lamps, 0.03 the sine of the sun's elevation.
    atmosphere.luminanceScale = 1e-4 * exposureFor(atmosphere, camera, { floor: 10 })
    // #shown const scale = atmosphere.sunDirection.y < 0.03 ? atmosphere.luminanceScale : 0
    const scale = atmosphere.sunDirection.y < lampsBelow ? atmosphere.luminanceScale : 0 // #hidden
    for (const [lamp, candela] of lamps) lamp.intensity = candela * scale
    // #endregion
    glowing.forEach((material, i) => (material.emissiveIntensity = luminances[i] * scale))
    air.render()
  }
  apply()

  return storyHandle({
    renderer,
    scene,
    camera,
    explorer,
    current,
    apply,
    draw,
    dispose() {
      air.dispose()
      disposeMeshes(meshes)
      for (const lamp of lamps.keys()) lamp.dispose()
    }
  })
}

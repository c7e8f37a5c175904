import {
  HalfFloatType,
  Mesh,
  MeshBasicMaterial,
  PerspectiveCamera,
  RenderTarget,
  Scene,
  SphereGeometry,
  Vector3
} from 'three'
import { pass } from 'three/tsl'
import { RenderPipeline, type WebGPURenderer } from 'three/webgpu'
import {
  Atmosphere,
  aerialPerspective,
  aerialPerspectiveFog,
  skyBackground
} from '@welkin/atmosphere'
import { Ellipsoid } from '@welkin/geo'

/** Way to draw the air: as background and fog, or as a post effect. */
export type Path = 'forward' | 'post'

export interface BenchScene {
  atmosphere: Atmosphere
  camera: PerspectiveCamera
  /** Draws a frame. */
  draw: () => void
  dispose: () => void
}

const SHAPE = Ellipsoid.WGS84

/** A camera over the Pacific that looks past the horizon: about half of the picture is ground. */
export function placeCamera(camera: PerspectiveCamera, altitude: number, longitude = 150): void {
  const position = SHAPE.geodeticToECEF({ longitude, latitude: 20, height: altitude })
  const up = SHAPE.surfaceNormal(position)
  const east = new Vector3(-up.y, up.x, 0).normalize()
  const dip = Math.acos(SHAPE.a / (SHAPE.a + altitude))
  const forward = east.multiplyScalar(Math.cos(dip)).addScaledVector(up, -Math.sin(dip))
  if (altitude > 5e6) forward.copy(up).negate()
  camera.position.copy(position)
  camera.up.copy(altitude > 5e6 ? new Vector3(0, 0, 1) : up)
  camera.lookAt(position.clone().add(forward))
  camera.near = Math.max(altitude * 0.2, 0.5)
  camera.far = 1e5 * Math.sqrt(altitude + 100) + 5e6
  camera.updateProjectionMatrix()
  camera.updateMatrixWorld()
}

/**
 * A globe without light or texture, so that what the air costs stands out.
 *
 * @param withAir - False for the same scene without it, to be subtracted.
 * @param decorate - Adds what else is in the sky.
 */
export function benchScene(
  renderer: WebGPURenderer,
  path: Path,
  altitude: number,
  withAir: boolean,
  size: readonly [number, number],
  decorate: (atmosphere: Atmosphere) => void = () => undefined
): BenchScene {
  const atmosphere = new Atmosphere()
  decorate(atmosphere)
  atmosphere.frame = 'ecef'
  const camera = new PerspectiveCamera(50, size[0] / size[1])
  placeCamera(camera, altitude)
  setSun(atmosphere, camera, 40)
  const scene = new Scene()
  const globe = new Mesh(
    new SphereGeometry(1, 256, 128),
    new MeshBasicMaterial({ color: 0x557799 })
  )
  globe.geometry.rotateX(Math.PI / 2)
  globe.scale.copy(SHAPE.radii)
  globe.updateMatrixWorld()
  scene.add(globe)

  let pipeline: RenderPipeline | undefined
  if (path === 'forward') {
    if (withAir) {
      scene.backgroundNode = skyBackground(atmosphere)
      scene.fogNode = aerialPerspectiveFog(atmosphere)
    }
  } else {
    const scenePass = pass(scene, camera)
    const color = scenePass.getTextureNode()
    const depth = scenePass.getTextureNode('depth')
    pipeline = new RenderPipeline(renderer)
    pipeline.outputNode = withAir ? aerialPerspective(color, depth, camera, atmosphere) : color
  }
  const target = new RenderTarget(size[0], size[1], { type: HalfFloatType })
  return {
    atmosphere,
    camera,
    draw: () => {
      renderer.setRenderTarget(target)
      if (pipeline === undefined) renderer.render(scene, camera)
      else pipeline.render()
      renderer.setRenderTarget(null)
    },
    dispose: () => {
      atmosphere.dispose()
      pipeline?.dispose()
      globe.geometry.dispose()
      globe.material.dispose()
      target.dispose()
    }
  }
}

/** Puts the sun at a height above the camera's horizon [°]. */
export function setSun(atmosphere: Atmosphere, camera: PerspectiveCamera, elevation: number): void {
  const up = SHAPE.surfaceNormal(camera.position)
  const east = new Vector3(-up.y, up.x, 0).normalize()
  const angle = (elevation * Math.PI) / 180
  const north = up.clone().cross(east)
  atmosphere.sunDirection = up
    .multiplyScalar(Math.sin(angle))
    .addScaledVector(east.addScaledVector(north, 0.5).normalize(), Math.cos(angle))
}

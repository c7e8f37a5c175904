import {
  aerialPerspectiveFog,
  Atmosphere,
  skyBackground,
  SkyLightProbe,
  SunDirectionalLight
} from '@welkin/atmosphere'
import {
  AgXToneMapping,
  Mesh,
  MeshStandardMaterial,
  PerspectiveCamera,
  PlaneGeometry,
  Scene
} from 'three'
import type { CreateScene } from './main'

/** The quick start of the documentation, with a grey plain to stand on, at noon in Tokyo. */
export const create: CreateScene = renderer => {
  renderer.toneMapping = AgXToneMapping
  const scene = new Scene()
  const camera = new PerspectiveCamera(60, 320 / 180, 0.1, 20_000)
  camera.position.y = 2
  scene.add(
    new Mesh(
      new PlaneGeometry(20_000, 20_000).rotateX(-Math.PI / 2),
      new MeshStandardMaterial({ color: 0x808080, roughness: 1 })
    )
  )

  const atmosphere = new Atmosphere()
  atmosphere.place({ longitude: 139.77, latitude: 35.68 })
  atmosphere.date = new Date('2026-06-21T03:00:00Z')

  scene.backgroundNode = skyBackground(atmosphere)
  scene.fogNode = aerialPerspectiveFog(atmosphere)
  scene.add(new SunDirectionalLight(atmosphere), new SkyLightProbe(atmosphere))

  return () => renderer.render(scene, camera)
}

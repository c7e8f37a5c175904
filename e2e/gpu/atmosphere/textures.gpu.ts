import {
  Atmosphere,
  aerialPerspectiveFog,
  moon,
  planetGround,
  skyBackground,
  skyEnvironment,
  type SkyLayer,
  SunDirectionalLight
} from '@welkin/atmosphere'
import { DataTexture, Mesh, PerspectiveCamera, PlaneGeometry, Scene, type Texture } from 'three'
import { texture, vec4 } from 'three/tsl'
import { MeshStandardNodeMaterial, type Node } from 'three/webgpu'
import { drawForward, expectLight, postPath } from '../harness/atmosphere'
import { expectTrue } from '../harness/expect'
import { gpuTest } from '../harness/gpu-test'

const size = { width: 32, height: 18 }

/** Number of textures that no shader may sample on any device that there is. */
const TOO_MANY = 40

function pictures(name: string, count: number): Texture[] {
  return Array.from({ length: count }, () => {
    const made = new DataTexture(new Uint8Array([255, 128, 64, 255]), 1, 1)
    made.name = name
    made.needsUpdate = true
    return made
  })
}

/** Sum of textures' colours. */
const sum = (textures: readonly Texture[]): Node<'vec4'> =>
  textures.reduce<Node<'vec4'>>((color, picture) => color.add(texture(picture)), vec4(0))

function thrownBy(draw: () => void): string {
  try {
    draw()
  } catch (error) {
    return String(error)
  }
  return 'nothing thrown'
}

function expectMessage(message: string, ...parts: RegExp[]): void {
  for (const part of parts) expectTrue(part.test(message), `${part} is not in: ${message}`)
}

function world() {
  const atmosphere = new Atmosphere()
  const camera = new PerspectiveCamera(60, size.width / size.height, 1, 1e6)
  camera.position.y = 10
  camera.updateMatrixWorld()
  return { atmosphere, camera, scene: new Scene() }
}

gpuTest('a lit material with too many textures throws, and says what samples them', async t => {
  const renderer = await t.createRenderer(size)
  const { atmosphere, camera, scene } = world()
  atmosphere.add(moon({ mapSize: 64 }))
  const [map, normalMap] = pictures('', 2)
  const material = new MeshStandardNodeMaterial()
  Object.assign(material, { name: 'wall', map, normalMap })
  material.emissiveNode = sum(pictures('posters', TOO_MANY)).xyz
  const wall = new Mesh(new PlaneGeometry(1e3, 1e3), material)
  wall.position.z = -100
  scene.add(wall, new SunDirectionalLight(atmosphere))
  scene.backgroundNode = skyBackground(atmosphere)
  scene.fogNode = aerialPerspectiveFog(atmosphere)
  scene.environmentNode = skyEnvironment(atmosphere)
  for (let frame = 0; frame < 2; frame++) {
    expectMessage(
      thrownBy(() => renderer.render(scene, camera)),
      /Atmosphere: wall must sample at most \d+ textures, leave out some of: /,
      /: posters 40, maps of the material 2, .*Atmosphere 1.*, got 4\d/
    )
  }
  material.emissiveNode = null
  material.needsUpdate = true
  const drawn = await drawForward(renderer, scene, camera, atmosphere)
  expectLight(drawn, 'without posters')
  expectTrue(drawn.at(16, 9)[0] > 0, 'the wall is black without posters')
  atmosphere.dispose()
})

gpuTest('a post effect with too many layers throws, and says which', async t => {
  const renderer = await t.createRenderer(size)
  const { atmosphere, camera, scene } = world()
  const [surface, water, nightLights] = pictures('', 3)
  const comets: SkyLayer = {
    background: (_, farther) => farther.add(sum(pictures('comets', TOO_MANY)))
  }
  atmosphere.add(comets, moon({ mapSize: 64 }), planetGround({ surface, water, nightLights }))
  const post = postPath(renderer, scene, camera, atmosphere)
  expectMessage(
    thrownBy(post.render),
    /Atmosphere: .* must sample at most \d+ textures, leave out some of: /,
    /: comets 40, PlanetGround 3, .*Moon 1/,
    /Atmosphere 1/
  )
  atmosphere.remove(comets)
  post.refresh()
  const drawn = await post.draw()
  expectLight(drawn, 'without comets')
  expectTrue(drawn.at(16, 1)[2] > 0, 'the sky is black without comets')
  post.dispose()
  atmosphere.dispose()
})

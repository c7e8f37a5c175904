import { DataTexture, FloatType, Mesh, PerspectiveCamera, PlaneGeometry, Scene } from 'three'
import { texture, vec3 } from 'three/tsl'
import { MeshBasicNodeMaterial } from 'three/webgpu'
import { LakeMirror } from '../../../stories/src/valley/LakeMirror'
import { expectTrue } from '../harness/expect'
import { gpuTest } from '../harness/gpu-test'

/** Distances of what the picture shows [m]: a mountain, and its rim before the sky, where depths are mixed. */
const DEPTHS = [9000, 50_000] as const

gpuTest(
  'the lake mirrors all that the picture has, rims of mountains too, unless switched off',
  async t => {
    const size = { width: 32, height: 32 }
    const renderer = await t.createRenderer(size)
    const camera = new PerspectiveCamera(60, 1, 0.1, 1e5)
    camera.position.set(0, 2, 0)
    camera.updateMatrixWorld()
    for (const depth of DEPTHS) {
      const data = Float32Array.from({ length: 4 * 16 * 16 }, (_, i) => (i % 4 === 3 ? depth : 1))
      const picture = new DataTexture(data, 16, 16, undefined, FloatType)
      picture.needsUpdate = true
      const mirror = new LakeMirror(texture(picture))
      mirror.prepare(renderer)
      mirror.update(renderer, camera, 1)
      const scene = new Scene()
      const material = new MeshBasicNodeMaterial({ colorNode: vec3(mirror.sample().a) })
      scene.add(new Mesh(new PlaneGeometry(2000, 2000).rotateX(-Math.PI / 2), material))
      const shown = await t.render(renderer, scene, camera, size)
      const seen = [18, 22, 26].map(row => shown.at(16, row)[0])
      t.note(`${depth} m: ${seen.map(value => value.toFixed(2)).join(', ')}`)
      expectTrue(Math.min(...seen) > 0.99, `at ${depth} m the mirror has ${Math.min(...seen)}`)
      mirror.isOn = false
      mirror.update(renderer, camera, 1)
      const off = await t.render(renderer, scene, camera, size)
      expectTrue(off.at(16, 22)[0] === 0, `switched off it has ${off.at(16, 22)[0]}`)
      mirror.dispose()
      material.dispose()
      picture.dispose()
    }
  }
)

import { Color, HalfFloatType, Mesh, OrthographicCamera, PlaneGeometry, Scene } from 'three'
import { float, screenUV, vec4 } from 'three/tsl'
import { MeshBasicNodeMaterial } from 'three/webgpu'
import { expectClose } from './harness/expect'
import { gpuTest } from './harness/gpu-test'

const camera = new OrthographicCamera(-1, 1, 1, -1, 0, 1)

gpuTest('shows a known colour on the canvas', async t => {
  const renderer = await t.createRenderer()
  const scene = new Scene()
  scene.background = new Color(0x3366cc)
  const picture = await t.capture(renderer, () => renderer.render(scene, camera))
  expectClose(picture.at(160, 90), [0x33 / 255, 0x66 / 255, 0xcc / 255, 1], { absolute: 1 / 255 })
})

for (const type of ['float32', 'half float'] as const) {
  gpuTest(`keeps ${type} radiance above 1, top row first`, async t => {
    const renderer = await t.createRenderer()
    const scene = new Scene()
    const material = new MeshBasicNodeMaterial()
    // screenUV counts from the top: a bottom-up read-back would swap the two rows below.
    material.fragmentNode = vec4(screenUV.x.mul(8), screenUV.y.mul(8), 1000, 1)
    scene.add(new Mesh(new PlaneGeometry(2, 2), material))
    const options = type === 'half float' ? { type: HalfFloatType } : {}
    const picture = await t.render(renderer, scene, camera, options)
    const tolerance = { absolute: 1e-6, relative: 1 / 1024 }
    expectClose(picture.at(0, 0), [4 / 320, 4 / 180, 1000, 1], tolerance, 'top left')
    expectClose(
      picture.at(319, 179),
      [8 - 4 / 320, 8 - 4 / 180, 1000, 1],
      tolerance,
      'bottom right'
    )
  })
}

gpuTest('evaluates a shader function in order', async t => {
  const inputs = Array.from({ length: 200 }, (_, i) => [i, 0.5, 0, 0])
  const results = await t.evaluate(inputs, input => vec4(input.x.mul(input.y), 0, 0, float(1)))
  expectClose(
    inputs.map((_, i) => results[4 * i]),
    inputs.map(([i]) => i / 2),
    { relative: 1e-6 }
  )
})

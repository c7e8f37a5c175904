import { BoxGeometry, DirectionalLight, Mesh, PerspectiveCamera, Scene } from 'three'
import { uniform } from 'three/tsl'
import { VertexLitMaterial } from '../../../stories/src/valley/VertexLitMaterial'
import { gpuTest } from '../harness/gpu-test'

gpuTest('snow lies on top of a thing, not on its sides', async t => {
  const size = { width: 32, height: 32 }
  const renderer = await t.createRenderer(size)
  const scene = new Scene()
  const light = new DirectionalLight(0xffffff, Math.PI)
  light.position.set(0, 1, 1)
  const material = new VertexLitMaterial({ color: 0x331111 })
  const snow = uniform(0)
  material.snowNode = snow
  scene.add(light, new Mesh(new BoxGeometry(), material))
  const camera = new PerspectiveCamera(40, 1, 0.1, 10)
  camera.position.set(0, 1.6, 1.6)
  camera.lookAt(0, 0, 0)
  camera.updateMatrixWorld()
  const [top, side] = [8, 24] // rows from above
  const green = async (): Promise<[top: number, side: number]> => {
    const picture = await t.render(renderer, scene, camera, size)
    return [picture.at(16, top)[1], picture.at(16, side)[1]]
  }
  const bare = await green()
  snow.value = 1
  const white = await green()
  t.note(
    `green of top and side ${bare
      .concat(white)
      .map(value => value.toFixed(3))
      .join(', ')}`
  )
  if (!(white[0] > 10 * bare[0])) throw new Error(`the top is ${white[0]}, and was ${bare[0]}`)
  if (!(Math.abs(white[1] - bare[1]) < 1e-3)) throw new Error(`the side is ${white[1]}`)
  if (!(bare[1] > 0)) throw new Error('the side is black')
  material.dispose()
})

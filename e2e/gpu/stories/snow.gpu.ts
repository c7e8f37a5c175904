import {
  AmbientLight,
  BoxGeometry,
  DirectionalLight,
  DoubleSide,
  Mesh,
  PerspectiveCamera,
  Scene
} from 'three'
import { uniform } from 'three/tsl'
import { setFarFoliage, setFoliage } from '../../../stories/src/valley/leaves'
import { distantTree, leafyTree } from '../../../stories/src/valley/treeShapes'
import { VertexLitMaterial } from '../../../stories/src/valley/VertexLitMaterial'
import { expectTrue } from '../harness/expect'
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

/** Distance of the camera from a tree that fills the picture [m]. */
const DISTANCE = 24

gpuTest('leaves fall: twigs are left of a crown, and one looks through it far away', async t => {
  const size = { width: 64, height: 64 }
  const renderer = await t.createRenderer(size)
  const scene = new Scene()
  scene.add(new AmbientLight(0xffffff, 100))
  const fallen = uniform(0)
  const coverOf = async (): Promise<number> => {
    const picture = await t.render(renderer, scene, camera, size)
    let covered = 0
    for (let y = 0; y < size.height; y++) {
      for (let x = 0; x < size.width; x++) if (picture.at(x, y)[1] > 1e-3) covered++
    }
    return covered
  }
  const camera = new PerspectiveCamera(22, 1, 0.1, 100)
  camera.position.set(0, 5, DISTANCE)
  camera.updateMatrixWorld()
  for (const isNear of [true, false]) {
    const name = isNear ? 'near' : 'far'
    const material = new VertexLitMaterial({ side: DoubleSide, vertexColors: true })
    if (isNear) setFoliage(material, fallen)
    else setFarFoliage(material, fallen)
    const tree = new Mesh(isNear ? leafyTree('lime', 11) : distantTree('lime', 4), material)
    scene.add(tree)
    fallen.value = 0
    const green = await coverOf()
    fallen.value = 1
    const share = (await coverOf()) / green
    t.note(`${name}: ${green} pixels in leaf, ${(100 * share).toFixed(0)} % of them when bare`)
    expectTrue(green > 600, `${name}: a tree in leaf has ${green} pixels`)
    expectTrue(share > 0.15 && share < 0.75, `${name}: a bare tree has ${share} of its pixels`)
    scene.remove(tree)
    tree.geometry.dispose()
    material.dispose()
  }
})

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
import { setLit } from '../../../stories/src/valley/litLights'
import { VertexLitMaterial } from '../../../stories/src/valley/VertexLitMaterial'
import { expectTrue } from '../harness/expect'
import { gpuTest } from '../harness/gpu-test'

gpuTest('snow lies on top of a thing, not on its sides; what is wet is darker', async t => {
  const size = { width: 32, height: 32 }
  const renderer = await t.createRenderer(size)
  const scene = new Scene()
  const light = new DirectionalLight(0xffffff, Math.PI)
  light.position.set(0, 1, 1)
  const material = new VertexLitMaterial({ color: 0x331111 })
  const snow = uniform(0)
  material.snowNode = snow
  const wet = uniform(0)
  material.wetNode = wet
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
  snow.value = 0
  wet.value = 1
  const [wetTop, wetSide] = await green()
  for (const [dry, now] of [
    [bare[0], wetTop],
    [bare[1], wetSide]
  ]) {
    expectTrue(now > 0.5 * dry && now < 0.75 * dry, `${now} when wet, and ${dry} when dry`)
  }
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

gpuTest('what stands beside a wall has less light of the sky, and all of the sun', async t => {
  const size = { width: 16, height: 16 }
  const renderer = await t.createRenderer(size)
  const scene = new Scene()
  const material = new VertexLitMaterial()
  const open = uniform(1)
  material.openNode = open
  const [sky, sun] = [new AmbientLight(0xffffff, 1), new DirectionalLight(0xffffff, 1)]
  sun.position.set(0, 1, 0)
  const ground = new Mesh(new BoxGeometry(4, 1, 4), material)
  scene.add(sky, sun, ground)
  const camera = new PerspectiveCamera(30, 1, 0.1, 10)
  camera.position.set(0, 4, 0.01)
  camera.lookAt(0, 0, 0)
  camera.updateMatrixWorld()
  const green = async (): Promise<number> =>
    (await t.render(renderer, scene, camera, size)).at(8, 8)[1]
  const all = await green()
  open.value = 0.25
  const beside = await green()
  setLit(sun, false)
  const shaded = await green()
  open.value = 1
  const skyAlone = await green()
  t.note([all, beside, skyAlone, shaded].map(value => value.toFixed(4)).join(', '))
  expectTrue(Math.abs(shaded / skyAlone - 0.25) < 0.01, 'a quarter of the sky is left')
  expectTrue(Math.abs(all - beside - (skyAlone - shaded)) < 1e-3, 'the sun shines as before')
  material.dispose()
})

import {
  DataTexture,
  Mesh,
  NearestFilter,
  OrthographicCamera,
  PlaneGeometry,
  Scene,
  Vector2
} from 'three'
import { texture, uniform, vec4 } from 'three/tsl'
import { NodeMaterial } from 'three/webgpu'
import { shutter } from '../../../stories/src/valley/shutter'
import { expectTrue } from '../harness/expect'
import { gpuTest } from '../harness/gpu-test'

/** Pixels of the picture along an edge, and the column that is white. */
const SIZE = 32
const WHITE = 16

gpuTest('a picture that moves is blurred by as much, about where it is', async t => {
  const renderer = await t.createRenderer({ width: SIZE, height: SIZE })
  const bytes = Uint8Array.from({ length: 4 * SIZE * SIZE }, (_, i) =>
    Math.floor(i / 4) % SIZE === WHITE ? 255 : 0
  )
  const stripe = new DataTexture(bytes, SIZE, SIZE)
  stripe.minFilter = stripe.magFilter = NearestFilter
  stripe.needsUpdate = true
  const velocity = uniform(new Vector2())
  const material = new NodeMaterial()
  material.fragmentNode = shutter(texture(stripe), vec4(velocity, 0, 0))
  const scene = new Scene()
  scene.add(new Mesh(new PlaneGeometry(2, 2), material))
  const camera = new OrthographicCamera(-1, 1, 1, -1, -1, 1)
  camera.updateMatrixWorld()
  /** Light of the columns of the picture after a motion across it [pixels]. */
  const columnsAfter = async (pixels: number): Promise<number[]> => {
    velocity.value.set((2 * pixels) / SIZE, 0)
    const picture = await t.render(renderer, scene, camera, { width: SIZE, height: SIZE })
    return Array.from({ length: SIZE }, (_, x) => picture.at(x, SIZE / 2)[0])
  }
  for (const [pixels, seen] of [
    [0.5, 1],
    [6, 6],
    [16, 16]
  ]) {
    const columns = await columnsAfter(pixels)
    const sum = columns.reduce((total, light) => total + light, 0)
    const middle = columns.reduce((total, light, x) => total + light * x, 0) / sum
    const lit = columns.flatMap((light, x) => (light > 0 ? [x] : []))
    const width = lit[lit.length - 1] - lit[0] + 1
    t.note(`${pixels} pixels: ${width} wide, about ${middle.toFixed(2)}, light ${sum.toFixed(2)}`)
    expectTrue(Math.abs(middle - WHITE) < 0.8, `${pixels} pixels: about ${middle}`)
    expectTrue(width <= seen && width >= seen / 2, `${pixels} pixels: ${width} wide`)
    expectTrue(Math.abs(sum - 1) < 0.4, `${pixels} pixels: light ${sum}`)
  }
  stripe.dispose()
  material.dispose()
})

import { Atmosphere } from '@welkin/atmosphere'
import { ImageTiles, Terrain } from '@welkin/terrain'
import { Color, Matrix4, PerspectiveCamera, Scene } from 'three'
import { gpuTest } from '../harness/gpu-test'
import { levelGround } from '../harness/ground'

const SIZE = 32
const PICTURE = { width: 48, height: 32 }

/** Linear light of a byte of sRGB. */
const linear = (byte: number): number => {
  const value = byte / 255
  return value <= 0.04045 ? value / 12.92 : ((value + 0.055) / 1.055) ** 2.4
}

const redOf = (z: number): number => 40 + 30 * z
const EAST = 200
const WEST = 30

gpuTest('pictures are drawn on the ground, a bad tile shows its parent', async t => {
  const renderer = await t.createPlanetRenderer(PICTURE)
  const atmosphere = new Atmosphere({ frame: 'ecef' })
  let isOpen = false
  const open: (() => void)[] = []
  const imagery = new ImageTiles('{z}/{x}/{y}', {
    size: SIZE,
    maxZoom: 5,
    retries: 0,
    scheme: 'geographic',
    async loadPixels(url) {
      const [z, x, y] = url.split('/').map(Number)
      if (z > 1 && !isOpen) await new Promise<void>(resolve => open.push(resolve))
      // North of the equator the finest are broken.
      if (z === 5 && y < 16) return { width: 1, height: 1, data: [0, 0, 0, 0] }
      const isEast = x >= 2 ** z
      const data = Uint8ClampedArray.from(
        { length: 4 * SIZE ** 2 },
        (_, i) => [redOf(z), isEast ? EAST : WEST, 0, 255][i % 4]
      )
      return { width: SIZE, height: SIZE, data }
    }
  })
  const options = { resolution: 8, seaLevel: -Infinity, pageMemory: 12, imagery }
  const terrain = new Terrain(atmosphere, levelGround, options)
  terrain.material.fragmentNode = terrain.material.colorNode
  const scene = new Scene()
  scene.background = new Color(0, 0, 0)
  scene.add(terrain)
  const camera = new PerspectiveCamera(40, PICTURE.width / PICTURE.height, 1e3, 1e9)
  const axes = new Matrix4()
  atmosphere.ellipsoid.geodeticToECEF({ longitude: 0, latitude: 0, height: 1.5e6 }, camera.position)
  camera.quaternion.setFromRotationMatrix(atmosphere.ellipsoid.localYUpFrame(camera.position, axes))
  camera.rotateX(-Math.PI / 2)
  camera.updateMatrixWorld()

  const settle = async (): Promise<void> => {
    for (let i = 0; i < 80; i++) {
      terrain.update(renderer, camera, Infinity)
      await new Promise(resolve => setTimeout(resolve, 5))
    }
  }
  /** Colours in the picture's four quarters, from the north-west by rows. */
  const draw = async (): Promise<number[][]> => {
    await settle()
    const picture = await t.render(renderer, scene, camera, PICTURE)
    const { width, height } = PICTURE
    return [0.25, 0.75].flatMap(y =>
      [0.25, 0.75].map(x => Array.from(picture.at(Math.floor(x * width), Math.floor(y * height))))
    )
  }
  const check = (colors: number[][], expected: number[][], when: string): void => {
    for (const [i, [red, green]] of expected.entries()) {
      for (const [n, byte] of [red, green].entries()) {
        const off = Math.abs(colors[i][n] - linear(byte))
        if (!(off < 4e-3)) {
          throw new Error(`${when}, quarter ${i}: ${colors[i].join(', ')}, not ${red}, ${green}`)
        }
      }
    }
  }
  const coarse = redOf(1)
  const before = [WEST, EAST, WEST, EAST].map(green => [coarse, green])
  check(await draw(), before, 'before fine tiles arrive')
  isOpen = true
  for (const resolve of open) resolve()
  const north = redOf(4)
  const south = redOf(5)
  check(
    await draw(),
    [
      [north, WEST],
      [north, EAST],
      [south, WEST],
      [south, EAST]
    ],
    'after'
  )
  if (!terrain.isFull) throw new Error('the picture is not full')
  const { bytes } = terrain.pages
  t.note(`${terrain.pages.count} pages, ${(bytes / 1e6).toFixed(1)} MB`)
  if (bytes > 12e6) throw new Error(`pages take ${bytes} bytes`)
  terrain.dispose()
  imagery.dispose()
})

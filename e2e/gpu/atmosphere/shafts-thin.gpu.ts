import { heightFog, type LightShaftsQuality } from '@welkin/atmosphere'
import { MeshLambertMaterial, Vector3 } from 'three'
import type { WebGPURenderer } from 'three/webgpu'
import { drawForward } from '../harness/atmosphere'
import { expectTrue } from '../harness/expect'
import { gpuTest } from '../harness/gpu-test'
import { nextFrame } from '../harness/graphics'
import type { Picture } from '../harness/picture'
import { addBox, stage, type Stage } from '../harness/shaft-stage'

/** A picture of 1920×1080 has the spacing of samples that pictures of users have; rows of it are drawn [pixels]. */
const full = { width: 1920, height: 1080 }
const size = { width: full.width, height: 8 }
const FIRST_ROW = 330

/** Vertical field of view [°]. */
const FIELD = 60
const TAN = Math.tan((FIELD * Math.PI) / 360)

/** Width of masts, of which few are met by samples [pixels]. */
const WIDTH = 1.5

/** Columns in which masts begin, and their distances along the view's axis [m]. */
const MASTS = Array.from({ length: 18 }, (_, i) => ({
  column: 55 + 103 * i,
  distance: [180, 420, 800, 1300, 2100][i % 5]
}))

/** Towers before a sun of 15°, with masts between them and behind, in thin fog. */
function townOf({ scene, camera, light, atmosphere }: Stage): void {
  const black = new MeshLambertMaterial({ color: 0 })
  for (let i = 0; i < 12; i++) {
    const [column, row] = [i % 4, Math.floor(i / 4)]
    const height = 150 + 60 * ((7 * i) % 5)
    const middle: [number, number, number] = [
      (column - 1.5) * 230 + 60 * row,
      height / 2,
      -400 - 260 * row
    ]
    addBox(scene, middle, [40, height, 40]).material = black
  }
  for (const { column, distance } of MASTS) {
    const perPixel = (2 * TAN * distance) / full.height
    const x = (column + WIDTH / 2 - full.width / 2) * perPixel
    const mast = addBox(scene, [x, 1000, -distance], [WIDTH * perPixel, 2000, 1])
    mast.material = black
    // Of what is thin shadows differ from map to map.
    mast.castShadow = false
  }
  light.shadow.mapSize.setScalar(2048)
  Object.assign(light.shadow.camera, { left: -1600, right: 1600, bottom: -1600, top: 1600 })
  light.shadow.camera.updateProjectionMatrix()
  camera.fov = FIELD
  camera.position.set(0, 2, 0)
  camera.setViewOffset(full.width, full.height, 0, FIRST_ROW, size.width, size.height)
  camera.lookAt(new Vector3(0, 2, -1))
  camera.updateMatrixWorld()
  atmosphere.add(heightFog({ density: 4e-4, falloff: 300 }))
}

/** The same by materials, with 512 samples in each pixel. */
async function expectedOf(renderer: WebGPURenderer, set: Stage): Promise<Picture> {
  const { shafts, atmosphere, scene, camera } = set
  shafts.set({ quality: 'reference' })
  atmosphere.add(shafts)
  await nextFrame()
  await drawForward(renderer, scene, camera, atmosphere)
  await nextFrame()
  const picture = await drawForward(renderer, scene, camera, atmosphere)
  atmosphere.remove(shafts)
  scene.backgroundNode = scene.fogNode = null
  return picture
}

/** Mean light of some columns of a picture. */
const lightIn = (picture: Picture, columns: readonly number[]): number => {
  const values = columns.flatMap(x =>
    Array.from({ length: size.height }, (_, y) => picture.at(x, y)[1])
  )
  return values.reduce((sum, value) => sum + value, 0) / values.length
}

/** Largest errors of the light before masts, and around them, over the light without shadows. */
const goals: [LightShaftsQuality, number, number][] = [
  ['medium', 0.04, 0.03],
  ['low', 0.08, 0.045]
]

gpuTest(
  'has things that few samples meet in the shafts before them, and no rims around, in a picture of 1920 pixels',
  async t => {
    const renderer = await t.createRenderer(size)
    const set = stage(renderer, 15)
    townOf(set)
    const expected = await expectedOf(renderer, set)
    set.shafts.enabled = false
    const lit = await set.draw()
    set.shafts.enabled = true
    for (const [quality, goal, rims] of goals) {
      set.shafts.set({ quality })
      await set.draw()
      const picture = await set.draw()
      const errorOf = (drawn: Picture, columns: (column: number) => number[]): number[] =>
        MASTS.map(({ column }) => {
          const [is, should] = [drawn, expected].map(each => lightIn(each, columns(column)))
          return Math.abs(is - should) / lightIn(lit, columns(column))
        })
      const onMast = (column: number): number[] => [column]
      const around = (column: number): number[] =>
        [-9, -7, -5, -3, 4, 6, 8, 10].map(x => column + x)
      const most = (values: number[]): number => Math.max(...values)
      const [masts, aside] = [onMast, around].map(where => errorOf(picture, where))
      const percents = (values: number[]): string => values.map(x => (100 * x).toFixed(1)).join(' ')
      t.note(`${quality}, masts: ${percents(masts)} %`)
      t.note(`around them: ${percents(aside)} %`)
      t.note(`without shafts: ${percents(errorOf(lit, onMast))} %`)
      expectTrue(most(masts) <= goal, `${quality}: light before masts is wrong`)
      expectTrue(most(aside) <= rims, `${quality}: light around masts is wrong`)
    }
    set.dispose()
  },
  { backends: ['webgpu'] }
)

import { distanceFog, heightFog, type LightShaftsQuality } from '@welkin/atmosphere'
import { Vector3 } from 'three'
import type { WebGPURenderer } from 'three/webgpu'
import { airScene, drawForward } from '../harness/atmosphere'
import { expectTrue } from '../harness/expect'
import { gpuTest } from '../harness/gpu-test'
import { nextFrame } from '../harness/graphics'
import type { Picture } from '../harness/picture'
import { addBox, stage, type Stage } from '../harness/shaft-stage'

const size = { width: 320, height: 180 }
/** Half of such a picture, for `zoom`. */
const half = { width: size.width / 2, height: size.height / 2 }

/** Turn of the camera in a frame: 90°/s at 60 Hz [rad]. */
const TURN = Math.PI / 120

/** Towers before a low sun, of which each has its shaft in the haze. */
function city({ scene, camera, light }: Stage): void {
  for (let i = 0; i < 16; i++) {
    const [column, row] = [i % 4, Math.floor(i / 4)]
    const height = 120 + 60 * ((7 * i) % 5)
    const tower = addBox(
      scene,
      [(column - 1.5) * 160 + 25 * row, height / 2, -400 - 220 * row],
      [40, height, 40]
    )
    tower.material.color.set(0x404040)
  }
  const ground = addBox(scene, [0, -5, 0], [8000, 10, 8000])
  ground.material.color.set(0x606060)
  light.shadow.mapSize.setScalar(2048)
  const { camera: lens } = light.shadow
  Object.assign(lens, { left: -1600, right: 1600, bottom: -1600, top: 1600 })
  lens.updateProjectionMatrix()
  camera.position.set(30, 2, 150)
}

/** Has `half` pixels as small as a picture of `size` has. */
function zoom({ camera }: Stage): void {
  camera.fov /= 2
  camera.updateProjectionMatrix()
}

/** Has the camera look somewhat up, at an angle from the sun's azimuth [rad]. */
function turnTo({ camera }: Stage, angle: number): void {
  const direction = new Vector3(Math.sin(angle), 0.2, -Math.cos(angle))
  camera.lookAt(direction.add(camera.position))
  camera.updateMatrixWorld()
}

const encode = (light: number): number =>
  light <= 0.0031308 ? 12.92 * light : 1.055 * light ** (1 / 2.4) - 0.055

/** Pictures as displays show them, in [0, 1], where one pixel in fifty of this one is white. */
function display(picture: Picture): (value: number) => number {
  const colors = picture.data.filter((_, i) => i % 4 < 3)
  const white = colors.toSorted()[Math.floor(0.98 * colors.length)]
  return value => encode(Math.min(Math.max(value / white, 0), 1))
}

/** Likeness of pictures as displays show them [dB]. */
function likeness(a: Picture, b: Picture): number {
  const shown = display(a)
  const colors = a.width * a.height * 3
  let sum = 0
  a.data.forEach((value, i) => {
    if (i % 4 < 3) sum += (shown(value) - shown(b.data[i])) ** 2
  })
  return -10 * Math.log10(sum / colors)
}

/** Greatest step of a smooth picture from pixel to pixel, in levels of a display of 256. */
const SMOOTH = 1

/** Part of the steps of smooth pictures that may be greater: at edges of shafts and silhouettes. */
const STEEP = 0.002

/**
 * Steps between pixels side by side or above each other where the expected picture has none above `SMOOTH` around
 * them, in levels of a display of 256: bands would be there. The greatest, and the part above one level.
 */
function bands(expected: Picture, picture: Picture): { greatest: number; part: number } {
  const shown = display(expected)
  const { width, height } = expected
  const level = ({ data }: Picture, x: number, y: number, channel: number): number =>
    255 * shown(data[4 * (y * width + x) + channel])
  const steps: number[] = []
  for (let i = 0; i < 3 * width * height; i++) {
    const [channel, pixel] = [i % 3, Math.floor(i / 3)]
    const [x, y] = [pixel % width, Math.floor(pixel / width)]
    if (Math.min(x, y) < 1 || x > width - 3 || y > height - 3) continue
    const around = Array.from({ length: 16 }, (_, k) =>
      level(expected, x - 1 + (k % 4), y - 1 + (k >> 2), channel)
    )
    if (Math.max(...around) - Math.min(...around) > SMOOTH) continue
    const here = level(picture, x, y, channel)
    steps.push(Math.abs(level(picture, x + 1, y, channel) - here))
    steps.push(Math.abs(level(picture, x, y + 1, channel) - here))
  }
  expectTrue(steps.length > 0.2 * 3 * width * height, `only ${steps.length} steps are smooth`)
  const steep = steps.filter(step => step > 1).length
  return {
    greatest: steps.reduce((most, step) => Math.max(most, step), 0),
    part: steep / steps.length
  }
}

/** Pixels of small pictures from one that is marched to the next. */
const APART = 3

/** Errors' steps where pixels begin to take others of those that are marched, over all other steps. More: a comb of lines. */
const COMB = 1.6

/** Mean step of the error at every third pixel of rows and columns, over that of the others. */
function comb(expected: Picture, picture: Picture): number {
  const shown = display(expected)
  const { width, height } = expected
  const error = (x: number, y: number): number => {
    const i = 4 * (y * width + x) + 1
    return shown(picture.data[i]) - shown(expected.data[i])
  }
  const [edges, others] = [true, false].map(isEdge => {
    const steps: number[] = []
    for (let y = 0; y < height - 1; y++) {
      for (let x = 0; x < width - 1; x++) {
        const here = error(x, y)
        if (((x + 1) % APART === 0) === isEdge) steps.push(Math.abs(error(x + 1, y) - here))
        if (((y + 1) % APART === 0) === isEdge) steps.push(Math.abs(error(x, y + 1) - here))
      }
    }
    return steps.reduce((sum, step) => sum + step, 0) / steps.length
  })
  return edges / others
}

/** Shafts by the scene's materials, of qualities: by all steps for each pixel if it is the reference. There is a shadow map already. */
async function byMaterials(
  renderer: WebGPURenderer,
  { shafts, atmosphere, scene, camera }: Stage,
  qualities: readonly LightShaftsQuality[]
): Promise<Picture[]> {
  const pictures: Picture[] = []
  atmosphere.add(shafts)
  airScene(atmosphere, scene)
  for (const quality of qualities) {
    shafts.set({ quality })
    await nextFrame()
    if (quality !== 'reference') {
      // The volume that materials read is of the frame before.
      await drawForward(renderer, scene, camera, atmosphere)
      await nextFrame()
    }
    pictures.push(await drawForward(renderer, scene, camera, atmosphere))
  }
  atmosphere.remove(shafts)
  scene.backgroundNode = scene.fogNode = null
  return pictures
}

const goals: [LightShaftsQuality, number][] = [
  ['high', 48],
  ['medium', 46],
  ['low', 44]
]

gpuTest(
  'draws what 512 steps a pixel do, standing still',
  async t => {
    const renderer = await t.createRenderer(size)
    const set = stage(renderer, 15)
    const { shafts } = set
    city(set)
    for (const angle of [0.3, -0.9]) {
      turnTo(set, angle)
      shafts.enabled = false
      const lit = await set.draw()
      shafts.enabled = true
      // Away from the sun by the quality that is the default.
      const tried = angle > 0 ? goals : [goals[1]]
      const qualities = tried.map(([quality]) => quality)
      const [expected, ...byQuality] = await byMaterials(renderer, set, ['reference', ...qualities])
      t.note(`without shafts ${likeness(expected, lit).toFixed(1)} dB`)
      for (const [i, [quality, goal]] of tried.entries()) {
        shafts.set({ quality })
        await set.draw()
        const picture = await set.draw()
        const still = likeness(expected, picture)
        const { greatest, part } = bands(expected, picture)
        t.note(`${(1000 * part).toFixed(2)} ‰ of steps above a level, up to ${greatest.toFixed(1)}`)
        expectTrue(part < STEEP, `${quality} shafts have bands`)
        t.note(`${quality}: ${still.toFixed(1)} dB`)
        expectTrue(still >= goal, `${quality} shafts`)
        const drawn = byQuality[i]
        const forward = likeness(expected, drawn)
        const steep = bands(expected, drawn).part
        t.note(`materials ${forward.toFixed(1)} dB, ${(1000 * steep).toFixed(2)} ‰ steep`)
        expectTrue(steep < STEEP, `${quality} shafts of materials have bands`)
        expectTrue(forward >= 48, `${quality} shafts of materials`)
      }
    }
    set.dispose()
  },
  { backends: ['webgpu'] }
)

gpuTest(
  'draws what 512 steps a pixel do while the camera turns by 90° a second',
  async t => {
    const renderer = await t.createRenderer(half)
    const set = stage(renderer, 15)
    const { shafts } = set
    city(set)
    zoom(set)
    const angle = 0.3
    turnTo(set, angle)
    await set.draw()
    const [expected] = await byMaterials(renderer, set, ['reference'])
    shafts.set({ quality: 'medium' })
    for (const before of [3, 2, 1]) {
      turnTo(set, angle - before * TURN)
      await set.draw()
    }
    turnTo(set, angle)
    const turning = likeness(expected, await set.draw())
    t.note(`${turning.toFixed(1)} dB`)
    expectTrue(turning >= 40, 'turning')
    set.dispose()
  },
  // How shafts look is the same on both.
  { backends: ['webgpu'] }
)

/** Fog has more light than clear air to lose. */
const fogGoals: [LightShaftsQuality, number][] = [
  ['high', 42],
  ['medium', 41],
  ['low', 40]
]

gpuTest(
  'draws what 512 steps a pixel do in height and distance fog',
  async t => {
    const renderer = await t.createRenderer(half)
    const set = stage(renderer, 15)
    const { shafts, atmosphere } = set
    city(set)
    turnTo(set, 0.3)
    zoom(set)
    atmosphere.add(distanceFog({ density: 1 / 3000 }), heightFog({ density: 0.003, falloff: 80 }))
    shafts.enabled = false
    const lit = await set.draw()
    shafts.enabled = true
    const qualities = fogGoals.map(([quality]) => quality)
    const [expected, ...byQuality] = await byMaterials(renderer, set, ['reference', ...qualities])
    t.note(`without shafts ${likeness(expected, lit).toFixed(1)} dB`)
    for (const [i, [quality, goal]] of fogGoals.entries()) {
      shafts.set({ quality })
      const picture = await set.draw()
      const [still, lines] = [likeness(expected, picture), comb(expected, picture)]
      t.note(`${quality}: ${still.toFixed(1)} dB, comb ${lines.toFixed(2)}`)
      expectTrue(still >= goal, `${quality} shafts in fog`)
      expectTrue(lines <= COMB, `${quality} shafts have lines between the pixels that are marched`)
      const forward = likeness(expected, byQuality[i])
      t.note(`materials ${forward.toFixed(1)} dB`)
      expectTrue(forward >= 40, `${quality} shafts of materials in fog`)
    }
    set.dispose()
  },
  { backends: ['webgpu'] }
)

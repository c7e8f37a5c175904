import { Atmosphere, aerialPerspective } from '@welkin/atmosphere'
import { CloudLightTable, CloudNoise, cloudPreset, cloudQualities, clouds } from '@welkin/clouds'
import type { CloudQuality, CloudQualityName, CloudsNode } from '@welkin/clouds'
import { BoxGeometry, Mesh, MeshBasicMaterial, PerspectiveCamera, Scene, Vector3 } from 'three'
import { pass } from 'three/tsl'
import { RenderPipeline, type WebGPURenderer } from 'three/webgpu'
import { drawToFloat } from '../harness/atmosphere'
import { expectTrue } from '../harness/expect'
import { gpuTest } from '../harness/gpu-test'
import type { GpuContext } from '../harness/context'
import { nextFrame } from '../harness/graphics'
import type { Picture } from '../harness/picture'
import { setShadowSize } from '../harness/shadow-size'

const [width, height] = [64, 36]

/**
 * Size and field of view of a picture whose pixels are as narrow as those of 1920×1080 at 50°, which presets
 * are made for [°].
 */
const narrow = { size: [128, 72], fieldOfView: 5 } as const
const wide = { size: [width, height], fieldOfView: 20 } as const

/** Frames in which all shadow maps are drawn, each twice. */
const SHADOW_FRAMES = 24

/** Blocks of so many pixels are compared where the noise of single ones is not what is looked for. */
const BLOCK = 4

const sharp: CloudQuality = { ...cloudQualities.medium, block: 2 }

/** Parts that the skies of a test share. */
interface Shared {
  readonly renderer: WebGPURenderer
  readonly noise: CloudNoise
  readonly light: CloudLightTable
}

/** A view up at broken cumulus, on WGS84 at sea level, y up. */
class Sky {
  readonly node: CloudsNode
  readonly camera: PerspectiveCamera
  readonly scene = new Scene()
  readonly atmosphere = new Atmosphere().place({ longitude: 20, latitude: 45 })
  readonly #renderer: WebGPURenderer
  readonly #pipeline: RenderPipeline
  readonly #dispose: () => void

  constructor(
    { renderer, noise, light }: Shared,
    quality: CloudQualityName | CloudQuality = sharp,
    fieldOfView: number = wide.fieldOfView
  ) {
    this.#renderer = renderer
    this.camera = new PerspectiveCamera(fieldOfView, width / height, 0.1, 1e6)
    this.atmosphere.setSunAngles(40, 150)
    // Sunlit clouds are a little darker than white.
    this.atmosphere.luminanceScale = 3e-5
    this.camera.position.set(0, 2, 0)
    this.turn(0)
    const scenePass = pass(this.scene, this.camera, { samples: 0 })
    const depth = scenePass.getTextureNode('depth')
    const color = scenePass.getTextureNode()
    const air = aerialPerspective(color, depth, this.camera, this.atmosphere)
    const layers = cloudPreset('fairWeather')
    layers.at(0).set({ coverage: 0.45 })
    this.node = clouds(air, depth, this.camera, this.atmosphere, layers, { noise, light })
    this.node.quality = quality
    this.node.time = 0
    this.#pipeline = new RenderPipeline(renderer)
    this.#pipeline.outputColorTransform = false
    this.#pipeline.outputNode = this.node
    this.#dispose = () => {
      this.#pipeline.dispose()
      scenePass.dispose()
    }
  }

  /** Looks a little up, towards a heading [°]. */
  turn(heading: number): void {
    this.camera.rotation.set(0.6, (-heading * Math.PI) / 180, 0, 'YXZ')
    this.camera.updateMatrixWorld()
  }

  /** Draws frames; the last is read back. */
  async draw(frames = 1): Promise<Picture> {
    for (let i = 1; i < frames; i++) {
      await nextFrame()
      this.#pipeline.render()
    }
    await nextFrame()
    return drawToFloat(this.#renderer, () => this.#pipeline.render())
  }

  /**
   * Draws frames of a sky that stands still; the last is read back. Shadow maps, which cost a software renderer most of a
   * frame, are drawn in the first ones alone: drawn again they are the same.
   */
  async settle(frames: number): Promise<Picture> {
    const { shadows } = this.node
    const update = shadows.update.bind(shadows)
    await this.draw(SHADOW_FRAMES)
    shadows.update = () => undefined
    const picture = await this.draw(frames - SHADOW_FRAMES)
    shadows.update = update
    return picture
  }

  /** Accumulated samples of each pixel, of the last frame. */
  async samples(): Promise<number[]> {
    const { accumulated } = this.node.passes
    const target = accumulated.distances.value.renderTarget!
    const { width, height } = target
    const bytes = await this.#renderer.readRenderTargetPixelsAsync(target, 0, 0, width, height, 1)
    return Array.from({ length: width * height }, (_, i) => {
      const [high, low] = [bytes[4 * i + 2], bytes[4 * i + 3]]
      return Math.abs(256 * high + low - 2 ** 15) / 127
    })
  }

  dispose(): void {
    this.#dispose()
    this.node.dispose()
    this.atmosphere.dispose()
  }
}

/** Value on a screen, in [0, 1]. */
const shown = (value: number): number => Math.min(value, 1) ** (1 / 2.2)

/** Differences of colour as it is shown: of each pixel the largest. */
function differences(a: Picture, b: Picture): number[] {
  const result: number[] = []
  for (let i = 0; i < a.data.length; i += 4) {
    const apart = [0, 1, 2].map(k => Math.abs(shown(a.data[i + k]) - shown(b.data[i + k])))
    result.push(Math.max(...apart))
  }
  return result
}

/** Means of blocks of pixels, RGB. */
function blockMeans({ width, height, data }: Picture): number[] {
  const [columns, rows] = [width / BLOCK, height / BLOCK]
  const sums = Array.from({ length: 3 * columns * rows }, () => 0)
  for (let i = 0; i < width * height; i++) {
    const block = Math.floor(i / width / BLOCK) * columns + Math.floor((i % width) / BLOCK)
    for (let k = 0; k < 3; k++) sums[3 * block + k] += Math.min(data[4 * i + k], 1) / BLOCK ** 2
  }
  return sums
}

const mean = (values: readonly number[]): number =>
  values.reduce((sum, value) => sum + value, 0) / values.length

/** Mean difference. */
const apart = (a: readonly number[], b: readonly number[]): number =>
  mean(a.map((value, i) => Math.abs(value - b[i])))

async function withShared(
  t: GpuContext,
  body: (shared: Shared) => Promise<void>,
  [width, height]: readonly [number, number] = wide.size
): Promise<void> {
  setShadowSize('least')
  const renderer = await t.createRenderer({ width, height })
  const shared = { renderer, noise: new CloudNoise(), light: new CloudLightTable() }
  await body(shared)
  shared.noise.dispose()
  shared.light.dispose()
}

gpuTest(
  'a picture that stands still comes to rest',
  t =>
    withShared(t, async shared => {
      const sky = new Sky(shared)
      await sky.settle(100)
      let before = await sky.draw(36)
      let most = 0
      for (let i = 0; i < 5; i++) {
        const now = await sky.draw()
        most = Math.max(most, ...differences(now, before))
        before = now
      }
      t.note(`changes by ${(most * 255).toFixed(2)}/255 at most in a frame`)
      expectTrue(most < 1 / 255, `changes by ${most} in a frame`)
      sky.dispose()
    }),
  // The same passes as in the test with a pole, which both backends run.
  { backends: ['webgpu'] }
)

gpuTest(
  'rays that begin where the last frame has found clouds see what whole ones see, from the ground and from orbit',
  t =>
    withShared(
      t,
      async shared => {
        const sky = new Sky(shared, 'medium', narrow.fieldOfView)
        // Four rounds of a block.
        sky.node.quality = { ...cloudQualities.medium, block: 4 }
        const { frame } = sky.node.passes.viewRays
        const next = frame.next.bind(frame)
        // All pictures of a view have the same shadow maps.
        const { shadows } = sky.node
        const update = shadows.update.bind(shadows)
        for (const [height, pitch, frames] of [
          [2, 0.6, 80],
          [3e6, -1.3, 20]
        ]) {
          sky.camera.position.y = height
          sky.camera.rotation.x = pitch
          sky.camera.updateMatrixWorld()
          shadows.update = update
          await sky.draw(4)
          shadows.update = () => undefined
          const draw = async (isWhole: boolean): Promise<number[]> => {
            frame.next = (...inputs) => {
              next(...inputs)
              const isKnown = frame.unsureUntil.value === 0
              expectTrue(
                isKnown || frame.hasHistory.value === 0,
                'rays do not go by the last frame'
              )
              if (isWhole) frame.unsureUntil.value = 1e12
            }
            frame.reset()
            return blockMeans(await sky.draw(frames))
          }
          const [found, expected, again] = [await draw(false), await draw(true), await draw(true)]
          const [part, noise] = [found, again].map(each => apart(each, expected) / mean(expected))
          const figures = `off by ${(100 * part).toFixed(3)} %, whole ones by ${(100 * noise).toFixed(3)} %`
          t.note(`from ${height} m ${figures}`)
          // Pictures differ by their samples.
          expectTrue(
            part < 1.2 * noise,
            `from ${height} m rays that begin at clouds are ${figures}`
          )
          if (height < 1e6) expectTrue(part < 0.002, `rays that begin at clouds are ${figures}`)
        }
        sky.dispose()
      },
      narrow.size
    ),
  { backends: ['webgpu'] }
)

/**
 * Mean samples of the pixels that have been in sight for eight frames and more of a turn by 10 pixels a frame: half of a round of `high`. If
 * history counted less while the view turns, they were the last frame's alone, 0.16.
 */
async function samplesAfterTurn(sky: Sky): Promise<number> {
  for (let i = 12; i >= 0; i--) {
    sky.turn(-0.4 * i)
    await sky.draw()
  }
  const counts = await sky.samples()
  const [columns] = narrow.size
  return mean(counts.filter((_, i) => i % columns < columns / 3))
}

// Six frames after a turn new pixels of `medium` have 6 samples of 16, those of `high` 6 of 9: 2.2 and 1.0 %.
for (const [quality, most] of [
  ['medium', 0.024],
  ['high', 0.012]
] as const) {
  gpuTest(
    `turning by 90° a second leaves no trail, ${quality}`,
    t =>
      withShared(
        t,
        async shared => {
          const sky = new Sky(shared, quality, narrow.fieldOfView)
          const expected = blockMeans(await sky.settle(80))
          const level = mean(expected)
          for (let i = 16; i > 0; i--) {
            sky.turn(-1.5 * i)
            await sky.draw()
          }
          sky.turn(0)
          await sky.draw()
          const found: number[] = []
          for (let i = 0; i < 6; i++)
            found.push(apart(blockMeans(await sky.draw()), expected) / level)
          t.note(`off by ${found.map(part => (100 * part).toFixed(2)).join(', ')} %`)
          expectTrue(found[5] < most, `six frames after a turn pictures are off by ${found[5]}`)
          if (quality === 'high') {
            const samples = await samplesAfterTurn(sky)
            t.note(`${samples.toFixed(2)} samples after 12 frames of a turn`)
            expectTrue(samples > 0.3, `a turn leaves ${samples} samples of a pixel`)
          }
          sky.dispose()
        },
        narrow.size
      ),
    { backends: ['webgpu'] }
  )
}

gpuTest(
  'clouds in a storm of wind leave no trail',
  t =>
    withShared(
      t,
      async shared => {
        const sky = new Sky(shared, 'high', narrow.fieldOfView)
        const end = 60
        // 70 m/s, as in the strongest storms.
        for (let i = 40; i >= 0; i--) {
          sky.node.time = end - (8.75 * i) / 60
          if (i > 0) await sky.draw()
        }
        const drifting = blockMeans(await sky.draw())
        const expected = blockMeans(await sky.settle(60))
        const part = apart(drifting, expected) / mean(expected)
        t.note(`off by ${(100 * part).toFixed(2)} %`)
        expectTrue(part < 0.02, `drifting clouds are off by ${part}`)
        sky.dispose()
      },
      narrow.size
    ),
  { backends: ['webgpu'] }
)

gpuTest('a pole that sweeps across leaves no halo', t =>
  withShared(t, async shared => {
    const sky = new Sky(shared)
    const without = await sky.settle(60)
    const pole = new Mesh(new BoxGeometry(0.25, 40, 0.1), new MeshBasicMaterial({ color: 0 }))
    sky.scene.add(pole)
    let here: Picture | undefined
    for (let i = 0; i < 12; i++) {
      pole.position.set(-1.2 + i * 0.15, 10, -8)
      here = await sky.draw()
    }
    const picture = here!
    const isPole = (x: number, y: number): boolean => picture.at(x, y)[0] < 0.05
    const near: number[] = []
    for (let y = 0; y < height; y++) {
      for (let x = 3; x < width - 3; x++) {
        const about = [-3, -2, -1, 1, 2, 3].map(step => isPole(x + step, y))
        if (isPole(x, y) || !about.includes(true)) continue
        const bright = (rgb: readonly number[]): number =>
          mean(rgb.slice(0, 3).map(value => Math.min(value, 1)))
        near.push(bright(picture.at(x, y)) - bright(without.at(x, y)))
      }
    }
    const [halo, apart] = [mean(near), mean(near.map(Math.abs))]
    t.note(
      `${near.length} pixels beside the pole: brighter by ${halo.toFixed(4)}, off by ${apart.toFixed(4)}`
    )
    expectTrue(near.length > 50, `only ${near.length} pixels are beside the pole`)
    expectTrue(Math.abs(halo) < 0.02, `pixels beside the pole are brighter by ${halo}`)
    expectTrue(apart < 0.06, `pixels beside the pole are off by ${apart} in the mean`)
    pole.geometry.dispose()
    pole.material.dispose()
    sky.dispose()
  })
)

gpuTest(
  'moving the origin of the world moves no cloud; a jump of the camera starts anew',
  t =>
    withShared(t, async shared => {
      const sky = new Sky(shared)
      const before = await sky.settle(100)
      const shift = new Vector3(12_000, 300, -40_000)
      sky.camera.position.sub(shift)
      sky.camera.updateMatrixWorld()
      const { worldToECEF } = sky.atmosphere
      const e = worldToECEF.elements
      for (let row = 0; row < 3; row++) {
        e[12 + row] += e[row] * shift.x + e[4 + row] * shift.y + e[8 + row] * shift.z
      }
      const after = await sky.draw()
      const most = Math.max(...differences(before, after))
      t.note(`moving the origin changes ${(most * 255).toFixed(2)}/255 at most`)
      expectTrue(most < 3 / 255, `moving the origin changes ${most}`)

      sky.camera.position.y += 5000
      sky.camera.updateMatrixWorld()
      const jumped = await sky.draw()
      const fresh = new Sky(shared)
      fresh.camera.position.copy(sky.camera.position)
      fresh.camera.updateMatrixWorld()
      fresh.atmosphere.worldToECEF.copy(worldToECEF)
      const first = await fresh.draw(1)
      const apart = mean(differences(jumped, first))
      t.note(`after a jump the picture is off by ${apart.toFixed(4)} from a first one`)
      expectTrue(apart < 0.04, `after a jump the picture is off by ${apart}`)
      sky.dispose()
      fresh.dispose()
    }),
  // Matrices are of the CPU.
  { backends: ['webgpu'] }
)

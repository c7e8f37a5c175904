import type { AirShadow, LightShaftsQuality, ScreenShadows } from '@welkin/atmosphere'
import { Fn, float, log2, vec3, vec4 } from 'three/tsl'
import {
  Node,
  NodeUpdateType,
  RenderPipeline,
  type NodeFrame,
  type WebGPURenderer
} from 'three/webgpu'
import type { Bool, Float, Vec2 } from '../../../packages/atmosphere/src/tsl-types'
import { drawToFloat } from '../harness/atmosphere'
import { expectTrue } from '../harness/expect'
import { gpuTest } from '../harness/gpu-test'
import { nextFrame } from '../harness/graphics'
import { stage, stageSize as size, type Stage } from '../harness/shaft-stage'

/** Light in front of shafts, of which they take their part. */
const LIGHT = 1

/** A picture of even light less what shafts take, as a node of clouds draws it. */
class Dimmed extends Node {
  readonly #set: Stage
  readonly #screen: ScreenShadows

  constructor(set: Stage, screen: ScreenShadows) {
    super('vec4')
    this.#set = set
    this.#screen = screen
    this.updateBeforeType = NodeUpdateType.FRAME
  }

  override updateBefore(frame: NodeFrame): undefined {
    const seen = this.#set.shafts.view.prepare(frame)!
    this.#screen.prepareShadows(frame.renderer!, seen, frame)
    this.#screen.prepare!(frame.renderer!, seen, frame)
    this.#screen.update!(seen)
  }

  override setup(): Node {
    return Fn(() => vec4(this.#screen.dim(vec3(LIGHT)), 1))()
  }
}

/** Clouds, and the part of the light that arrives in the air, by the distance from the camera [m]. */
interface Clouds {
  readonly distanceAt: (at: Vec2) => Float
  readonly transmittanceAt: (at: Vec2) => Float
  readonly arrives: (distance: Float) => Float
  /** Angle of the camera's axis above the horizon [°]; left out, 0. */
  readonly pitch?: number
}

/** Light that rows of pictures lose before clouds, by the quality of the shafts. */
async function lostIn(
  renderer: WebGPURenderer,
  qualities: readonly LightShaftsQuality[],
  { distanceAt, transmittanceAt, arrives, pitch = 0 }: Clouds
): Promise<number[][]> {
  const set = stage(renderer, 12)
  const { shafts, depth, camera } = set
  camera.rotation.x = (pitch * Math.PI) / 180
  camera.updateMatrixWorld()
  const transmittance: AirShadow['transmittance'] =
    () =>
    ({ distance }) =>
      arrives(distance)
  shafts.add({ castInto: () => ({ transmittance }) })
  const octavesAt = (at: Vec2): Float => log2(distanceAt(at))
  const foreground = { isDrawn: true, octavesAt, transmittanceAt }
  const screen = shafts.upTo(depth, foreground)
  await set.draw()
  const pipeline = new RenderPipeline(renderer)
  pipeline.outputColorTransform = false
  pipeline.outputNode = new Dimmed(set, screen)
  const rows: number[][] = []
  for (const quality of qualities) {
    shafts.set({ quality })
    for (let frame = 0; frame < 2; frame++) {
      await nextFrame()
      const picture = await drawToFloat(renderer, () => pipeline.render())
      if (frame === 0) continue
      const row = Array.from({ length: size.width }, (_, x) => picture.at(x, size.height / 3)[1])
      rows.push(row.map(left => LIGHT - left))
    }
  }
  pipeline.dispose()
  set.dispose()
  return rows
}

/** True at single columns of pixels that the march's grid, of every third pixel, does not meet. */
const isBetween = (at: Vec2): Bool => at.x.mul(size.width).floor().mod(12).equal(5)

/** Largest error of the light that the air before a cloud loses, and of that beside its edge [–]. */
const MOST = 0.05

const fast = ['high', 'medium', 'low'] as const

gpuTest(
  'takes light before clouds as far as each pixel sees, at the edge of a near one before a far one, too',
  async t => {
    const renderer = await t.createRenderer(size)
    // All air is dark, between pixels of the grid another cloud begins.
    const edge = 31
    const nothing = float(0) as Float
    const [reference, ...rows] = await lostIn(renderer, ['reference', ...fast], {
      distanceAt: at => at.x.mul(size.width).greaterThan(edge).select(20_000, 4000),
      transmittanceAt: () => nothing,
      arrives: () => nothing
    })
    t.note(`lost ${reference[10].toFixed(4)} and ${reference[50].toFixed(4)}`)
    expectTrue(reference[edge + 1] > 1.5 * reference[edge - 2], 'more is lost before the far cloud')
    rows.forEach((row, i) => {
      const errors = row.map((lost, x) => Math.abs(lost / reference[x] - 1)).slice(2, -2)
      const most = Math.max(...errors)
      t.note(`${fast[i]}: ${(100 * most).toFixed(2)} % off at most, at ${errors.indexOf(most) + 2}`)
      expectTrue(most <= MOST, `${fast[i]}: light before clouds is ${most} off`)
    })
  },
  { backends: ['webgpu'] }
)

/** Light that single pixels lose more than they should, at most, as part of what they should. */
const MOST_OVER = 0.25

gpuTest(
  'takes no light in holes of a deck that the sky behind it has, nor before small clouds what all the air loses',
  async t => {
    const renderer = await t.createRenderer(size)
    const [near, none, all] = [3000, float(0) as Float, float(1) as Float]
    // A shaded deck with holes to a lit sky; then small clouds in a dark sky.
    const scenes: [string, Clouds][] = [
      [
        'holes',
        {
          distanceAt: () => float(near),
          transmittanceAt: at => isBetween(at).select(all, none),
          arrives: distance => distance.greaterThan(near).select(all, none)
        }
      ],
      [
        'small clouds',
        {
          distanceAt: () => float(near),
          transmittanceAt: at => isBetween(at).select(none, all),
          arrives: () => none
        }
      ]
    ]
    for (const [name, clouds] of scenes) {
      const [reference, ...rows] = await lostIn(renderer, ['reference', ...fast], clouds)
      rows.forEach((row, i) => {
        const over = row.map((lost, x) => lost / reference[x] - 1)
        const [most, least] = [Math.max(...over), Math.min(...over)]
        t.note(`${name}, ${fast[i]}: ${(100 * least).toFixed(1)} to ${(100 * most).toFixed(1)} %`)
        expectTrue(most <= MOST_OVER, `${name}, ${fast[i]}: ${most} more is lost at a pixel`)
      })
    }
  },
  { backends: ['webgpu'] }
)

/** Grain of the light that is lost before thin clouds: difference of neighbouring pixels' shares, at most [–]. */
const MOST_GRAIN = 0.025

gpuTest(
  'takes light before thin clouds high in a sky that is dark below them, with no grain and no flecks in their gaps',
  async t => {
    const renderer = await t.createRenderer(size)
    const high = 16_000
    const [none, all] = [float(0) as Float, float(1) as Float]
    const noiseOf = (at: Vec2): Float => at.x.mul(size.width).floor().mul(0.618).fract()
    const [reference, ...rows] = await lostIn(renderer, ['reference', ...fast], {
      distanceAt: at => noiseOf(at).mul(0.5).exp2().mul(high),
      transmittanceAt: at => noiseOf(at).mul(7).fract().mul(0.1).add(0.91).min(1),
      arrives: distance => distance.greaterThan(high).select(all, none),
      pitch: 30
    })
    rows.forEach((row, i) => {
      const shares = row.map((lost, x) => lost / reference[x])
      const steps = shares.slice(3, -2).map((share, x) => Math.abs(share - shares[x + 2]))
      const grain = Math.max(...steps)
      t.note(`${fast[i]}: ${(100 * grain).toFixed(1)} % of grain`)
      expectTrue(grain <= MOST_GRAIN, `${fast[i]}: grain of ${grain} before thin clouds`)
    })
  },
  { backends: ['webgpu'] }
)

import type { ScreenShadows } from '@welkin/atmosphere'
import { Fn, float, vec3, vec4 } from 'three/tsl'
import { Node, NodeUpdateType, RenderPipeline, type NodeFrame } from 'three/webgpu'
import type { Float, Vec2 } from '../../../packages/atmosphere/src/tsl-types'
import { drawToFloat } from '../harness/atmosphere'
import { expectTrue } from '../harness/expect'
import { gpuTest } from '../harness/gpu-test'
import { nextFrame } from '../harness/graphics'
import type { Picture } from '../harness/picture'
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

/** Largest error of the light that the air before a cloud loses, and of that beside its edge [–]. */
const MOST = 0.05

gpuTest(
  'takes light before clouds as far as each pixel sees, at the edge of a near one before a far one, too',
  async t => {
    const renderer = await t.createRenderer(size)
    const set = stage(renderer, 12)
    const { shafts, depth, camera } = set
    camera.updateMatrixWorld()
    // All air is dark, between pixels of the grid another cloud begins.
    shafts.add({ castInto: () => ({ transmittance: () => () => float(0) }) })
    const edge = 31
    const distanceAt = (at: Vec2): Float =>
      at.x.mul(size.width).greaterThan(edge).select(20_000, 4000)
    const nothing = float(0) as Float
    const screen = shafts.upTo(depth, {
      isDrawn: true,
      seenAt: at => ({ distance: distanceAt(at), transmittance: nothing })
    })
    await set.draw()
    const pipeline = new RenderPipeline(renderer)
    pipeline.outputColorTransform = false
    pipeline.outputNode = new Dimmed(set, screen)
    const draw = async (): Promise<Picture> => {
      await nextFrame()
      return drawToFloat(renderer, () => pipeline.render())
    }
    shafts.set({ quality: 'reference' })
    await draw()
    const reference = await draw()
    const lostAt = (picture: Picture, x: number): number =>
      LIGHT - picture.at(x, size.height / 3)[1]
    t.note(`lost ${lostAt(reference, 10).toFixed(4)} and ${lostAt(reference, 50).toFixed(4)}`)
    expectTrue(
      lostAt(reference, edge + 1) > 1.5 * lostAt(reference, edge - 2),
      'more is lost before the far cloud'
    )
    for (const quality of ['high', 'medium', 'low'] as const) {
      shafts.set({ quality })
      const picture = await draw()
      const errors = Array.from({ length: size.width - 4 }, (_, i) => {
        const expectedLoss = lostAt(reference, i + 2)
        return Math.abs(lostAt(picture, i + 2) / expectedLoss - 1)
      })
      const most = Math.max(...errors)
      t.note(`${quality}: ${(100 * most).toFixed(2)} % off at most, at ${errors.indexOf(most) + 2}`)
      expectTrue(most <= MOST, `${quality}: light before clouds is ${most} off`)
    }
    pipeline.dispose()
    set.dispose()
  }
)

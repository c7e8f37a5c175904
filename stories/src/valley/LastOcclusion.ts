import { FragmentPass, tableTarget } from '@welkin/atmosphere'
import { Matrix4, Vector2 } from 'three'
import type { PerspectiveCamera } from 'three'
import { ao } from 'three/addons/tsl/display/GTAONode.js'
import {
  float,
  Fn,
  If,
  mix,
  perspectiveDepthToViewZ,
  positionView,
  positionWorld,
  reference,
  renderGroup,
  smoothstep,
  texture,
  uniform,
  uv,
  vec2,
  vec4
} from 'three/tsl'
import type { Node, Renderer, TextureNode } from 'three/webgpu'
import { screenPlace } from './screenPlace'

/** Reach of ambient occlusion [m], and its samples. */
const REACH = 3
const SAMPLES = 6

/** Pictures for each that occlusion is found for: things keep theirs over a few. */
const EVERY = 8

/** Pictures for which it is found on after the camera has come to rest: twice, the second time for what was hidden at the first. */
const SETTLING = 2 * EVERY

/** Pixels along a side over those of the picture. */
const COARSE = 0.5

/** Distances from which occlusion fades, and at which it has: its reach is a few pixels there [m]. */
const SEEN = [700, 1000] as const

/** Difference of distances, over the distance, from which a place was hidden in the last frame. */
const HIDDEN = 0.03

type Vec4 = Node<'vec4'>

/**
 * Ambient occlusion of one of the eight pictures before, found from its depth by three's GTAO once it is drawn, and read by the next ones at
 * the place where each thing was: nothing is drawn twice.
 */
export class LastOcclusion {
  readonly #depth: TextureNode
  /** Share of the sky's light that comes in, and distance along the camera's axis [m]. */
  readonly #target = tableTarget('Occlusion', 1, 1)
  readonly #pass: FragmentPass
  readonly #occlusion: ReturnType<typeof ao>
  readonly #toScreen = uniform(new Matrix4()).setGroup(renderGroup)
  readonly #texel = uniform(new Vector2())
  /** Camera of the last picture: view and projection. */
  readonly #view = new Matrix4()
  readonly #projection = new Matrix4()
  #pictures = 0
  /** Pictures since the camera moved or things changed. */
  #still = 0

  /** @param depth - That of the scene's pass, as the renderer writes it. */
  constructor(renderer: Renderer, depth: TextureNode, camera: PerspectiveCamera) {
    // Things read it in the first frame.
    renderer.initRenderTarget(this.#target)
    this.#depth = texture(depth.value)
    const occlusion = ao(this.#depth, null as never, camera)
    occlusion.radius.value = REACH
    occlusion.samples.value = SAMPLES
    occlusion.resolutionScale = COARSE
    this.#occlusion = occlusion
    const [near, far] = ['near', 'far'].map(name => reference(name, 'float', camera))
    const read = (x: number, y: number): Node<'float'> =>
      occlusion.getTextureNode().sample(uv().add(vec2(x, y).mul(this.#texel))).r
    // The noise of its directions is five pixels wide: each of these has the mean of two by two.
    const smooth = read(-1.5, -0.5)
      .add(read(0.5, -1.5))
      .add(read(1.5, 0.5))
      .add(read(-0.5, 1.5))
      .mul(0.25)
    const viewZ = perspectiveDepthToViewZ(this.#depth.sample(uv()).r, near, far)
    this.#pass = new FragmentPass('Occlusion', vec4(smooth, viewZ.negate(), 0, 1))
  }

  /** Has it found anew: other things are drawn now. */
  reset(): void {
    this.#still = 0
  }

  /** Keeps the occlusion of every eighth picture once it was drawn, and its camera; of none while camera and things stand still. */
  update(renderer: Renderer, camera: PerspectiveCamera): void {
    const { width, height } = this.#depth.value.image as { width: number; height: number }
    const [columns, rows] = [width, height].map(pixels => Math.ceil(pixels * COARSE))
    const isSameSize = columns === this.#target.width && rows === this.#target.height
    const isSameView =
      this.#view.equals(camera.matrixWorldInverse) &&
      this.#projection.equals(camera.projectionMatrix)
    this.#view.copy(camera.matrixWorldInverse)
    this.#projection.copy(camera.projectionMatrix)
    if (!isSameSize || !isSameView) this.reset()
    const isSettled = this.#still++ >= SETTLING
    if (isSettled || this.#pictures++ % EVERY !== 0) return
    this.#target.setSize(columns, rows)
    this.#texel.value.set(1 / this.#target.width, 1 / this.#target.height)
    this.#pass.render(renderer, this.#target)
    this.#toScreen.value.multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse)
  }

  /** Share of the sky's light that comes to a fragment; all of it farther away than corners are seen. */
  sample(): Node<'float'> {
    return Fn(() => {
      const share = float(1).toVar()
      const distance = positionView.z.negate()
      If(distance.lessThan(SEEN[1]), () => {
        const toScreen = this.#toScreen as unknown as Node<'mat4'>
        const clip = toScreen.mul(vec4(positionWorld, 1)).toConst()
        const place = screenPlace(clip)
        const before = texture(this.#target.texture, place).level(float(0)).toConst() as Vec4
        const wasSeen = before.y.sub(clip.w).abs().lessThan(clip.w.mul(HIDDEN))
        If(wasSeen, () => {
          share.assign(mix(before.x, float(1), smoothstep(SEEN[0], SEEN[1], distance)))
        })
      })
      return share
    })()
  }

  /** Frees what it draws with. */
  dispose(): void {
    this.#pass.dispose()
    this.#target.dispose()
    this.#occlusion.dispose()
  }
}

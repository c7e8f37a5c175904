import { FragmentPass, tableTarget } from '@welkin/atmosphere'
import { NearestFilter, UnsignedByteType } from 'three'
import type { RenderTarget } from 'three'
import { Fn, texture, uv, vec4 } from 'three/tsl'
import type { Renderer } from 'three/webgpu'
import type { ShadingContext } from '../light/tsl/lighting'
import type { FrameUniforms } from './FrameUniforms'
import { withAerialPerspective } from './tsl/aerialPerspective'
import { conePrepass, TILE } from './tsl/conePrepass'
import { marchClouds } from './tsl/march'
import { interleavedNoise } from '../temporal/tsl/noisePattern'
import { gatherCells } from '../temporal/tsl/cells'
import { encodeDistance, type CloudPictures } from '../temporal/tsl/pictures'
import { viewRayAt, viewRayEnd, type ViewRayNodes } from './tsl/viewRay'
import { upscale } from '../temporal/tsl/upscale'
import { twoOutputs, type LevelTexture, type TwoOutputs, type Vec2 } from '../tsl-types'

/** What the pictures of clouds are made from. */
export interface CloudScene extends ShadingContext {
  readonly viewRays: ViewRayNodes
}

/** @param isPacked - Whether places are bytes. */
function pictureTarget(name: string, isPacked = false): RenderTarget {
  const target = tableTarget(`Welkin.Clouds${name}`, 1, 1, 2)
  if (isPacked) target.textures[1].type = UnsignedByteType
  return target
}

function picturesOf({ textures }: RenderTarget): CloudPictures {
  const [light, place] = textures.map(one => texture(one) as unknown as LevelTexture<Vec2>)
  return { light, place }
}

/** Marches one pixel of each block: light with the air in front of it, and where it is. */
function marchPixels(scene: CloudScene, clear: LevelTexture<Vec2>): TwoOutputs {
  const { field, viewRays } = scene
  const { frame } = viewRays
  return twoOutputs(([color, place]) =>
    Fn(() => {
      const block = uv().mul(frame.marchedSize).floor().toConst() as unknown as Vec2
      const tiles = frame.marchedSize.div(TILE).ceil().mul(TILE)
      const tile = block.add(0.5).div(tiles).toConst() as Vec2
      const pixel = block.mul(frame.block).add(frame.jitter).min(frame.size.sub(1))
      const at = pixel.add(0.5).div(frame.size).toConst() as Vec2
      const sight = viewRayAt(viewRays, at)
      const { direction, directionView } = sight
      const end = viewRayEnd(viewRays, at, sight)
      const marched = marchClouds(scene, {
        direction,
        end,
        jitter: interleavedNoise(block, frame.noiseShift),
        start: frame.isAmong.greaterThan(0).select(clear.sample(tile).level(0).x, 0)
      })
      color.assign(withAerialPerspective(field.view, marched, directionView, frame.gain))
      const distance = encodeDistance(marched.distance)
      place.assign(vec4(distance, encodeDistance(end), 0, marched.steps.div(256)))
      return vec4(0)
    })()
  )
}

/**
 * Draws the clouds of a camera: marches a part of the pixels in each frame, and puts them together with
 * those of the frames before.
 */
export class CloudRenderer {
  readonly #frame: FrameUniforms
  readonly #marched = pictureTarget('Marched')
  readonly #cells = pictureTarget('Cells')
  /** The picture, and that of the last frame, in turns. */
  readonly #accumulated = [0, 1].map(i => pictureTarget(`${i}`, true))
  readonly #approached = tableTarget('Welkin.CloudsApproach', 1, 1, 1, NearestFilter)
  readonly #approach: FragmentPass
  readonly #march: FragmentPass
  readonly #gather: FragmentPass
  readonly #upscale: readonly FragmentPass[]
  /** What was marched in the latest frame. */
  readonly marched = picturesOf(this.#marched)
  /** Both pictures: the shader chooses by {@link current}. */
  readonly pictures: readonly CloudPictures[] = this.#accumulated.map(picturesOf)
  /** Which one is the latest. */
  current = 0

  constructor(scene: CloudScene) {
    this.#frame = scene.viewRays.frame
    const clear = texture(this.#approached.texture) as unknown as LevelTexture<Vec2>
    this.#approach = new FragmentPass('Welkin.CloudsApproach', conePrepass(scene.viewRays))
    this.#march = new FragmentPass('Welkin.CloudsMarch', marchPixels(scene, clear))
    const { marched } = this
    this.#gather = new FragmentPass(
      'Welkin.CloudsGather',
      gatherCells(scene.field, scene.viewRays, marched)
    )
    const cells = picturesOf(this.#cells)
    this.#upscale = this.#accumulated.map((_, i) => {
      const history = picturesOf(this.#accumulated[1 - i])
      const output = upscale(scene.viewRays, marched, cells, history)
      return new FragmentPass('Welkin.CloudsUpscale', output)
    })
  }

  get #targets(): RenderTarget[] {
    return [this.#approached, this.#marched, this.#cells, ...this.#accumulated]
  }

  /** Size on the GPU [bytes]. */
  get bytes(): number {
    return this.#targets
      .flatMap(target => target.textures)
      .reduce((sum, { type, width, height }) => {
        return sum + width * height * (type === UnsignedByteType ? 4 : 8)
      }, 0)
  }

  /** Gives the pictures a size [pixels]; when it is another, their contents are gone. */
  setSize(width: number, height: number, block: number): void {
    const [first] = this.#accumulated
    if (first.width !== width || first.height !== height) {
      for (const target of this.#accumulated) target.setSize(width, height)
      this.#frame.reset()
    }
    this.#marched.setSize(Math.ceil(width / block), Math.ceil(height / block))
    const { width: across, height: down } = this.#marched
    this.#approached.setSize(Math.ceil(across / TILE), Math.ceil(down / TILE))
    this.#cells.setSize(this.#marched.width + 1, this.#marched.height + 1)
    this.#frame.size.value.set(width, height)
    this.#frame.marchedSize.value.set(this.#marched.width, this.#marched.height)
  }

  /** Draws a frame; `FrameUniforms.next` goes first. */
  render(renderer: Renderer): void {
    if (this.#frame.isAmong.value > 0) this.#approach.render(renderer, this.#approached)
    this.#march.render(renderer, this.#marched)
    this.#gather.render(renderer, this.#cells)
    this.current = 1 - this.current
    this.#upscale[this.current].render(renderer, this.#accumulated[this.current])
  }

  /** Frees the pictures. */
  dispose(): void {
    for (const target of this.#targets) target.dispose()
    for (const pass of [this.#approach, this.#march, this.#gather, ...this.#upscale]) pass.dispose()
  }
}

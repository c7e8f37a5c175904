import { FragmentPass, tableTarget } from '@welkin/atmosphere'
import { UnsignedByteType } from 'three'
import type { RenderTarget, Texture } from 'three'
import { Fn, texture, uv, vec4 } from 'three/tsl'
import type { Renderer } from 'three/webgpu'
import type { ShadingContext } from '../light/tsl/shadingContext'
import type { FrameUniforms } from './FrameUniforms'
import { interleavedNoise } from '../temporal/tsl/noisePattern'
import { gatherCells } from '../temporal/tsl/cells'
import { encodeDistance } from '../temporal/tsl/packing'
import type { CloudTargets } from '../temporal/tsl/renderTargets'
import { upscale } from '../temporal/tsl/upscale'
import { withAerialPerspective } from './tsl/aerialPerspective'
import { number } from '../uniforms'
import { debugPass } from './debugView'
import { marchClouds } from './tsl/march'
import { viewRayAt, viewRayEnd, type ViewRayNodes } from './tsl/viewRay'
import { twoOutputs, type LevelTexture, type TwoOutputs, type Vec2 } from '../tsl-types'

/** Inputs of a camera's passes. */
export interface CloudScene extends ShadingContext {
  readonly viewRays: ViewRayNodes
}

/** @param isPacked - Whether distances are bytes: see `pack`. */
function cloudTarget(name: string, isPacked = false): RenderTarget {
  const target = tableTarget(`Welkin.Clouds${name}`, 1, 1, 2)
  if (isPacked) target.textures[1].type = UnsignedByteType
  return target
}

function texturesOf({ textures }: RenderTarget): CloudTargets {
  const [light, distances] = textures.map(one => texture(one) as unknown as LevelTexture<Vec2>)
  return { light, distances }
}

/** A texture as a node whose `value` may be another one later. */
const textureNode = (value: Texture): LevelTexture<Vec2> & { value: Texture } =>
  texture(value) as unknown as LevelTexture<Vec2> & { value: Texture }

/** Marches one pixel of each block: light with the air in front of it, and its distances. */
function marchPixels(scene: CloudScene): TwoOutputs {
  const { field, viewRays } = scene
  const { frame } = viewRays
  return twoOutputs(([color, distances]) =>
    Fn(() => {
      const block = uv().mul(frame.marchedSize).floor().toConst() as unknown as Vec2
      const pixel = block.mul(frame.block).add(frame.jitter).min(frame.size.sub(1))
      const at = pixel.add(0.5).div(frame.size).toConst() as Vec2
      const ray = viewRayAt(viewRays, at)
      const { direction, directionView } = ray
      const end = viewRayEnd(viewRays, at, ray)
      const marched = marchClouds(scene, {
        direction,
        end,
        jitter: interleavedNoise(block, frame.noiseShift)
      })
      color.assign(withAerialPerspective(field.view, marched, directionView, frame.gain))
      const distance = encodeDistance(marched.distance)
      distances.assign(vec4(distance, encodeDistance(end), 0, marched.steps.div(256)))
      return vec4(0)
    })()
  )
}

/**
 * Render targets and passes of a camera's clouds. A frame takes three passes: the march of one pixel of each
 * block, the statistics of the cells between marched pixels, and the upscale, which blends them into the
 * history of the frames before.
 */
export class CloudRenderer {
  readonly frame: FrameUniforms
  readonly #marchedTarget = cloudTarget('Marched')
  readonly #cellsTarget = cloudTarget('Cells')
  /** History and the target drawn from it: swapped in each frame. */
  readonly #accumulatedTargets = [0, 1].map(i => cloudTarget(`Accumulated${i}`, true))
  readonly #march: FragmentPass
  readonly #gather: FragmentPass
  readonly #upscale: readonly FragmentPass[]
  /** Pixels that this frame has marched. */
  readonly marched = texturesOf(this.#marchedTarget)
  /** Accumulated light and distances of the latest frame: the nodes stay, their textures change. */
  readonly accumulated = {
    light: textureNode(this.#accumulatedTargets[0].textures[0]),
    distances: textureNode(this.#accumulatedTargets[0].textures[1])
  }
  /** Accumulated light, or a debug view. */
  readonly shown = textureNode(this.#accumulatedTargets[0].textures[0])
  /** Number of the debug view that is shown; 0 for the clouds. */
  readonly debug = number()
  #debugTarget: RenderTarget | null = null
  #debugPass: FragmentPass | null = null
  /** Index of the accumulated target that was drawn last. */
  #current = 0

  constructor(scene: CloudScene) {
    const { field, viewRays } = scene
    this.frame = viewRays.frame
    this.#march = new FragmentPass('Welkin.CloudsMarch', marchPixels(scene))
    const { marched } = this
    this.#gather = new FragmentPass('Welkin.CloudsGather', gatherCells(field, viewRays, marched))
    const cells = texturesOf(this.#cellsTarget)
    this.#upscale = this.#accumulatedTargets.map((_, i) => {
      const history = texturesOf(this.#accumulatedTargets[1 - i])
      const output = upscale(viewRays, marched, cells, history)
      return new FragmentPass('Welkin.CloudsUpscale', output)
    })
  }

  get #targets(): RenderTarget[] {
    return [this.#marchedTarget, this.#cellsTarget, ...this.#accumulatedTargets]
  }

  /** Sizes the render targets [pixels]; where the size changes, their contents are gone. */
  setSize(width: number, height: number, block: number): void {
    const [first] = this.#accumulatedTargets
    if (first.width !== width || first.height !== height) {
      for (const target of this.#accumulatedTargets) target.setSize(width, height)
      this.frame.reset()
    }
    const across = Math.ceil(width / block)
    const down = Math.ceil(height / block)
    this.#marchedTarget.setSize(across, down)
    this.#cellsTarget.setSize(across + 1, down + 1)
    this.frame.size.value.set(width, height)
    this.frame.marchedSize.value.set(across, down)
  }

  /** Draws a frame; `FrameUniforms.next` goes first. */
  render(renderer: Renderer): void {
    this.#march.render(renderer, this.#marchedTarget)
    this.#gather.render(renderer, this.#cellsTarget)
    this.#current = 1 - this.#current
    const target = this.#accumulatedTargets[this.#current]
    this.#upscale[this.#current].render(renderer, target)
    const [light, distances] = target.textures
    this.accumulated.light.value = this.shown.value = light
    this.accumulated.distances.value = distances
    if (this.debug.value > 0) this.#drawDebugView(renderer, target)
  }

  #drawDebugView(renderer: Renderer, { width, height }: RenderTarget): void {
    this.#debugTarget ??= tableTarget('Welkin.CloudsDebug', 1, 1)
    this.#debugPass ??= debugPass(this.debug, this.accumulated, this.marched)
    this.#debugTarget.setSize(width, height)
    this.#debugPass.render(renderer, this.#debugTarget)
    this.shown.value = this.#debugTarget.texture
  }

  /** Frees the render targets. */
  dispose(): void {
    for (const target of this.#targets) target.dispose()
    for (const pass of [this.#march, this.#gather, ...this.#upscale]) {
      pass.dispose()
    }
    this.#debugTarget?.dispose()
    this.#debugPass?.dispose()
  }
}

import { cloudVelocity, type CloudsNode } from '@welkin/clouds'
import { UnsignedByteType } from 'three'
import type { PerspectiveCamera, TextureDataType } from 'three'
import { bloom } from 'three/addons/tsl/display/BloomNode.js'
import { dof } from 'three/addons/tsl/display/DepthOfFieldNode.js'
import { fxaa } from 'three/addons/tsl/display/FXAANode.js'
import { smaa } from 'three/addons/tsl/display/SMAANode.js'
import { taau } from 'three/addons/tsl/display/TAAUNode.js'
import { traa } from 'three/addons/tsl/display/TRAANode.js'
import { builtinAOContext, rtt, vec4 } from 'three/tsl'
import type { Node, Renderer, RenderPipeline } from 'three/webgpu'
import type { ValleyAir } from '../valleyAir'
import { LastOcclusion } from './LastOcclusion'
import { lensOn } from './lens'
import { LocalExposure } from './LocalExposure'
import { PictureNode } from './PictureNode'
import { shutter } from './shutter'
import { smoothEdges } from './SmoothEdgesNode'
import { stillVelocity } from './stillVelocity'
import { ToneTable } from './ToneTable'

/** Ways to smooth edges. */
export const ANTIALIASING = {
  none: { label: 'None' },
  edges: { label: 'Along edges' },
  fxaa: { label: 'FXAA' },
  smaa: { label: 'SMAA' },
  traa: { label: 'TRAA (over frames)' },
  taau: { label: 'TAAU (over frames, of a quarter of the pixels)' }
} as const

/** Post effects over a picture. */
export interface PostEffects {
  antialiasing: keyof typeof ANTIALIASING
  /** Occlusion of the light of the sky (GTAO). */
  occlusion: boolean
  /** Land under a bright sky is shown brighter, the sky darker. */
  localExposure: boolean
  bloom: boolean
  depthOfField: boolean
  motionBlur: boolean
}

/** Strength of the glow around what is bright. */
const GLOW = 0.02

/** Pixels along a side of motion blur's velocities over those of the picture. */
const COARSE = 0.25

/** Pixels along a side of the pictures that are added up to a larger one (TAAU), over those of that. */
const SMALL = 0.5

type Disposable = { dispose(): void }

/** Picture that post effects follow. */
export interface FinishedPicture extends Pick<
  ValleyAir,
  'scenePass' | 'depth' | 'picture' | 'exposure'
> {
  /** Clouds in it, which move over the screen by themselves. */
  readonly clouds?: CloudsNode | undefined
}

/**
 * Post effects over the exposed picture of things that stand still, in the order of a camera: motion, lens, film.
 *
 * The scene's pass writes no velocities: its target would keep a second texture when they are off again, for which three does not
 * make its pipelines anew.
 */
export class PictureFinish {
  readonly #renderer: Renderer
  readonly #pipeline: RenderPipeline
  readonly #camera: PerspectiveCamera
  readonly #air: FinishedPicture
  /** Effects that are on, and what is to be freed with them. */
  #key = ''
  #used: Disposable[] = []
  #occlusion?: LastOcclusion
  #local?: LocalExposure

  constructor(
    renderer: Renderer,
    pipeline: RenderPipeline,
    camera: PerspectiveCamera,
    air: FinishedPicture
  ) {
    this.#renderer = renderer
    this.#pipeline = pipeline
    this.#camera = camera
    this.#air = air
    // The air asks for no colour where nothing is drawn.
    Object.assign(air.scenePass, { autoClearColor: false })
    // The table has the colours of the display.
    pipeline.outputColorTransform = false
  }

  /** Has the picture drawn with these effects; compiles if others were on. */
  set({
    antialiasing,
    occlusion,
    localExposure,
    bloom,
    depthOfField,
    motionBlur
  }: PostEffects): void {
    const effects = { antialiasing, occlusion, localExposure, bloom, depthOfField, motionBlur }
    const key = JSON.stringify(effects)
    if (key === this.#key) return
    this.#key = key
    this.dispose()
    this.#local = localExposure
      ? this.#keep(new LocalExposure(this.#renderer, this.#air.picture))
      : undefined
    const picture = this.#picture(effects)
    const shown = this.#keep(new ToneTable()).shown(this.#local?.shown(picture) ?? picture)
    const smooth = { edges: smoothEdges, fxaa, smaa }[antialiasing as string]
    this.#pipeline.outputNode =
      smooth === undefined
        ? shown
        : this.#keep(smooth(this.#drawn(shown, 'Shown', UnsignedByteType)))
    this.#pipeline.needsUpdate = true
  }

  /**
   * Takes what the next picture is exposed by.
   *
   * @param night - 1 by night, whose dark land stays dark; 0 by day.
   */
  beforeDrawn(luminanceScale: number, night: number): void {
    this.#local?.scaleTo(luminanceScale)
    if (this.#local !== undefined) this.#local.strength = 1 - night
  }

  /** Keeps what the next picture has of the one that was just drawn. */
  afterDrawn(luminanceScale: number): void {
    this.#occlusion?.update(this.#renderer, this.#camera)
    this.#local?.update(this.#renderer, luminanceScale)
  }

  /** Has occlusion found anew: other things are drawn now. */
  redrawOcclusion(): void {
    this.#occlusion?.reset()
  }

  /** Light of the scene after all that happens in the camera. */
  #picture(effects: PostEffects): Node {
    const { scenePass, exposure, depth } = this.#air
    const { antialiasing } = effects
    const scale = antialiasing === 'taau' ? SMALL : 1
    scenePass.setResolutionScale(scale)
    this.#air.picture.scale = scale
    const motion = antialiasing === 'traa' || scale < 1 ? this.#motion(scale) : null
    this.#occlusion = effects.occlusion
      ? this.#keep(new LastOcclusion(this.#renderer, depth, this.#camera))
      : undefined
    scenePass.contextNode =
      this.#occlusion === undefined ? null : builtinAOContext(this.#occlusion.sample())
    let picture: Node = exposure
    if (motion !== null) {
      const smooth = scale < 1 ? taau : traa
      const name = scale < 1 ? 'TAAU' : 'TRAA'
      const sharp = this.#texture(picture, name, scale)
      picture = this.#keep(smooth(sharp, depth, motion, this.#camera))
    }
    if (effects.depthOfField) {
      const sharp = this.#texture(picture, 'DoF')
      const { focus, range, blur } = lensOn(this.#air.picture)
      const lens = [focus, range, blur] as unknown as number[]
      picture = this.#keep(dof(sharp, scenePass.getViewZNode(), lens[0], lens[1], lens[2]))
    }
    if (effects.motionBlur) {
      // Unless an effect has drawn it anew, the picture that is metered is blurred, and then exposed.
      const blurred =
        picture === exposure
          ? exposure.exposed(shutter(this.#air.picture, motion ?? this.#motionOfCamera()))
          : shutter(this.#drawn(picture, 'MotionBlur'), motion ?? this.#motionOfCamera())
      // Bloom reads it, too.
      picture = effects.bloom ? this.#drawn(blurred, 'MotionBlur') : blurred
    }
    if (effects.bloom) {
      const halo = this.#keep(bloom(picture as never, GLOW, 0.7, 0))
      picture = (picture as unknown as { add(other: unknown): Node }).add(halo)
    }
    return picture
  }

  /** Motion of ground, clouds and sky over the screen since the last frame. */
  #motion(scale: number): ReturnType<typeof rtt> {
    return this.#texture(this.#velocities(), 'Motion', scale)
  }

  /** Coarse motion for motion blur. */
  #motionOfCamera(): PictureNode {
    const drawn = this.#drawn(this.#velocities(), 'Motion')
    drawn.scale = COARSE
    return drawn
  }

  /** Velocities of things and of the clouds before them. */
  #velocities(): Node {
    const { clouds, depth } = this.#air
    const still = stillVelocity(depth, this.#camera)
    return clouds ? this.#keep(cloudVelocity(still, clouds)) : still
  }

  /**
   * A picture that effects read at many places.
   *
   * @param name - Name of its pass.
   * @param resolutionScale - Pixels along a side over those of the canvas.
   */
  #texture(picture: Node, name: string, resolutionScale = 1): ReturnType<typeof rtt> {
    const options = { depthBuffer: false, resolutionScale }
    const texture = this.#keep(rtt(picture as never, null, null, options))
    texture.name = name
    return texture
  }

  /** A picture that effects read, not cleared before it is drawn, which saves time. */
  #drawn(picture: Node, name: string, type?: TextureDataType): PictureNode {
    return this.#keep(new PictureNode(name, vec4(picture as Node<'vec4'>), type))
  }

  #keep<T extends object>(used: T): T {
    this.#used.push(used as unknown as Disposable)
    return used
  }

  /** Frees what the effects drew with. */
  dispose(): void {
    for (const each of this.#used) each.dispose()
    this.#used = []
  }
}

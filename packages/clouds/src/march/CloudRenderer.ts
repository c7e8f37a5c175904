import { FragmentPass, outputs, tableTarget, type Outputs } from '@welkin/atmosphere'
import { FloatType, NearestFilter, UnsignedByteType, Vector2 } from 'three'
import type { RenderTarget, Texture, Vector3 } from 'three'
import { If, texture, uv, vec4 } from 'three/tsl'
import type { Renderer } from 'three/webgpu'
import type { CloudField } from '../density/CloudField'
import { compiledByKinds, kindsOf } from '../density/kinds'
import { WeatherMap } from '../density/WeatherMap'
import type { ShadingContext } from '../light/tsl/shadingContext'
import { gatherCells } from '../temporal/tsl/cells'
import { encodeDistance } from '../temporal/tsl/packing'
import type { CloudTargets } from '../temporal/tsl/renderTargets'
import { upscale } from '../temporal/tsl/upscale'
import { CastLight, type CastScene } from './CastLight'
import type { PrecipitationShafts } from '../precipitation/PrecipitationShafts'
import type { FallPass } from './FallPass'
import { withAerialPerspective } from './tsl/aerialPerspective'
import { clearAir, packFound, unpackFound } from './tsl/clearAir'
import { marchClouds } from './tsl/march'
import { marchedPixel, type MarchedTargets } from './tsl/marchedPixel'
import { shadePoints } from './tsl/shadePoints'
import { viewRayAt, viewRayEnd, type FrameInputs } from './tsl/viewRay'
import type { LevelTexture, Vec2, Vec4 } from '../tsl-types'

const _size = new Vector2()

/** Size of the target that is drawn into [pixels]. */
export function sizeOf(renderer: Renderer): { width: number; height: number } {
  const { width, height } = renderer.getRenderTarget() ?? renderer.getDrawingBufferSize(_size)
  return { width: Math.max(width, 1), height: Math.max(height, 1) }
}

/** Inputs of a camera's passes. */
export interface CloudScene extends ShadingContext, CastScene {
  readonly precipitation?: PrecipitationShafts
}

/** @param isPacked - True if distances are bytes: see `pack`. */
function cloudTarget(name: string, isPacked = false): RenderTarget {
  const target = tableTarget(`Welkin.Clouds${name}`, 1, 1, 2)
  const [, distances] = target.textures
  if (isPacked) {
    distances.type = UnsignedByteType
    distances.magFilter = distances.minFilter = NearestFilter
  }
  return target
}

/** Render target of {@link MarchedTargets}: distances of points are too fine for half floats. */
function marchedTarget(): RenderTarget {
  const target = tableTarget('Welkin.CloudsMarched', 1, 1, 3, NearestFilter)
  target.textures[0].type = FloatType
  return target
}

/** A texture node whose `value` may be another one later. */
type ChangingTexture = LevelTexture<Vec2> & { value: Texture }

const textureNode = (value: Texture): ChangingTexture =>
  texture(value) as unknown as ChangingTexture

function texturesOf({ textures }: RenderTarget): Record<keyof CloudTargets, ChangingTexture> {
  const [light, distances] = textures.map(textureNode)
  return { light, distances }
}

/** Has nodes of {@link texturesOf} read another target. */
function showTextures(nodes: ReturnType<typeof texturesOf>, { textures }: RenderTarget): void {
  const [light, distances] = textures
  nodes.light.value = light
  nodes.distances.value = distances
}

/**
 * Marches one pixel of each block: {@link MarchedTargets}.
 *
 * @param last - The last frame of them.
 */
function marchPixels(scene: CloudScene, last: CloudTargets): Outputs {
  const { viewRays } = scene
  return outputs<[Vec4, Vec4, Vec4]>(3, ([distances, shares, ray]) => {
    const { block, at, noise } = marchedPixel(viewRays)
    const viewRay = viewRayAt(viewRays, at)
    const end = viewRayEnd(viewRays, at, viewRay)
    const known = clearAir(viewRays, last.distances, block, viewRay.ndc, end)
    const clear = { ...known, unsureUntil: viewRays.frame.unsureUntil }
    const marched = marchClouds(scene, { direction: viewRay.direction, end, jitter: noise, clear })
    const { points, transmittance, distance, first, steps } = marched
    const found = packFound({ first, until: known.until, end, steps })
    distances.assign(points.distances)
    shares.assign(points.shares)
    ray.assign(vec4(encodeDistance(distance), encodeDistance(end), transmittance, found))
  })
}

/** Shades what was marched: light with the air in front of it, and its distances. */
function shadePixels(scene: CloudScene, marched: MarchedTargets, cast: CastLight): Outputs {
  const { field, viewRays } = scene
  return outputs<[Vec4, Vec4]>(2, ([color, distances]) => {
    const { at, noise } = marchedPixel(viewRays)
    const here = uv() as unknown as Vec2
    const found = cast.pointsAt(here)
    const { ray } = cast.rayAt(here)
    color.assign(vec4(0, 0, 0, 1))
    const { code, steps } = unpackFound(ray.w)
    distances.assign(vec4(ray.xy, code, steps))
    If(ray.z.lessThan(1), () => {
      const { direction, directionView } = viewRayAt(viewRays, at)
      const points = {
        distances: marched.distances.sample(here).level(0).toConst() as Vec4,
        shares: found.shares,
        lit: cast.litOn(found, direction, noise)
      }
      const radiance = shadePoints(scene, direction, points)
      const seen = { radiance, transmittance: ray.z, distance: ray.x.exp2() }
      color.assign(withAerialPerspective(field.view, seen, directionView, viewRays.frame.gain))
    })
  })
}

/**
 * Render targets and passes of a camera's clouds. A frame takes five passes: the weather around the camera, the
 * march of one pixel of each block, its light (before it, with most casters, {@link CastLight}; after it, while anything falls, {@link FallPass}), the statistics of the cells between marched pixels, and the upscale, which blends them
 * into the history of the frames before.
 */
export class CloudRenderer {
  readonly viewRays: FrameInputs
  readonly #marchedTarget = marchedTarget()
  readonly #shadedTarget = cloudTarget('Shaded')
  readonly #cellsTarget = cloudTarget('Cells')
  /** History and the target drawn from it: swapped in each frame. */
  readonly #accumulatedTargets = [0, 1].map(i => cloudTarget(`Accumulated${i}`, true))
  readonly #weatherMap: WeatherMap
  readonly #field: CloudField
  /** Kinds of the layers for which the march was compiled, and casters for which its light was. */
  #kinds = ''
  #castVersion = ''
  readonly #cast: CastLight
  readonly #fall: FallPass | undefined
  readonly #march: FragmentPass
  readonly #precipitation: PrecipitationShafts | undefined
  readonly #shade: FragmentPass
  readonly #gather: FragmentPass
  readonly #upscale: readonly FragmentPass[]
  /** Clouds of the pixels that this frame has marched, not lit. */
  readonly seen: MarchedTargets
  /** Light and distances of the pixels that this frame has marched, with what falls: the nodes stay, their textures change. */
  readonly marched = texturesOf(this.#shadedTarget)
  /** Cells between those pixels: see `Cell`. */
  readonly cells = texturesOf(this.#cellsTarget)
  /** Accumulated light and distances of the latest frame: the nodes stay, their textures change. */
  readonly accumulated = texturesOf(this.#accumulatedTargets[0])
  /** Index of the accumulated target that was drawn last. */
  #current = 0

  constructor(inputs: Omit<CloudScene, 'weatherMap'>) {
    const { field, viewRays, precipitation } = inputs
    this.#weatherMap = new WeatherMap(
      field,
      precipitation && (index => precipitation.fallOf(index))
    )
    this.#field = compiledByKinds(field)
    const scene = { ...inputs, field: this.#field, weatherMap: this.#weatherMap }
    this.viewRays = viewRays
    this.#march = new FragmentPass('Welkin.CloudsMarch', marchPixels(scene, this.marched))
    const [distances, shares, ray] = this.#marchedTarget.textures.map(textureNode)
    this.seen = { distances, shares, ray }
    this.#cast = new CastLight(scene, this.seen)
    this.#precipitation = precipitation
    const ofClouds = texturesOf(this.#shadedTarget)
    this.#fall = precipitation?.passOf(scene, this.seen, this.#cast, ofClouds)
    this.#shade = new FragmentPass('Welkin.CloudsShade', shadePixels(scene, this.seen, this.#cast))
    for (const { material } of [this.#march, this.#shade]) {
      const key = material.customProgramCacheKey.bind(material)
      material.customProgramCacheKey = () => key() + kindsOf(field) + this.#cast.version
    }
    const { marched: shaded, cells } = this
    this.#gather = new FragmentPass('Welkin.CloudsGather', gatherCells(field, viewRays, shaded))
    this.#upscale = this.#accumulatedTargets.map((_, i) => {
      const history = texturesOf(this.#accumulatedTargets[1 - i])
      const output = upscale(viewRays, shaded, cells, history)
      return new FragmentPass('Welkin.CloudsUpscale', output)
    })
  }

  get #targets(): RenderTarget[] {
    return [this.#marchedTarget, this.#shadedTarget, this.#cellsTarget, ...this.#accumulatedTargets]
  }

  /** Sizes the render targets [pixels]; where the size changes, their contents are gone. */
  setSize(width: number, height: number, block: number): void {
    const { frame } = this.viewRays
    const [first] = this.#accumulatedTargets
    if (first.width !== width || first.height !== height) {
      for (const target of this.#accumulatedTargets) target.setSize(width, height)
      frame.reset()
    }
    const across = Math.ceil(width / block)
    const down = Math.ceil(height / block)
    this.#marchedTarget.setSize(across, down)
    this.#cast.setSize(across, down)
    this.#fall?.setSize(across, down, block)
    this.#shadedTarget.setSize(across, down)
    this.#cellsTarget.setSize(across + 1, down + 1)
    frame.size.value.set(width, height)
    frame.marchedSize.value.set(across, down)
  }

  /**
   * Draws a frame; `FrameUniforms.next` goes first.
   *
   * @param up - Zenith of the camera, in the mapped space.
   */
  render(renderer: Renderer, up: Vector3): void {
    this.#compile()
    this.#weatherMap.render(renderer, up)
    this.#march.render(renderer, this.#marchedTarget)
    this.#cast.render(renderer)
    this.#shade.render(renderer, this.#shadedTarget)
    const isFalling = this.#precipitation?.isFalling === true
    showTextures(this.marched, this.#fall?.render(renderer, isFalling) ?? this.#shadedTarget)
    this.#gather.render(renderer, this.#cellsTarget)
    this.#current = 1 - this.#current
    const target = this.#accumulatedTargets[this.#current]
    this.#upscale[this.#current].render(renderer, target)
    showTextures(this.accumulated, target)
  }

  /** Compiles passes with code for storms anew where layers of storms come or go, and the light's pass where casters do. */
  #compile(): void {
    const kinds = kindsOf(this.#field)
    const { version } = this.#cast
    if (kinds !== this.#kinds) this.#march.material.needsUpdate = true
    if (kinds !== this.#kinds || version !== this.#castVersion) {
      this.#shade.material.needsUpdate = true
      if (this.#fall) this.#fall.version = kinds + version
    }
    this.#kinds = kinds
    this.#castVersion = version
  }

  /** Frees the render targets. */
  dispose(): void {
    this.#weatherMap.dispose()
    this.#cast.dispose()
    this.#fall?.dispose()
    for (const target of this.#targets) target.dispose()
    for (const pass of [this.#march, this.#shade, this.#gather, ...this.#upscale]) {
      pass.dispose()
    }
  }
}

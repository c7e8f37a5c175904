import { FragmentPass, outputs, tableTarget, type Outputs } from '@welkin/atmosphere'
import { FloatType, NearestFilter, type RenderTarget } from 'three'
import { float, If, texture, uv, vec2, vec3, vec4 } from 'three/tsl'
import type { Renderer } from 'three/webgpu'
import type { ShadingContext } from '../light/tsl/shadingContext'
import { CORNERS } from '../temporal/tsl/cells'
import { interleavedNoise } from '../temporal/tsl/noisePattern'
import { encodeDistance } from '../temporal/tsl/packing'
import type { Float, LevelTexture, Variable, Vec2, Vec3, Vec4 } from '../tsl-types'
import { number } from '../uniforms'
import { withAerialPerspective } from './tsl/aerialPerspective'
import type { FallOnRays, LitRays } from './tsl/fallOnRays'
import type { MarchedTargets } from './tsl/marchedPixel'
import { viewRayAt, type FrameInputs } from './tsl/viewRay'

/** Inputs of the pass. */
export interface FallScene extends ShadingContext {
  readonly viewRays: FrameInputs
}

/** Precipitation before and behind the clouds of a pixel, and the ray of both. */
export interface FallOnPixel {
  /** Light of what falls, with the air before it, as `withAerialPerspective` has it at a gain of 1. */
  readonly light: Vec3
  /** Share of the clouds' light that passes what falls before them. */
  readonly before: Float
  /** `MarchedTargets.ray` of clouds and of what falls. */
  readonly ray: Vec4
}

/**
 * Marched pixels of a frame from which on four of them share a ray in blocks up to 4 × 4: as many rays as a picture of 1920 × 1080 then has.
 * Fewer: tails of virga are lost in a grid in small pictures (*Virga*); more: they cost more than large ones.
 */
export const sharing = { from: 33_000 }

/** Marched pixels along an edge of those that share a ray: all have their own where all pixels are marched, or few, or few of each picture. */
export const fallBlockOf = (block: number, pixels: number): number =>
  block > 1 && block < 5 && pixels >= sharing.from ? 2 : 1

/** Factor of a share in [0, 1] that is packed as the fraction of a whole number, and of `packFound`'s numbers, which have 11 bits. */
const BEHIND = 0.5
const FOUND = 2048

/**
 * Differences of log₂ ends between which a ray that ends nearer than the pixel's own loses its weight, and the weight that is left:
 * greater, and rain before a ridge shows beside it, too (*Valley, all day*).
 */
const SAME_END = [-0.3, -0.1] as const
const LEAST_WEIGHT = 1e-3

/**
 * Precipitation on the rays of a frame, with its light: a pass between the march and the light of the clouds. It is softer than clouds are, and takes
 * many steps: four marched pixels share a ray, which goes through each of them in turn, and pixels take what lies between the
 * four rays around them. What falls is kept with its stretch of the ray, so that clouds and ground hide it at their own edges.
 */
export class FallPass {
  readonly #frame: FrameInputs['frame']
  readonly #target = fallTarget('Fall')
  readonly #spreadTarget = fallTarget('FallSpread')
  readonly #passes: readonly FragmentPass[]
  readonly #spread: readonly LevelTexture<Vec2>[]
  /** 1 while anything falls, else 0: textures are of an earlier frame. */
  readonly #falls = number()
  /** False until the passes were drawn, even if nothing falls: rain begins without a stutter. */
  #isCompiled = false

  constructor(scene: FallScene, precipitation: FallOnRays, marched: MarchedTargets, cast: LitRays) {
    this.#frame = scene.viewRays.frame
    const fallen = nodesOf(this.#target)
    this.#spread = nodesOf(this.#spreadTarget)
    // Ends and what `packFound` holds are too fine for half floats.
    this.#spreadTarget.textures[1].type = FloatType
    this.#passes = [
      new FragmentPass('Welkin.CloudsFall', draw(scene, precipitation, marched, cast)),
      new FragmentPass('Welkin.CloudsFallSpread', spread(scene, fallen, marched, cast))
    ]
  }

  /** Compiles the passes anew where casters have changed. */
  set version(version: string) {
    this.#isCompiled = false
    for (const { material } of this.#passes) {
      material.customProgramCacheKey = () => material.name + version
      material.needsUpdate = true
    }
  }

  /** @param block - Edge of the blocks of which a frame marches one pixel each. */
  setSize(width: number, height: number, block: number): void {
    const shared = fallBlockOf(block, width * height)
    this.#frame.fallBlock.value = shared
    this.#target.setSize(Math.ceil(width / shared), Math.ceil(height / shared))
    this.#spreadTarget.setSize(width, height)
  }

  /** Draws the passes where anything falls; the march and the casters' light go first. */
  render(renderer: Renderer, isFalling: boolean): void {
    this.#falls.value = Number(isFalling)
    if (this.#isCompiled && !isFalling) return
    this.#isCompiled = true
    const [draw, spread] = this.#passes
    draw.render(renderer, this.#target)
    spread.render(renderer, this.#spreadTarget)
  }

  /**
   * Precipitation before and behind the clouds of a pixel. To be called inside of a shader function.
   *
   * @param clouds - The pixel's ray, with clouds alone.
   */
  read(here: Vec2, clouds: Vec4): FallOnPixel {
    const falls = this.#falls.greaterThan(0).toConst()
    const [light, ray] = this.#spread.map(each => each.sample(here).level(0).toConst() as Vec4)
    const found = ray.w.floor().toConst() as Float
    return {
      light: falls.select(light.xyz.div(this.#frame.nightGain), vec3(0)).toConst(),
      before: falls.select(ray.w.sub(found).div(BEHIND), 1).toConst(),
      ray: falls.select(vec4(ray.xyz, found.div(FOUND)), clouds).toConst()
    }
  }

  /** Frees its textures. */
  dispose(): void {
    this.#isCompiled = false
    for (const each of [this.#target, this.#spreadTarget, ...this.#passes]) each.dispose()
  }
}

const fallTarget = (name: string): RenderTarget =>
  tableTarget(`Welkin.Clouds${name}`, 1, 1, 2, NearestFilter)

const nodesOf = ({ textures }: RenderTarget): LevelTexture<Vec2>[] =>
  textures.map(each => texture(each) as unknown as LevelTexture<Vec2>)

/** log₂ of where a ray ends: nothing is seen behind opaque clouds. */
const endOf = (ray: Vec4, { x, y, z, w }: Vec4): Float =>
  ray.z
    .greaterThan(0)
    .select(ray.y, encodeDistance(x.max(y).max(z.max(w))))
    .toConst()

function draw(
  scene: FallScene,
  precipitation: FallOnRays,
  marched: MarchedTargets,
  cast: LitRays
): Outputs {
  const { frame } = scene.viewRays
  return outputs<[Vec4, Vec4]>(2, ([radiance, fallen]) => {
    const { marchedSize, block, jitter, size, fallBlock, fallPixel, nightGain, noiseShift } = frame
    const texel = uv().mul(marchedSize.div(fallBlock).ceil()).floor().toConst() as unknown as Vec2
    const own = texel.mul(fallBlock).add(fallPixel).min(marchedSize.sub(1)).toConst() as Vec2
    const here = own.add(0.5).div(marchedSize).toConst() as Vec2
    const pixel = own.mul(block).add(jitter).min(size.sub(1))
    const { direction, directionView } = viewRayAt(
      scene.viewRays,
      pixel.add(0.5).div(size).toConst()
    )
    const { ray, litFall } = cast.rayAt(here)
    const distances = marched.distances.sample(here).level(0).toConst() as Vec4
    const noise = interleavedNoise(texel, noiseShift)
    const looked = { direction, jitter: noise, marched: ray, litFall }
    const seen = precipitation.among(scene, looked, distances)
    // Moonlit rain is a millionth of sunlit rain: too faint for half floats.
    const { opacity, distance } = seen
    const bare = { radiance: seen.radiance, transmittance: opacity.oneMinus(), distance }
    radiance.assign(withAerialPerspective(scene.field.view, bare, directionView, nightGain))
    const [middle, half, end] = [distance, seen.half, seen.end].map(encodeDistance)
    fallen.assign(vec4(opacity, middle, half, end))
  })
}

/** Spreads what rays have found over the pixels between them: before and behind each pixel's own clouds, up to its own end. */
function spread(
  { viewRays }: FallScene,
  fallen: readonly LevelTexture<Vec2>[],
  marched: MarchedTargets,
  cast: LitRays
): Outputs {
  const { marchedSize, fallBlock, fallPixel } = viewRays.frame
  return outputs<[Vec4, Vec4]>(2, ([radiance, seen]) => {
    const here = uv() as unknown as Vec2
    const size = marchedSize.div(fallBlock).ceil().toConst() as Vec2
    const place = here.mul(marchedSize).floor().sub(fallPixel).div(fallBlock).toConst() as Vec2
    const first = place.floor().toConst() as Vec2
    const part = place.sub(first).toConst() as Vec2
    const { ray } = cast.rayAt(here)
    const { shares } = cast.pointsAt(here)
    const distances = marched.distances.sample(here).level(0).toConst() as Vec4
    const end = endOf(ray, distances)
    const corners = CORNERS.map(([x, y]) => {
      const index = first.add(vec2(x, y)).clamp(vec2(0), size.sub(1))
      const at = index.add(0.5).div(size).toConst() as Vec2
      const own = fallen[1].sample(at).level(0).toConst() as Vec4
      const between = (x ? part.x : part.x.oneMinus()).mul(y ? part.y : part.y.oneMinus())
      const fits = own.w
        .sub(end)
        .smoothstep(...SAME_END)
        .add(LEAST_WEIGHT)
      return { at, own, weight: between.mul(fits).toConst() }
    })
    const weights = corners.reduce<Float>((sum, { weight }) => sum.add(weight), float(0))
    const most = corners.reduce<Float>((sum, { own }) => sum.max(own.x), float(0))
    radiance.assign(vec4(0))
    const found = ray.w.mul(FOUND).round().toConst() as Float
    seen.assign(vec4(ray.xyz, found.add(BEHIND)))
    If(most.greaterThan(0), () => {
      /** Sums of opacity, and by that of its stretch. */
      const sums = vec3(0).toVar() as Variable<Vec3>
      const light = vec4(0).toVar() as Variable<Vec4>
      for (const { at, own, weight } of corners) {
        sums.addAssign(vec3(1, own.yz).mul(own.x.mul(weight)))
        light.addAssign(fallen[0].sample(at).level(0).mul(weight))
      }
      const perWeight = weights.reciprocal().toConst() as Float
      const opacity = sums.x.mul(perWeight).toConst() as Float
      const [middle, half] = [sums.y, sums.z].map(
        sum => sum.div(sums.x.max(1e-6)).exp2().toConst() as Float
      )
      /** Parts of it that lie before distances. */
      const before = (distance: Vec4): Vec4 =>
        distance.sub(middle).div(half.mul(2)).add(0.5).clamp().toConst()
      const all = before(vec4(end.exp2())).x
      const beforePoints = before(distances)
      const hidden = shares.dot(vec4(all).sub(beforePoints).max(0))
      const shown = all.sub(hidden).max(0).toConst() as Float
      const ofClouds = shares.dot(beforePoints.mul(opacity).oneMinus()).toConst() as Float
      const weight = opacity.mul(shown).toConst() as Float
      const both = weight.add(ofClouds).max(1e-9)
      const distance = middle.mul(weight).add(ray.x.exp2().mul(ofClouds)).div(both)
      const through = opacity.mul(all).oneMinus().mul(ray.z)
      const share = ofClouds.div(shares.dot(vec4(1)).max(1e-6)).clamp()
      radiance.assign(light.mul(shown.mul(perWeight)))
      seen.assign(vec4(encodeDistance(distance), ray.y, through, found.add(share.mul(BEHIND))))
    })
  })
}

import { FragmentPass, outputs, tableTarget, type Outputs } from '@welkin/atmosphere'
import { NearestFilter, type RenderTarget } from 'three'
import { float, If, texture, uv, vec2, vec3, vec4 } from 'three/tsl'
import type { Renderer } from 'three/webgpu'
import type { ShadingContext } from '../light/tsl/shadingContext'
import { interleavedNoise } from '../temporal/tsl/noisePattern'
import { endOf } from '../precipitation/tsl/fallStretch'
import { encodeDistance } from '../temporal/tsl/packing'
import type { CloudTargets } from '../temporal/tsl/renderTargets'
import {
  loop,
  type Float,
  type LevelTexture,
  type Variable,
  type Vec2,
  type Vec3,
  type Vec4
} from '../tsl-types'
import { withAerialPerspective } from './tsl/aerialPerspective'
import type { FallOnRays, LitRays } from './tsl/fallOnRays'
import type { MarchedTargets } from './tsl/marchedPixel'
import { rayWeights } from './tsl/rayWeights'
import { viewRayAt, type FrameInputs } from './tsl/viewRay'

/** Inputs of the pass. */
export interface FallScene extends ShadingContext {
  readonly viewRays: FrameInputs
}

/**
 * Marched pixels of a frame from which on four of them share a ray in blocks up to 5 × 5: as many rays as a picture of 1920 × 1080 then has.
 * Fewer: tails of virga are lost in a grid in small pictures (*Virga*); more: they cost more than large ones.
 */
export const sharing = { from: 33_000 }

/** Marched pixels along an edge of those that share a ray: all have their own where all pixels are marched, or few, or few of each picture. */
export const fallBlockOf = (block: number, pixels: number): number =>
  block > 1 && block < 6 && pixels >= sharing.from ? 2 : 1

/**
 * Differences of log₂ ends between which a ray that ends nearer than the pixel's own loses its weight, and the weight that is left:
 * greater, and rain before a ridge shows beside it, too (*Valley, all day*).
 */
const SAME_END = [-0.3, -0.1] as const
const LEAST_WEIGHT = 1e-3

/**
 * Precipitation on the rays of a frame, with its light: two passes after the light of the clouds, which knows nothing of it. It is softer than clouds
 * are, and takes many steps: four marched pixels share a ray between them, others in each round, and pixels take what lies between the
 * rays around them, before and behind their clouds. What falls is kept with its stretch of the ray, so that clouds and ground hide it at
 * their own edges.
 */
export class FallPass {
  readonly #frame: FrameInputs['frame']
  readonly #target = tableTarget('Welkin.CloudsFall', 1, 1, 2, NearestFilter)
  readonly #spreadTarget = tableTarget('Welkin.CloudsFallSpread', 1, 1, 2)
  readonly #passes: readonly FragmentPass[]
  /** False until the passes were drawn, even if nothing falls: rain begins without a stutter. */
  #isCompiled = false

  constructor(
    scene: FallScene,
    precipitation: FallOnRays,
    marched: MarchedTargets,
    cast: LitRays,
    shaded: CloudTargets
  ) {
    this.#frame = scene.viewRays.frame
    const fallen = nodesOf(this.#target)
    this.#passes = [
      new FragmentPass('Welkin.CloudsFall', draw(scene, precipitation, marched, cast)),
      new FragmentPass('Welkin.CloudsFallSpread', spread(scene, fallen, marched, cast, shaded))
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

  /**
   * Draws the passes where anything falls; the light of the clouds goes first.
   *
   * @returns Light and distances of clouds and of what falls; undefined where nothing does.
   */
  render(renderer: Renderer, isFalling: boolean): RenderTarget | undefined {
    if (isFalling || !this.#isCompiled) {
      this.#isCompiled = true
      const [draw, spread] = this.#passes
      draw.render(renderer, this.#target)
      spread.render(renderer, this.#spreadTarget)
    }
    return isFalling ? this.#spreadTarget : undefined
  }

  /** Frees its textures. */
  dispose(): void {
    this.#isCompiled = false
    for (const each of [this.#target, this.#spreadTarget, ...this.#passes]) each.dispose()
  }
}

/**
 * Middle of the pixels that share a ray, from the first of them: the ray goes there, as far from each. Through one of them: grain of that one
 * is stronger, and a screen door easier to see (*Rain and snow*).
 */
const middleOf = (fallBlock: Float): Float => fallBlock.sub(1).mul(0.5)

const nodesOf = ({ textures }: RenderTarget): LevelTexture<Vec2>[] =>
  textures.map(each => texture(each) as unknown as LevelTexture<Vec2>)

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
    const pixel = own.add(middleOf(fallBlock)).mul(block).add(jitter).min(size.sub(1))
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

/** Lays what rays have found over the pixels between them: before and behind each pixel's own clouds, up to its own end. */
function spread(
  { viewRays }: FallScene,
  fallen: readonly LevelTexture<Vec2>[],
  marched: MarchedTargets,
  cast: LitRays,
  shaded: CloudTargets
): Outputs {
  const { marchedSize, fallBlock, fallPixel, gain, nightGain } = viewRays.frame
  return outputs<[Vec4, Vec4]>(2, ([color, seen]) => {
    const here = uv() as unknown as Vec2
    const size = marchedSize.div(fallBlock).ceil().toConst() as Vec2
    const pixel = here.mul(marchedSize).floor().sub(fallPixel).sub(middleOf(fallBlock))
    const place = pixel.div(fallBlock).toConst() as Vec2
    const nearest = place.add(0.5).floor().toConst() as Vec2
    const past = place.sub(nearest).toConst() as Vec2
    const ofClouds = shaded.light.sample(here).level(0).toConst() as Vec4
    const known = shaded.distances.sample(here).level(0).toConst() as Vec4
    color.assign(ofClouds)
    seen.assign(known)
    const { ray } = cast.rayAt(here)
    const distances = marched.distances.sample(here).level(0).toConst() as Vec4
    const end = endOf(ray, distances)
    const weights = float(0).toVar() as Variable<Float>
    /** Sums of opacity, and by that of its stretch. */
    const sums = vec3(0).toVar() as Variable<Vec3>
    const light = vec4(0).toVar() as Variable<Vec4>
    loop('fallRay', 9, index => {
      const row = float(index).div(3).floor().toConst() as Float
      const step = vec2(float(index).sub(row.mul(3)), row)
        .sub(1)
        .toConst() as Vec2
      const share = rayWeights(past, step, fallBlock)
      const at = nearest.add(step).clamp(vec2(0), size.sub(1)).add(0.5).div(size).toConst() as Vec2
      const own = fallen[1].sample(at).level(0).toConst() as Vec4
      const fits = own.w
        .sub(end)
        .smoothstep(...SAME_END)
        .add(LEAST_WEIGHT)
      const weight = share.x.mul(share.y).mul(fits).toConst() as Float
      weights.addAssign(weight)
      If(own.x.mul(weight).greaterThan(0), () => {
        sums.addAssign(vec3(1, own.yz).mul(own.x.mul(weight)))
        light.addAssign(fallen[0].sample(at).level(0).mul(weight))
      })
    })
    If(sums.x.greaterThan(0), () => {
      const { shares } = cast.pointsAt(here)
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
      const left = shares.dot(beforePoints.mul(opacity).oneMinus()).toConst() as Float
      const weight = opacity.mul(shown).toConst() as Float
      const both = weight.add(left).max(1e-9)
      const distance = middle.mul(weight).add(ray.x.exp2().mul(left)).div(both)
      const through = opacity.mul(all).oneMinus().mul(ray.z)
      const share = left.div(shares.dot(vec4(1)).max(1e-6)).clamp()
      const added = light.rgb.mul(shown.mul(perWeight).mul(gain.div(nightGain)))
      color.assign(vec4(ofClouds.rgb.mul(share).add(added), through))
      seen.assign(vec4(encodeDistance(distance), known.yzw))
    })
  })
}

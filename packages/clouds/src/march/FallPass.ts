import { FragmentPass, outputs, tableTarget, type Outputs } from '@welkin/atmosphere'
import { NearestFilter } from 'three'
import { float, texture, uv, vec2, vec3, vec4 } from 'three/tsl'
import type { Node, Renderer } from 'three/webgpu'
import type { ShadingContext } from '../light/tsl/shadingContext'
import type { PrecipitationShafts } from '../precipitation/PrecipitationShafts'
import { interleavedNoise } from '../temporal/tsl/noisePattern'
import { encodeDistance } from '../temporal/tsl/packing'
import type { Float, LevelTexture, Variable, Vec2, Vec3, Vec4 } from '../tsl-types'
import type { CastLight } from './CastLight'
import { fallBlockOf } from './FrameUniforms'
import type { MarchedTargets } from './tsl/marchedPixel'
import type { SeenPoints } from './tsl/seenPoints'
import { viewRayAt, type FrameInputs } from './tsl/viewRay'

/** Inputs of the pass. */
export interface FallScene extends ShadingContext {
  readonly viewRays: FrameInputs
}

/** What falls before and behind the clouds of a pixel. */
export interface FallOnPixel {
  /** Spectral radiance for unit irradiance of the bare sun [1/sr]. */
  readonly radiance: Vec4
  /** Share of light that passes it. */
  readonly transmittance: Float
  /** Share of the clouds' light that passes what falls before them. */
  readonly before: Float
  /** Mean distance of clouds and of what falls, by what is seen of them [m]. */
  readonly distance: Float
}

/**
 * log₂ of ends over which a ray is left out that ends before the pixel's does, and the weight that is left: greater, and rain before a ridge
 * shows beside it, too (*Valley, all day*).
 */
const SAME_END = [-0.3, -0.1] as const
const LEAST_WEIGHT = 1e-3

/** Corners of a cell between four rays. */
const CORNERS = [
  [0, 0],
  [1, 0],
  [0, 1],
  [1, 1]
] as const

/**
 * Precipitation on the rays of a frame, with its light: a pass between the march and the light of the clouds. It is softer than clouds are, and takes
 * many steps: four marched pixels share a ray, which goes through each of them in turn, and pixels take what lies between the
 * four rays around them. What falls is kept with its stretch of the ray, so that clouds and ground hide it at their own edges.
 */
export class FallPass {
  readonly #frame: FrameInputs['frame']
  readonly #target = tableTarget('Welkin.CloudsFall', 1, 1, 2, NearestFilter)
  readonly #pass: FragmentPass
  readonly #fallen: readonly LevelTexture<Vec2>[]

  constructor(
    scene: FallScene,
    precipitation: PrecipitationShafts,
    marched: MarchedTargets,
    cast: CastLight
  ) {
    this.#frame = scene.viewRays.frame
    this.#fallen = this.#target.textures.map(each => texture(each) as unknown as LevelTexture<Vec2>)
    this.#pass = new FragmentPass('Welkin.CloudsFall', draw(scene, precipitation, marched, cast))
  }

  /** Has the pass compiled anew where casters have changed. */
  set version(version: string) {
    const { material } = this.#pass
    material.customProgramCacheKey = () => version
    material.needsUpdate = true
  }

  /** @param block - Edge of the blocks of which a frame marches one pixel each. */
  setSize(width: number, height: number, block: number): void {
    const shared = fallBlockOf(block)
    this.#target.setSize(Math.ceil(width / shared), Math.ceil(height / shared))
  }

  /** Draws the pass; the march and the casters' light go first. */
  render(renderer: Renderer): void {
    this.#pass.render(renderer, this.#target)
  }

  /**
   * Precipitation before and behind the clouds of a pixel. To be called inside of a shader function.
   *
   * @param here - Place in the marched picture.
   * @param ray - Its ray: log₂ of the clouds' distance and of its end, transmittance.
   * @param points - Clouds on it.
   */
  read(here: Vec2, ray: Vec4, { distances, shares }: SeenPoints): FallOnPixel {
    const { marchedSize, fallBlock, fallPixel, nightGain } = this.#frame
    const size = marchedSize.div(fallBlock).ceil().toConst() as Vec2
    const place = here.mul(marchedSize).floor().sub(fallPixel).div(fallBlock).toConst() as Vec2
    const first = place.floor().toConst() as Vec2
    const part = place.sub(first).toConst() as Vec2
    const end = endOf(ray, distances)
    const radiance = vec4(0).toVar() as Variable<Vec4>
    /** Sums of opacity, and by that of its stretch. */
    const sums = vec3(0).toVar() as Variable<Vec3>
    const weights = float(0).toVar() as Variable<Float>
    for (const [x, y] of CORNERS) {
      const index = first.add(vec2(x, y)).clamp(vec2(0), size.sub(1))
      const at = index.add(0.5).div(size).toConst() as Vec2
      const [light, fallen] = this.#fallen.map(each => each.sample(at).level(0).toConst() as Vec4)
      const between = (x ? part.x : part.x.oneMinus()).mul(y ? part.y : part.y.oneMinus())
      const fits = fallen.w.sub(end).smoothstep(...SAME_END).add(LEAST_WEIGHT)
      const weight = between.mul(fits).toConst() as Float
      radiance.addAssign(light.mul(weight))
      sums.addAssign(vec3(1, fallen.yz).mul(fallen.x.mul(weight)))
      weights.addAssign(weight)
    }
    const opacity = sums.x.div(weights).toConst() as Float
    const [middle, half] = [sums.y, sums.z].map(
      sum => sum.div(sums.x.max(1e-6)).exp2().toConst() as Float
    )
    /** Part of it that lies before distances. */
    const before = <T extends Float | Vec4>(distance: T): T =>
      (distance as Float).sub(middle).div(half.mul(2)).add(0.5).clamp().toConst() as Node as T
    const all = before(end.exp2() as Float)
    const beforePoints = before(distances)
    const hidden = shares.dot(vec4(all).sub(beforePoints).max(0))
    const seen = all.sub(hidden).max(0).toConst() as Float
    const through = beforePoints.mul(opacity).oneMinus()
    const ofClouds = shares.dot(through).toConst() as Float
    const weight = opacity.mul(seen).max(1e-9).toConst() as Float
    const own = middle.mul(weight).add(ray.x.exp2().mul(ofClouds)).div(weight.add(ofClouds))
    return {
      radiance: radiance.mul(seen).div(weights.mul(nightGain)).toConst(),
      transmittance: opacity.mul(all).oneMinus().toConst(),
      before: ofClouds.div(shares.dot(vec4(1)).max(1e-6)).toConst(),
      distance: opacity.greaterThan(0).select(own, ray.x.exp2()).toConst() as Float
    }
  }

  /** Frees its textures. */
  dispose(): void {
    this.#target.dispose()
    this.#pass.dispose()
  }
}

/** log₂ of where a ray ends: nothing is seen behind opaque clouds. */
const endOf = (ray: Vec4, { x, y, z, w }: Vec4): Float =>
  ray.z
    .greaterThan(0)
    .select(ray.y, encodeDistance(x.max(y).max(z.max(w))))
    .toConst() as Float

function draw(
  scene: FallScene,
  precipitation: PrecipitationShafts,
  marched: MarchedTargets,
  cast: CastLight
): Outputs {
  const { frame } = scene.viewRays
  return outputs<[Vec4, Vec4]>(2, ([radiance, fallen]) => {
    const { marchedSize, block, jitter, size, fallBlock, fallPixel, nightGain, noiseShift } = frame
    const texel = uv().mul(marchedSize.div(fallBlock).ceil()).floor().toConst() as unknown as Vec2
    const own = texel.mul(fallBlock).add(fallPixel).min(marchedSize.sub(1)).toConst() as Vec2
    const here = own.add(0.5).div(marchedSize).toConst() as Vec2
    const pixel = own.mul(block).add(jitter).min(size.sub(1))
    const { direction } = viewRayAt(scene.viewRays, pixel.add(0.5).div(size).toConst() as Vec2)
    const { ray, litFall } = cast.rayAt(here)
    const distances = marched.distances.sample(here).level(0).toConst() as Vec4
    const noise = interleavedNoise(texel, noiseShift)
    const looked = { direction, jitter: noise, marched: ray, litFall }
    const seen = precipitation.among(scene, looked, distances)
    // Moonlit rain is a millionth of sunlit rain: too faint for half floats.
    radiance.assign(seen.radiance.mul(nightGain))
    const [middle, half, end] = [seen.distance, seen.half, seen.end].map(encodeDistance)
    fallen.assign(vec4(seen.opacity, middle, half, end))
  })
}

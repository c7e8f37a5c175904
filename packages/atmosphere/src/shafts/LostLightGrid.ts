import type { RenderTarget } from 'three'
import { Fn, If, float, log2, luminance, mix, step, texture, uv, vec2, vec3, vec4 } from 'three/tsl'
import type { Renderer, TextureNode } from 'three/webgpu'
import { FragmentPass, outputs, tableTarget } from '../tables/FragmentPass'
import { RADIANCE_SCALE } from '../tables/tableSizes'
import {
  loop,
  sampleLevel0,
  type Float,
  type Int,
  type Vec2,
  type Vec3,
  type Vec4
} from '../tsl-types'
import { number, vector2 } from '../uniforms'

/**
 * Octaves of depth by which pixels may differ and still share light, and by which they share none. Greater: halos at
 * silhouettes; smaller: the march's pixels show on slopes (*Towers in haze*).
 */
const SAME_DEPTH = 0.35
const OTHER_DEPTH = 0.8

/** Octaves from a pixel's depth to that of pixels around, which are at one depth. */
const NEAR_MEAN = 0.2

/** Depth that marks means of pixels at different depths: none is near it [octaves]. */
const APART_DEPTH = 6e4

/** Summand of the depth that marks means where light is steep; and limit that marked depths are below [octaves]. */
const STEEP_DEPTH = 64
const STEEP_LIMIT = 128

/** Least weight in the bilateral upsampling: that of pixels of another depth. */
const MIN_WEIGHT = 1e-3

/** Octaves by which the light of rays around may differ where it is mixed. Greater: dark rings about a hidden sun in fog of droplets. */
const MIXED_OCTAVES = 0.12

/** Greatest number that the targets keep: half floats hold a little more. */
const MAX_KEPT = 6e4

/** Scale of light in the targets. */
const LIGHT_SCALE = RADIANCE_SCALE / 8

/** Greatest light that is mixed [octaves]. */
const MAX_MIXED = Math.log2(MAX_KEPT) - 4

/** Least light that other light is compared with [1/sr]. */
const MIN_LIGHT = 1e-12

/** Part of the luminance below which a colour is not compared by itself: corona and dusk have colours near and below nought. */
const PALE = 0.2

/** Summand of places in the grid, whose rounding must not put whole ones into the cell before [pixels]. */
const ROUNDING = 1e-3

/** Parts of the light that are lost, by colours. */
function partsOf({ lost, lit }: LostLight): Vec3 {
  const all = luminance(lit).max(MIN_LIGHT).toConst()
  const isBright = vec3(step(all.mul(PALE), lit)).toConst()
  const [taken, whole] = [mix(vec3(luminance(lost)), lost, isBright), mix(vec3(all), lit, isBright)]
  return taken.div(whole).clamp(-MAX_KEPT, MAX_KEPT)
}

/** First or last in each direction, of four by their number. */
function cornerOf(index: Int): Vec2 {
  const row = float(index).div(2).floor().toConst()
  return vec2(float(index).sub(row.mul(2)), row)
}

/** Light of a ray. */
export interface LostLight {
  /** Light that it loses, linear sRGB of about that for unit irradiance. */
  readonly lost: Vec3
  /** Light of its air if nothing cast shadows, likewise. */
  readonly lit: Vec3
  /** Distance to what is seen [m]. */
  readonly distance: Float
}

/**
 * Light that a picture's pixels lose, marched for a grid of them, then taken from those around a pixel that are at its
 * depth: from nine, of which any four that touch have samples in all places of their steps.
 *
 * A first pass marches. A second one puts two things side by side in one texture: means of the four around each corner of the
 * grid, with their depth if they may be mixed, which most pixels read once; and parts of light. Other pixels lose the part of
 * their own light that those around lose of theirs: of nine where light is steep, as about the sun, and beside silhouettes of
 * four at their depth.
 */
export class LostLightGrid {
  /** Lost light with log₂ of the light that there is; its part of that with log₂ of the distance. */
  readonly #marched: RenderTarget
  readonly target: RenderTarget
  readonly #lost: TextureNode
  readonly #parts: TextureNode
  readonly #texels: TextureNode
  /** Size of the picture, and of the grid [pixels]. */
  readonly #size = vector2()
  readonly #gridSize = vector2()
  /** Texel of the target in texture coordinates. */
  readonly #texelSize = vector2()
  /** Factor and summand from places in the picture to those among means. */
  readonly #scale = vector2()
  readonly #offset = vector2()
  /** Reciprocal of the pixels of the picture from one that is marched to the next. */
  readonly #density = number(1)
  /** Longest mean free path in the air at the camera [m]. Shorter: dark pixels along the horizon (*Ridge at sunrise*). */
  readonly freePath = number(1)
  #passes: readonly FragmentPass[] = []
  #compiled = -1

  constructor() {
    this.#marched = tableTarget('Welkin.LightShafts', 1, 1, 2)
    this.target = tableTarget('Welkin.LightShafts', 1, 1)
    const [lost, parts] = this.#marched.textures
    this.#lost = texture(lost)
    this.#parts = texture(parts)
    this.#texels = texture(this.target.texture)
  }

  /** @param spacing - Pixels from one that is marched to the next. */
  resize(width: number, height: number, spacing: number): void {
    this.#size.value.set(Math.max(width, 1), Math.max(height, 1))
    this.#density.value = 1 / spacing
    const { x, y } = this.#gridSize.value.copy(this.#size.value).divideScalar(spacing).ceil()
    this.#marched.setSize(x, y)
    // A column of means more than there are corners, for pixels beyond the last of the grid.
    this.target.setSize(2 * x + 2, y + 1)
    const texelSize = this.#texelSize.value.set(1 / (2 * x + 2), 1 / (y + 1))
    this.#scale.value.copy(this.#size.value).divideScalar(spacing).multiply(texelSize)
    this.#offset.value.setScalar(1 - 0.5 / spacing).multiply(texelSize)
  }

  /**
   * Draws it.
   *
   * @param version - Grows when the shader of the march changes.
   * @param march - Light at a place in the picture, given the pixel of the grid. Called within a shader function.
   */
  render(renderer: Renderer, version: number, march: (at: Vec2, pixel: Vec2) => LostLight): void {
    if (this.#passes.length === 0 || this.#compiled !== version) {
      for (const pass of this.#passes) pass.dispose()
      const marched = outputs<[Vec4, Vec4]>(2, ([lostOut, partsOut]) => {
        const pixel = uv().mul(this.#gridSize).floor().toConst() as unknown as Vec2
        const at = pixel.div(this.#density).add(0.5).div(this.#size).toConst() as Vec2
        const found = march(at, pixel)
        const { lost, lit, distance } = found
        const scale = float(LIGHT_SCALE).div(this.#growth(distance)).toConst()
        const light = log2(luminance(lit).max(MIN_LIGHT).mul(scale))
        lostOut.assign(vec4(lost.mul(scale).clamp(-MAX_KEPT, MAX_KEPT), light))
        partsOut.assign(vec4(partsOf(found), log2(distance)))
      })
      this.#passes = [marched, Fn(() => this.#arrange())()].map(
        output => new FragmentPass('Welkin.LightShafts', output)
      )
      this.#compiled = version
    }
    this.#passes[0].render(renderer, this.#marched)
    this.#passes[1].render(renderer, this.target)
  }

  /** A texel of the target: the mean of the four pixels about a corner of the grid, or a pixel's part. */
  #arrange(): Vec4 {
    const size = this.#gridSize
    const texel = uv().div(this.#texelSize).floor().toConst() as unknown as Vec2
    const result = vec4(0).toVar()
    const read = (source: TextureNode, place: Vec2): Vec4 =>
      sampleLevel0(source, place.clamp(vec2(0.5), size.sub(0.5)).div(size)).toConst()
    If(texel.x.greaterThan(size.x.add(1.5)), () => {
      result.assign(read(this.#parts, texel.sub(vec2(size.x.add(1.5), -0.5)).toConst()))
    }).Else(() => {
      const least = vec2(APART_DEPTH).toVar()
      const most = vec2(-APART_DEPTH).toVar()
      loop('corner', 4, index => {
        const at = texel.add(cornerOf(index)).sub(0.5).toConst() as Vec2
        const [lost, parts] = [read(this.#lost, at), read(this.#parts, at)]
        result.addAssign(vec4(lost.rgb, parts.w).mul(0.25))
        const both = vec2(parts.w, lost.w).toConst()
        least.assign(least.min(both))
        most.assign(most.max(both))
      })
      const apart = most.sub(least).toConst()
      const isMixed = apart.y.lessThan(MIXED_OCTAVES).and(most.y.lessThan(MAX_MIXED))
      const depth = result.w.add(isMixed.select(0, STEEP_DEPTH))
      result.w.assign(apart.x.lessThan(SAME_DEPTH).select(depth, APART_DEPTH))
    })
    return result
  }

  /**
   * Growth of the light of air with distance, about as that of even air: light over it is about the same for pixels
   * whose distances differ a little, and is what they share.
   */
  #growth(distance: Float): Float {
    return distance.div(distance.add(this.freePath))
  }

  /**
   * Light that a pixel loses, as {@link LostLight} has it.
   *
   * @param at - Its place in the picture.
   * @param distanceBy - See {@link LostLight}; given log₂ of the distance of pixels around, or what is near to no distance.
   * @param lit - See {@link LostLight}; asked for in a branch.
   */
  read(at: Vec2, distanceBy: (around: Float) => Float, lit: (distance: Float) => Vec3): Vec3 {
    const middle = at.mul(this.#scale).add(this.#offset).toConst()
    const mean = sampleLevel0(this.#texels, middle).toConst()
    const distance = distanceBy(mean.w.sub(step(STEEP_DEPTH, mean.w).mul(STEEP_DEPTH)))
    const own = log2(distance).toConst() as Float
    const lost = mean.rgb.mul(this.#growth(distance).div(LIGHT_SCALE)).toVar() as Vec3
    If(own.sub(mean.w).abs().greaterThan(NEAR_MEAN), () => {
      const size = this.#gridSize
      const place = middle
        .div(this.#texelSize)
        .sub(1 - ROUNDING)
        .toConst() as Vec2
      const isSteep = mean.w.lessThan(STEEP_LIMIT)
      const first = isSteep.select(place, place.floor().add(0.5)).toConst() as Vec2
      const weights = float(0).toVar()
      lost.assign(vec3(0))
      loop('corner', 4, index => {
        const texel = first.add(cornerOf(index)).clamp(vec2(0.5), size.sub(0.5))
        const at = texel.add(vec2(size.x.add(2), 0)).mul(this.#texelSize)
        const other = sampleLevel0(this.#texels, at).toConst()
        const weight = other.w
          .sub(own)
          .abs()
          .sub(OTHER_DEPTH)
          .div(SAME_DEPTH - OTHER_DEPTH)
          .clamp(MIN_WEIGHT, 1)
          .toConst()
        lost.addAssign(other.rgb.mul(weight))
        weights.addAssign(weight)
      })
      lost.mulAssign(lit(distance).div(weights))
    })
    return lost
  }

  /** Frees its textures, which are made again where it is drawn. */
  dispose(): void {
    for (const owned of [this.#marched, this.target, ...this.#passes]) owned.dispose()
    this.#passes = []
  }
}

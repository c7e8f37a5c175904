import type { RenderTarget } from 'three'
import { Fn, If, exp2, float, int, log2, luminance, texture, uv, vec2, vec4 } from 'three/tsl'
import type { Renderer, TextureNode } from 'three/webgpu'
import { FragmentPass, outputs, tableTarget } from '../tables/FragmentPass'
import { RADIANCE_SCALE } from '../tables/tableSizes'
import {
  loadTexel,
  loop,
  sampleLevel0,
  type Float,
  type Int,
  type Vec2,
  type Vec3,
  type Vec4
} from '../tsl-types'
import { number, vector2 } from '../uniforms'
import { MAX_KEPT, MIN_LIGHT, partsOf, type LostLight } from './tsl/lostParts'

/**
 * Octaves of depth by which pixels may differ and still share light, and by which they share none. Greater: halos at
 * silhouettes; smaller: the march's pixels show on slopes (*Towers in haze*).
 */
const SAME_DEPTH = 0.35
const OTHER_DEPTH = 0.8

/** Octaves from a pixel's depth to that of pixels around, which are at one depth. */
const NEAR_MEAN = 0.2

/** Depth that marks means that are not to be used, and pixels without a thin thing: none is near it [octaves]. */
const APART_DEPTH = 6e4

/** Least weight in the bilateral upsampling: that of pixels of another depth. */
const MIN_WEIGHT = 1e-4

/** Weight of pixels around below which a pixel looks for its depth among those that were marched besides. */
const FEW = 0.02

/** Octaves by which the light of rays around may differ where it is mixed. Greater: dark rings about a hidden sun in fog of droplets. */
const MIXED_OCTAVES = 0.12

/** Scale of light in the targets. */
const LIGHT_SCALE = RADIANCE_SCALE / 8

/** Greatest light that is mixed [octaves]. */
const MAX_MIXED = Math.log2(MAX_KEPT) - 4

/** Place in a square of so many along its edge, from the first in each direction, by number. */
function placeIn(index: Int, edge: Float | number): Vec2 {
  const row = float(index).add(0.5).div(edge).floor().toConst()
  return vec2(float(index).sub(row.mul(edge)), row).toConst() as Vec2
}

/** What a pixel sees. */
export interface SeenPixel extends Pick<LostLight, 'octaves'> {
  /** Octaves by which its distance may be off, and those of pixels around are nearer to it; 0 if it is exact. */
  readonly tolerance: number
  /** See {@link LostLight}, of a pixel so many octaves farther; asked for in a branch. */
  lit(farther: Float): Vec3
}

/** How rays of a picture are marched; called within a shader function. */
export interface GridMarch {
  /** Light at a place in the picture, given the pixel of the grid. */
  lightAt(at: Vec2, pixel: Vec2): LostLight
  /** Depth there, as the renderer writes it. */
  depthAt(at: Vec2): Float
  /** log₂ of the distance to what is seen there; negative where that may be left out. */
  octavesAt(at: Vec2): Float
}

/**
 * Light that a picture's pixels lose, marched for a grid of them, then taken from those around a pixel that are at its
 * depth: from nine, of which any four that touch have samples in all places of their steps.
 *
 * A first pass marches. A second one puts three things side by side in one texture: means of the four around each corner of
 * the grid, with their depth if they may be mixed, which most pixels read once; parts of light; and, for every two pixels of
 * the grid, that of a thing about them that none around is at the depth of, such as a mast. Other pixels lose the part of their
 * own light that those around at their depth lose of theirs, with the same weights.
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
    const [columns, rows] = [2 * x + 2 + Math.ceil(x / 2), y + 1]
    this.target.setSize(columns, rows)
    const texelSize = this.#texelSize.value.set(1 / columns, 1 / rows)
    this.#scale.value.copy(this.#size.value).divideScalar(spacing).multiply(texelSize)
    this.#offset.value.setScalar(1 - 0.5 / spacing).multiply(texelSize)
  }

  /**
   * Draws it.
   *
   * @param version - Grows when the shader of the march changes.
   */
  render(renderer: Renderer, version: number, march: GridMarch): void {
    if (this.#passes.length === 0 || this.#compiled !== version) {
      for (const pass of this.#passes) pass.dispose()
      const marched = outputs<[Vec4, Vec4]>(2, ([lostOut, partsOut]) => {
        const pixel = this.#pixel
        const found = march.lightAt(this.#placeOf(pixel, vec2(0)), pixel)
        const { lost, lit, octaves } = found
        const scale = float(LIGHT_SCALE).div(this.#growth(octaves)).toConst()
        const light = log2(luminance(lit).max(MIN_LIGHT).mul(scale))
        lostOut.assign(vec4(lost.mul(scale).clamp(-MAX_KEPT, MAX_KEPT), light))
        partsOut.assign(vec4(partsOf(found), octaves))
      })
      this.#passes = [marched, Fn(() => this.#arrange(march))()].map(
        output => new FragmentPass('Welkin.LightShafts', output)
      )
      this.#compiled = version
    }
    for (const [i, target] of [this.#marched, this.target].entries()) {
      this.#passes[i].render(renderer, target)
    }
  }

  /** Pixel of the grid that is drawn. */
  get #pixel(): Vec2 {
    return uv().mul(this.#gridSize).floor().toConst() as unknown as Vec2
  }

  /** Place in the picture of a pixel of the grid, or some pixels of the picture aside. */
  #placeOf(pixel: Vec2, aside: Vec2): Vec2 {
    const at = pixel.div(this.#density).add(aside).add(0.5).div(this.#size)
    return at.clamp(vec2(0), vec2(1)).toConst() as Vec2
  }

  /** A texel of the grid, or the nearest of its edge: not filtered, which would mix in a little of those beside it. */
  #texelOf(source: TextureNode, pixel: Vec2): Vec4 {
    return loadTexel(source, pixel.clamp(vec2(0), this.#gridSize.sub(1))).toConst()
  }

  /**
   * Part of the light of the nearest or the farthest pixel about two of the grid, if the nine around are at no such depth.
   *
   * @param block - Column of two pixels of the grid, and row.
   */
  #marchThin({ lightAt, octavesAt, depthAt }: GridMarch, block: Vec2): Vec4 {
    const spacing = float(1).div(this.#density).round().toConst() as Float
    const first = block.mul(vec2(2, 1)).toConst() as Vec2
    const depths = vec2(2, -1).toVar() as Vec2
    const places = vec4(0).toVar() as Vec4
    loop('blockPixel', int(spacing.mul(spacing).mul(2)), index => {
      const aside = placeIn(index, spacing.mul(2)).sub(spacing.div(2).floor())
      const at = this.#placeOf(first, aside)
      const depth = depthAt(at).toConst()
      If(depth.lessThan(depths.x), () => {
        depths.x.assign(depth)
        places.xy.assign(at)
      })
      If(depth.greaterThan(depths.y), () => {
        depths.y.assign(depth)
        places.zw.assign(at)
      })
    })
    const farthest = float(OTHER_DEPTH).toVar()
    const place = vec2(-1).toVar() as Vec2
    for (const at of [places.xy, places.zw]) {
      const octaves = octavesAt(at).toConst()
      const pixel = at
        .mul(this.#size)
        .sub(0.4)
        .mul(this.#density)
        .add(0.5)
        .floor()
        .toConst() as Vec2
      const apart = float(APART_DEPTH).toVar()
      loop('around', 9, other => {
        const { w } = this.#texelOf(this.#parts, pixel.add(placeIn(other, 3)).sub(1))
        apart.assign(apart.min(octaves.sub(w).abs()))
      })
      If(apart.greaterThan(farthest).and(octaves.greaterThan(0)), () => {
        farthest.assign(apart)
        place.assign(at)
      })
    }
    const result = vec4(0, 0, 0, APART_DEPTH).toVar()
    If(place.x.greaterThanEqual(0), () => {
      const found = lightAt(place, block)
      result.assign(vec4(partsOf(found), found.octaves))
    })
    return result
  }

  /** A texel of the target: the mean of the four pixels about a corner of the grid, a pixel's part, or a thin thing's. */
  #arrange(march: GridMarch): Vec4 {
    const size = this.#gridSize
    const texel = uv().div(this.#texelSize).floor().toConst() as unknown as Vec2
    const result = vec4(0).toVar()
    const pixel = texel.sub(vec2(size.x.add(2), 0)).toConst() as Vec2
    If(pixel.x.greaterThan(size.x.sub(0.5)), () => {
      result.assign(this.#marchThin(march, pixel.sub(vec2(size.x, 0)).toConst() as Vec2))
    })
      .ElseIf(pixel.x.greaterThan(-0.5), () => {
        result.assign(this.#texelOf(this.#parts, pixel))
      })
      .Else(() => {
        const least = vec2(APART_DEPTH).toVar()
        const most = vec2(-APART_DEPTH).toVar()
        loop('corner', 4, index => {
          const around = texel.sub(1).add(placeIn(index, 2)).toConst() as Vec2
          const lost = this.#texelOf(this.#lost, around)
          const parts = this.#texelOf(this.#parts, around)
          result.addAssign(vec4(lost.rgb, parts.w).mul(0.25))
          const both = vec2(parts.w, lost.w).toConst()
          least.assign(least.min(both))
          most.assign(most.max(both))
        })
        const apart = most.sub(least).toConst()
        const isMixed = apart.y.lessThan(MIXED_OCTAVES).and(most.y.lessThan(MAX_MIXED))
        const isUsed = isMixed.and(apart.x.lessThan(SAME_DEPTH))
        result.w.assign(isUsed.select(result.w, APART_DEPTH))
      })
    return result
  }

  /**
   * Growth of the light of air with distance, about as that of even air: light over it is about the same for pixels
   * whose distances differ a little, and is what they share.
   */
  #growth(octaves: Float): Float {
    const distance = exp2(octaves).toConst()
    return distance.div(distance.add(this.freePath))
  }

  /**
   * Light that a pixel loses, as {@link LostLight} has it.
   *
   * @param at - Its place in the picture.
   */
  read(at: Vec2, { octaves: own, tolerance, lit }: SeenPixel): Vec3 {
    const middle = at.mul(this.#scale).add(this.#offset).toConst()
    const mean = sampleLevel0(this.#texels, middle).toConst()
    const nearer = (octaves: Float): Float => octaves.sub(own).clamp(-tolerance, tolerance) as Float
    const growth = this.#growth(own.add(nearer(mean.w)))
    const lost = mean.rgb.mul(growth.div(LIGHT_SCALE)).toVar() as Vec3
    If(
      own
        .sub(mean.w)
        .abs()
        .greaterThan(tolerance ?? NEAR_MEAN),
      () => {
        const size = this.#gridSize
        const place = middle.div(this.#texelSize).sub(0.5).toConst()
        const nearest = place.floor().toConst() as Vec2
        const towards = place.sub(nearest).sub(0.5).toConst()
        const sum = vec4(0).toVar()
        const farther = float(0).toVar()
        // Parts follow means, and those of thin things follow them.
        const add = (index: Int, weightOf: (aside: Vec2) => Float, least: number): void => {
          const aside = placeIn(index.mod(9) as Int, 3)
            .sub(1)
            .toConst() as Vec2
          const pixel = nearest.add(aside).clamp(vec2(0), size.sub(1)).toConst() as Vec2
          const isThin = float(index.div(9)).toConst() as Float
          const x = pixel.x.div(isThin.add(1)).floor().add(isThin.add(1).mul(size.x)).add(2)
          const other = loadTexel(this.#texels, vec2(x, pixel.y)).toConst()
          const isNear = other.w
            .sub(own)
            .abs()
            .sub(OTHER_DEPTH)
            .div(SAME_DEPTH - OTHER_DEPTH)
          const weight = isNear.clamp(least, 1).mul(weightOf(aside)).toConst()
          sum.addAssign(vec4(other.rgb.mul(weight), weight))
          farther.addAssign(nearer(other.w).mul(weight))
        }
        loop('neighbour', 9, index => {
          // As means have them between which one mixes.
          const weightOf = (aside: Vec2): Float => {
            const mixed = aside.mul(towards).add(0.5).div(aside.abs().add(1)).toConst()
            return mixed.x.mul(mixed.y)
          }
          add(index, weightOf, MIN_WEIGHT)
        })
        If(sum.w.lessThan(FEW), () => loop('other', 18, index => add(index, () => float(1), 0)))
        lost.assign(lit(farther.div(sum.w)).mul(sum.rgb.div(sum.w)))
      }
    )
    return lost
  }

  /** Frees its textures, which are made again where it is drawn. */
  dispose(): void {
    for (const owned of [this.#marched, this.target, ...this.#passes]) owned.dispose()
    this.#passes = []
  }
}

import type { RenderTarget } from 'three'
import { Fn, If, float, log2, luminance, texture, uv, vec2, vec4 } from 'three/tsl'
import type { Renderer, TextureNode } from 'three/webgpu'
import { FragmentPass, outputs, tableTarget } from '../tables/FragmentPass'
import { RADIANCE_SCALE } from '../tables/tableSizes'
import { sampleLevel0, type Bool, type Float, type Vec2, type Vec3, type Vec4 } from '../tsl-types'
import { number, vector2 } from '../uniforms'
import {
  APART_LIMIT,
  arrangeGrid,
  cellOf,
  LIT_DEPTH,
  MAX_KEPT,
  SAME_DEPTH,
  STEEP_LIMIT
} from './tsl/arrangeGrid'
import { ROUGH, SIMILAR } from './tsl/depthWeight'
import { lossFit } from './tsl/lossFit'
import { depthOf, rarityAt, shownOf } from './tsl/rarity'
import { FAR } from './tsl/without'

/** Octaves by which a pixel may be farther than those around, and take their light. */
const NEAR_MEAN = 0.2

/** Greatest part of a pixel's light that means may take before clouds; for more its own air is looked up. Greater: blue blotches before far clouds in snow (*snowShower* under a low sun). */
const MOST_OF_SHOWN = 0.9

/** Scale of light in the targets. */
const LIGHT_SCALE = RADIANCE_SCALE / 8

/** Least part of 1/τ² that is left without that of the ray without end: the sky is no farther. Smaller: half floats have noise there. */
const LEAST_LEFT = 0.01

/** Least extinction of the air, and the least part by which it thins out with each metre of height [1/m]. */
const LEAST_EXTINCTION = 1e-12
const LEAST_THINNING = 1e-9

/** Height over which the thinning of the air is found [m]. */
export const THIN_HEIGHT = 1000

/** Least light that other light is compared with [1/sr]. */
const MIN_LIGHT = 1e-12

/** Part of the luminance that a colour counts for at least: corona and dusk have colours near and below nought. */
const PALE = 0.2

/** Summand of places in the grid: rounding must not put whole ones into the cell before, and none is in the middle between pixels, where marks of two alone would count [pixels]. Less: lines a pixel wide where the spacing is even. */
const ASIDE = 0.02

/** Light of which parts are taken, by colours. */
const partedLight = (light: Vec3): Vec3 =>
  light.max(luminance(light).max(MIN_LIGHT).mul(PALE)).toConst()

/** Air of a ray, as far as a picture shows it. */
export interface SeenAir {
  /** 1/τ², where τ is the optical path in clear air that gives as much light as is seen: see {@link LostLightGrid.rarityTo} [–]. */
  readonly rarity: Float
  /** That of the ray without end. */
  readonly least: Float
  /** True where a foreground is seen; left out, nowhere. */
  readonly isSeen?: Bool
}

/** Light of a ray, linear sRGB of about that for unit irradiance. */
export interface LostLight extends SeenAir {
  /** 1/τ² up to what was drawn, whatever is before it. */
  readonly whole: Float
  /** Light that it loses. */
  readonly lost: Vec3
  /** Light of its air up to a distance [m], but not beyond what was drawn, if nothing cast shadows. */
  readonly lit: (distance: Float) => Vec3
}

/**
 * Light that a picture's pixels lose, marched for a grid of them, then taken from those around a pixel that are at its
 * depth: from nine, of which any four that touch have samples in all places of their steps.
 *
 * A first pass marches. A second one puts three things one below the other in one texture: means of those around each corner of the
 * grid, with their depth if they may be mixed, which most pixels read once; light that each loses of what it shows; and parts of its own
 * light. Other pixels take what four around lose of the light that they show, by a fit: see {@link lossFit}. Where light is steep, as about the
 * sun, and where next to nothing would be left, they look up their own light and lose that part of it. One that is farther
 * than all loses light up to their depth: they know nothing of the air beyond. So no pixel loses more than the light of its own air.
 *
 * In the shade of clouds next to nothing is left of the light: four would show as squares. So grids for pictures with clouds (`isBlended`) blend
 * each pixel's loss with those of the eight around in the second pass, weight four by their place too, and take means of sixteen: few samples show
 * as steps opposite the sun, where edges of shadows run along the rays (*Anticrepuscular rays*).
 *
 * A depth is log₂ of the optical path of clear air, which thins out with height, that has as much light as is seen: clouds hide some of it.
 * It is a measure, no more: a pixel finds 1/τ², which needs no root and no quotient.
 */
export class LostLightGrid {
  /** Lost light with log₂ of the depth; its part of the light up to there with log₂ of all light that there is. */
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
  /** Reciprocal of the extinction of the air at the camera, the least of all colours [m]. Less: dark pixels along the horizon (*Ridge at sunrise*). */
  readonly #freePath = number(1)
  /** Part by which the air thins out with each metre of height, and the least with each metre of a ray, over its extinction [–]. */
  readonly #thinning = number(1)
  readonly #grazing = number(1)
  #passes: readonly FragmentPass[] = []
  #compiled = -1

  /** @param isBlended - True if pixels that are marched share parts of light with those around at their depth, for pictures with clouds. */
  constructor(readonly isBlended: boolean) {
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
    // A row of means more than there are corners, for pixels beyond the last of the grid.
    this.target.setSize(x + 1, 3 * y + 2)
    const texelSize = this.#texelSize.value.set(1 / (x + 1), 1 / (3 * y + 2))
    this.#scale.value.copy(this.#size.value).divideScalar(spacing).multiply(texelSize)
    this.#offset.value.setScalar(1 + ASIDE - 0.5 / spacing).multiply(texelSize)
  }

  /**
   * Sets the air in which a depth stands for light: it thins out with height, fog does not.
   *
   * @param air - Extinction of the air at the camera, and `THIN_HEIGHT` above; of fog [1/m].
   * @param radius - Radius of the planet [m].
   */
  setAir(air: number, above: number, fog: number, radius: number): void {
    const whole = Math.max(air, LEAST_EXTINCTION) + fog
    const thinning = Math.max((air - above) / whole / THIN_HEIGHT, LEAST_THINNING)
    this.#freePath.value = 1 / whole
    this.#thinning.value = thinning / whole
    // Half of the air on a level ray, π r/(2k) under a root.
    this.#grazing.value = Math.sqrt((2 * thinning) / (Math.PI * radius)) / whole
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
        const { lost, lit, rarity, whole, least } = march(at, pixel)
        const depth = depthOf(rarity)
        const scale = float(LIGHT_SCALE).div(shownOf(rarity)).toConst()
        const all = luminance(lit(float(FAR))).max(MIN_LIGHT)
        const light = log2(all.mul(LIGHT_SCALE).div(shownOf(whole)))
        const seen = lit(this.#distanceAt(depth, least))
        lostOut.assign(vec4(lost.mul(scale).clamp(-MAX_KEPT, MAX_KEPT), depth))
        partsOut.assign(vec4(lost.div(partedLight(seen)).clamp(-MAX_KEPT, 1), light))
      })
      this.#passes = [
        marched,
        Fn(() =>
          arrangeGrid({
            lost: this.#lost,
            parts: this.#parts,
            size: this.#gridSize,
            texelSize: this.#texelSize,
            isBlended: this.isBlended
          })
        )()
      ].map(output => new FragmentPass('Welkin.LightShafts', output))
      this.#compiled = version
    }
    this.#passes[0].render(renderer, this.#marched)
    this.#passes[1].render(renderer, this.target)
  }

  /** 1/τ² of a ray without end; `cosView` is the cosine of its angle from the zenith. */
  leastRarity(cosView: Float): Float {
    const thinning = cosView.mul(this.#thinning).max(this.#grazing).toConst() as Float
    return thinning.mul(thinning).toConst()
  }

  /**
   * 1/τ² of air that thins out, up to a distance d: of τ = σ d/√(1 + (kd)²), much as σ (1 − exp(−kd))/k.
   *
   * @param nearness - 1/d, 0 for the sky [1/m].
   */
  rarityTo(nearness: Float, least: Float): Float {
    const rare = nearness.mul(this.#freePath).toConst() as Float
    return rare.mul(rare).add(least).toConst()
  }

  /** Distance up to which the air has a depth [m]. */
  #distanceAt(depth: Float, least: Float): Float {
    const rarity = rarityAt(depth)
    return rarity.sub(least).max(rarity.mul(LEAST_LEFT)).inverseSqrt().mul(this.#freePath)
  }

  /**
   * Light that a pixel loses, as {@link LostLight} has it.
   *
   * @param at - Its place in the picture.
   * @param seen - Its air.
   * @param lit - Light of its air up to a distance [m]. Called in a branch.
   * @param shown - Light of all that the pixel shows, over that of the grid times a gain: it loses no greater a part of it than its air does of its own.
   */
  read(
    at: Vec2,
    seen: SeenAir,
    lit: (distance: Float) => Vec3,
    shown?: { readonly light: Vec3; readonly gain: Float }
  ): Vec3 {
    const { rarity, least, isSeen } = seen
    const middle = at.mul(this.#scale).add(this.#offset).toConst() as Vec2
    // Light that is lost, and depth.
    const mean = sampleLevel0(this.#texels, middle).toConst()
    const own = depthOf(rarity)
    const known = shownOf(rarity)
    const lost = mean.rgb.mul(known.div(LIGHT_SCALE)).toVar() as Vec3
    const isOff = (depth: Float | number): Bool => mean.w.sub(depth).abs().greaterThan(NEAR_MEAN)
    const isUnlike = isOff(own).and(isOff(LIT_DEPTH))
    const excess = shown && lost.mul(shown.gain).sub(shown.light.mul(MOST_OF_SHOWN)).toConst()
    const isMuch = excess?.x.max(excess.y).max(excess.z).greaterThan(0)
    const isSteep = mean.w.lessThan(STEEP_LIMIT) as Bool
    // Its own light says most where light is steep, or next to nothing is left of it.
    const isOwn = (isMuch && isSeen ? isSteep.or(isSeen.and(isMuch)) : isSteep).toConst() as Bool
    If(isMuch && isSeen ? isUnlike.or(isSeen.and(isMuch)) : isUnlike, () => {
      const size = this.#gridSize
      const place = middle.div(this.#texelSize).sub(1).toConst() as Vec2
      const corner = place.floor().toConst() as Vec2
      // A grid that is not blended mixes places of samples here: as the sampler does at one depth, else by a quarter each.
      const first = (
        this.isBlended
          ? corner.add(0.5)
          : mean.w.abs().lessThan(APART_LIMIT).select(place, corner.add(0.5))
      ).toConst() as Vec2
      const start = isOwn.select(size.y, 0).add(size.y).add(2).toConst() as Float
      const similar = this.isBlended ? ROUGH : SIMILAR
      const { part, deepest } = lossFit({ depth: own, shown: known }, similar, index => {
        const step = cellOf(index, 2)
        const texel = first.add(step).clamp(vec2(0.5), size.sub(0.5))
        const at = texel.add(vec2(0, start)).mul(this.#texelSize)
        const shares = place.sub(corner).sub(step).abs().oneMinus().toConst() as Vec2
        const share = this.isBlended ? shares.x.mul(shares.y) : float(1)
        return { texel: sampleLevel0(this.#texels, at).toConst(), share }
      })
      const farther = own.sub(deepest).toConst() as Float
      const more = farther.greaterThan(SAME_DEPTH).select(
        farther
          .sub(2 * SAME_DEPTH)
          .min(0)
          .negate(),
        farther
      )
      const depth = deepest.add(more).toConst() as Float
      lost.assign(part.mul(shownOf(rarityAt(depth)).div(LIGHT_SCALE)))
      If(isOwn, () => {
        lost.assign(partedLight(lit(this.#distanceAt(depth, least))).mul(part))
        if (shown) lost.assign(lost.min(shown.light.div(shown.gain).mul(part.max(0))))
      })
    })
    return lost
  }

  /** Frees its textures, which are made again where it is drawn. */
  dispose(): void {
    for (const owned of [this.#marched, this.target, ...this.#passes]) owned.dispose()
    this.#passes = []
  }
}

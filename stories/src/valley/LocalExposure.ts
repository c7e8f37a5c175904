import { FragmentPass, tableTarget } from '@welkin/atmosphere'
import {
  exp2,
  float,
  Fn,
  int,
  Loop,
  log2,
  luminance,
  mix,
  screenCoordinate,
  texture,
  uniform,
  uv,
  vec2,
  vec4
} from 'three/tsl'
import type { Node, Renderer, TextureNode } from 'three/webgpu'

/** Cells of the picture whose luminance is found, and places of a cell that are looked at along each side. */
const CELLS = [96, 54] as const
const TAPS = 4

/** Tiles of the bilateral grid across and down, its levels, and the stops that these span. */
const TILES = [48, 27] as const
const LEVELS = 12
const STOPS = [-8, 4] as const

/** Cells on each side of a tile that have a part in it, of which every second is read, and the standard deviations of these parts [cells, stops]. */
const REACH = 9
const EVERY = 2
const BLUR = 6
const LIKE = 1.2

/** Pictures from one drawing of the grid to the next: its tiles are wide, and what is seen changes little over a few. */
const DRAWN_EVERY = 2

/** log2 of luminance that stays as it is: middle grey. */
const KEY = Math.log2(0.17)

/** Parts of the stops between a place and middle grey that are taken away where it is darker and where it is brighter, and the most [stops]. Clouds and snow stay white. */
const [DODGE, BURN] = [0.3, 0.15]
const MOST = 1.25

/** log2 of luminance that is told apart from black. */
const DARKEST = -14

type Float = Node<'float'>
type Vec2 = Node<'vec2'>
type Vec4 = Node<'vec4'>

const logOf = (color: Node): Float => log2(luminance(color).max(2 ** DARKEST))

/**
 * Local exposure, as of a print that is dodged and burned: land under a bright sky is shown brighter, the sky darker; what is within either
 * keeps its contrast, and edges have no halos.
 *
 * A bilateral grid (Chen, Paris & Durand 2007, "Real-time edge-aware image processing with the bilateral grid") of the picture
 * before holds the mean of log2 luminance about each place among what is about as bright.
 */
export class LocalExposure {
  readonly #picture: TextureNode
  readonly #cells = tableTarget('LocalExposureCells', ...CELLS)
  readonly #grid = tableTarget('LocalExposure', TILES[0] * (LEVELS - 1), TILES[1])
  readonly #passes: readonly [FragmentPass, FragmentPass]
  readonly #strength = uniform(1)
  /** Stops of the next picture's luminance scale over that of the grid. */
  readonly #shift = uniform(0)
  #kept = 1
  #pictures = 0

  /** @param picture - Exposed light of the last frame. */
  constructor(renderer: Renderer, picture: TextureNode) {
    this.#picture = texture(picture.value)
    // They are read in the first frame.
    renderer.initRenderTarget(this.#cells)
    renderer.initRenderTarget(this.#grid)
    this.#passes = [
      new FragmentPass('LocalExposureCells', this.#cellLight()),
      new FragmentPass('LocalExposure', this.#gridTexel())
    ]
  }

  /** Mean of log2 luminance in a cell. */
  #cellLight(): Vec4 {
    return Fn(() => {
      const sum = float(0).toVar()
      Loop(TAPS * TAPS, ({ i }) => {
        const offset = vec2(int(i).mod(TAPS), int(i).div(TAPS)).add(0.5).div(TAPS).sub(0.5)
        const place = uv().add(offset.div(vec2(...CELLS)))
        sum.addAssign(logOf((this.#picture.sample(place).level(float(0)) as unknown as Vec4).rgb))
      })
      return vec4(sum.div(TAPS * TAPS), 0, 0, 1)
    })()
  }

  /**
   * Sum of log2 luminance of the cells about a tile, by how near and how much like the level they are, and of these weights; then
   * those of the next level, so that a pixel between both reads one texel.
   */
  #gridTexel(): Vec4 {
    return Fn(() => {
      const texel = screenCoordinate.xy.floor().toConst()
      const level = texel.x.div(TILES[0]).floor().toConst()
      const [darkest, brightest] = STOPS
      const lights = vec2(level, level.add(1))
        .add(0.5)
        .mul((brightest - darkest) / LEVELS)
        .add(darkest)
        .toConst()
      const tile = vec2(texel.x.sub(level.mul(TILES[0])), texel.y)
        .add(0.5)
        .div(vec2(...TILES))
        .toConst()
      const sum = vec4(0).toVar()
      const side = 2 * Math.floor(REACH / EVERY) + 1
      Loop(side * side, ({ i }) => {
        const offset = vec2(int(i).mod(side), int(i).div(side))
          .sub((side - 1) / 2)
          .mul(EVERY)
          .toConst()
        const place = tile.add(offset.div(vec2(...CELLS)))
        const log = (texture(this.#cells.texture, place).level(float(0)) as unknown as Vec4).r
        const unlike = vec2(log).sub(lights).div(LIKE).toConst()
        const apart = offset.dot(offset).div(BLUR * BLUR)
        const weights = exp2(unlike.mul(unlike).add(apart).mul(-0.72)) as unknown as Vec2
        sum.addAssign(vec4(log, 1, log, 1).mul(weights.xxyy))
      })
      return sum
    })()
  }

  /** Strength, in [0, 1]: 0 leaves pictures as they are. */
  set strength(value: number) {
    this.#strength.value = value
  }

  /** Takes the luminance scale of the next picture. */
  scaleTo(luminanceScale: number): void {
    this.#shift.value = Math.log2(luminanceScale / this.#kept)
  }

  /** Keeps the picture that was just drawn in a luminance scale, one of two, unless the next one is shown as it is. */
  update(renderer: Renderer, luminanceScale: number): void {
    if (this.#strength.value === 0 || this.#pictures++ % DRAWN_EVERY !== 0) return
    this.#kept = luminanceScale
    this.#passes[0].render(renderer, this.#cells)
    this.#passes[1].render(renderer, this.#grid)
  }

  /** A picture, dodged and burned. */
  shown(picture: Node): Node<'vec4'> {
    const color = vec4(picture as Vec4).toConst()
    const log = logOf(color.rgb).sub(this.#shift).toConst()
    const [darkest, brightest] = STOPS
    const level = log
      .sub(darkest)
      .mul(LEVELS / (brightest - darkest))
      .sub(0.5)
      .clamp(0, LEVELS - 1)
      .toConst()
    const lower = level
      .floor()
      .min(LEVELS - 2)
      .toConst()
    // Between the middles of outer tiles, levels beside each other are not mixed.
    const half = vec2(...TILES)
      .mul(2)
      .reciprocal()
    const place = uv().clamp(half, half.oneMinus()).toConst()
    const tile = vec2(place.x.add(lower).div(LEVELS - 1), place.y)
    const sums = texture(this.#grid.texture, tile).level(float(0)) as unknown as Vec4
    const both = sums.toConst()
    const found = mix(both.xy, both.zw, level.sub(lower)).toConst()
    const base = found.x.div(found.y.max(1e-4)).add(this.#shift)
    const under = float(KEY).sub(base).toConst()
    const part = under.greaterThan(0).select(DODGE, BURN)
    const stops = under.mul(part).mul(this.#strength).clamp(-MOST, MOST)
    const gain = found.y.greaterThan(1e-4).select(exp2(stops), 1)
    return vec4(color.rgb.mul(gain as unknown as Float), color.a)
  }

  /** Frees what it draws with. */
  dispose(): void {
    for (const pass of this.#passes) pass.dispose()
    this.#cells.dispose()
    this.#grid.dispose()
  }
}

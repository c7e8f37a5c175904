import { FragmentPass, tableTarget } from '@welkin/atmosphere'
import { Vector4, type RenderTarget, type Vector3 } from 'three'
import { Fn, If, float, int, mix, smoothstep, texture, uv, vec2, vec3, vec4 } from 'three/tsl'
import type { Renderer } from 'three/webgpu'
import { select } from '../select'
import type { CloudField } from '../density/CloudField'
import { forLayers, heightIn, isWithin, layerAt } from '../density/tsl/layer'
import type { CloudSample } from '../density/tsl/sample'
import { sampleLayer } from '../density/tsl/sampleLayer'
import { backgroundAt } from '../density/tsl/sampler'
import {
  loop,
  vec4Array,
  type Float,
  type LevelTexture,
  type Variable,
  type Vec2,
  type Vec3,
  type Vec4
} from '../tsl-types'
import { number, vector3 } from '../uniforms'
import { STEM_POINTS, type PlacedChannel, type StormColumn } from './channel'
import { meanInverseSquare } from './tsl/lineLight'

/** Cells along the ground and upwards; slices lie in rows of tiles. */
const SIZE = 96
const SLICES = 48
const TILES = [8, 6] as const
/**
 * Half width of the box, and the distance from its middle at which cells are four times as wide as there [m]. Smaller: clouds farther away
 * are lit by one factor (*Storm at night*); greater: coarse cells.
 */
const HALF_WIDTH = 30_000
const FINE = 8000
const SHRINK = 1 + FINE / HALF_WIDTH
/** Length of ways out of the storm [m]. */
export const REACH = 8000
/** Samples of a path through the box: fewer miss clouds between. */
const SAMPLES = 32
/** Samples of a path out of it. */
const SAMPLES_OUT = 24
/** Directions in which light leaves, over which paths are averaged. */
export const DIRECTIONS = 24
/** Scaled depth up to which light is taken to be even [–]. Smaller: bright rims (*Storm at night*). */
export const OPEN = 4
/** Greatest gain of thin sides. */
const THINNEST = 3
/** Scaled extinction below which there is no cloud [1/m]. */
const CLEAR = 3e-4

/**
 * Depth in cloud from which its light comes: a few scaled mean free paths; the line's light is as soft [m]. Smaller: a white core where a
 * channel leaves its cloud (*Storm at night*).
 */
export const CLOUD_SOFTNESS = 250

/** Clear ways between parts of one cloud, and between clouds [m]. Smaller: bright islands with outlines on towers (*Storm at night*). */
const GAP = [150, 850] as const

/** Depth passed on a way out of a cloud, as the light that comes out, over `OPEN`. */
const passed = (depth: Float): Float => float(OPEN).div(depth.add(OPEN))

const boxTarget = (name: string): RenderTarget =>
  tableTarget(`Welkin.Lightning${name}`, SIZE * TILES[0], SIZE * TILES[1])

const nodeOf = (target: RenderTarget): LevelTexture<Vec2> =>
  texture(target.texture) as unknown as LevelTexture<Vec2>

/**
 * Clouds around a flash, as a box of coarse cells, drawn once for each flash: how much of its light comes out on each side, and of that how much passes
 * the clouds around.
 *
 * Light diffuses out where the path is short. With τ the depth from the channel to a place, ⟨⟩ the mean over directions, a place gets
 * (1/τ) / ⟨1/τ⟩ of what an even ball would send there: 1 for a channel in the middle of a ball. All light gets out. Of what has got out, each further cloud
 * of depth τ passes 1/(1 + τ/`OPEN`), as a slab does.
 */
export class StormDensity {
  readonly #target = boxTarget('Box')
  readonly #openTarget = tableTarget('Welkin.LightningWaysOut', 1, 1)
  readonly #lightTarget = boxTarget('Light')
  readonly #box = nodeOf(this.#target)
  readonly #open = nodeOf(this.#openTarget)
  readonly #light = nodeOf(this.#lightTarget)
  readonly #passes: readonly (readonly [FragmentPass, RenderTarget])[]
  /** Place of the flash on the ground, from the camera, and east, north and up there, in the mapped space. */
  readonly #place = vector3()
  readonly #axes = [vector3(), vector3(), vector3()] as const
  readonly #base = number()
  readonly #thickness = number(1)
  /** Start of light, in the flash's frame [m], and from the camera, in the mapped space [m]; points of the stem, in the flash's frame [m]. */
  readonly #source = vector3()
  readonly source = vector3()
  readonly #stem: readonly Vector4[] = Array.from({ length: STEM_POINTS }, () => new Vector4())
  readonly #stemArray = vec4Array(this.#stem as Vector4[])

  constructor(readonly field: CloudField) {
    this.#passes = [
      [new FragmentPass('Welkin.LightningDensity', this.#draw()), this.#target],
      [new FragmentPass('Welkin.LightningWaysOut', this.#waysOut()), this.#openTarget],
      [new FragmentPass('Welkin.LightningLight', this.#lit()), this.#lightTarget]
    ]
  }

  /** Place of a texel of the box, in the flash's frame [m]. To be called inside of a shader function. */
  #cell(): Vec3 {
    const at = (uv() as unknown as Vec2).mul(vec2(...TILES)).toConst() as Vec2
    const tile = at.floor().toConst() as Vec2
    const flat = at
      .sub(tile)
      .sub(0.5)
      .mul(2 / SHRINK)
      .toConst() as Vec2
    const slice = tile.y.mul(TILES[0]).add(tile.x).add(0.5).div(SLICES)
    const up = this.#base.add(this.#thickness.mul(slice))
    return vec3(flat.mul(FINE).div(flat.abs().oneMinus()), up).toConst()
  }

  /** Scaled extinction of a cell [1/km]. */
  #draw(): Vec4 {
    const { field } = this
    return Fn(() => {
      const cell = this.#cell()
      const [east, north, zenith] = this.#axes
      const offset = this.#place
        .add(east.mul(cell.x))
        .add(north.mul(cell.y))
        .add(zenith.mul(cell.z))
        .toConst() as Vec3
      const distance = offset.length().toConst() as Float
      const sample: CloudSample = { offset, ...field.view.localCoordinates(offset), distance }
      const sum = float(0).toVar() as Variable<Float>
      forLayers(field, index => {
        const layer = layerAt(field, index)
        If(isWithin(layer, heightIn(layer, sample.altitude)), () => {
          const background = backgroundAt(field, layer, sample)
          const { extinction } = sampleLayer(field, layer, background, sample, { detail: false })
          sum.addAssign(extinction)
        })
      })
      return vec4(sum.mul(field.depthScale).mul(1000), 0, 0, 1)
    })()
  }

  /** Harmonic mean of the depths out of the storm, and `OPEN`. */
  #waysOut(): Vec4 {
    return Fn(() => {
      const sum = float(0).toVar() as Variable<Float>
      loop('wayOut', DIRECTIONS, index => {
        // Even on a sphere: a Fibonacci lattice.
        const z = float(index)
          .add(0.5)
          .mul(2 / DIRECTIONS)
          .sub(1)
          .toConst() as Float
        const angle = float(index).mul(Math.PI * (3 - Math.sqrt(5)))
        const aside = z.mul(z).oneMinus().sqrt()
        const way = vec3(aside.mul(angle.cos()), aside.mul(angle.sin()), z).mul(REACH).toConst()
        const depth = float(0).toVar() as Variable<Float>
        loop('wayStep', SAMPLES_OUT, step => {
          // Finest near the source: most of the depth is there.
          const even = float(step).add(0.5).div(SAMPLES_OUT).toConst() as Float
          const place = this.#source.add(way.mul(even.mul(even))).toConst() as Vec3
          depth.addAssign(this.#densityAt(place).mul(even))
        })
        sum.addAssign(passed(depth.mul((2 * REACH) / SAMPLES_OUT)))
      })
      return vec4(
        float(DIRECTIONS * OPEN)
          .div(sum)
          .min(6e4),
        0,
        0,
        1
      )
    })()
  }

  /**
   * Light that comes out at a cell, over what an even ball about the light's start would send there, and from 0 to 1 how much its cloud is another than the
   * flash's: clefts within a cloud part nothing.
   */
  #lit(): Vec4 {
    return Fn(() => {
      const cell = this.#cell()
      const way = cell.sub(this.#source).toConst() as Vec3
      const length = way
        .length()
        .mul(6 / SAMPLES)
        .toConst() as Float
      const open = this.#open.sample(vec2(0.5)).level(0).x.div(OPEN).toConst()
      /** Depth of all clouds and of the present one; light that got out of those before it; way in clear air. */
      const whole = float(0).toVar() as Variable<Float>
      const depth = float(0).toVar() as Variable<Float>
      const out = open.toVar() as Variable<Float>
      const gap = float(0).toVar() as Variable<Float>
      loop('lightStep', SAMPLES, index => {
        // Finest at both ends: what is before the place makes its form.
        const even = float(index).add(0.5).div(SAMPLES).toConst() as Float
        const part = even.mul(even).mul(even.mul(-2).add(3))
        const density = this.#densityAt(this.#source.add(way.mul(part)).toConst()).toConst()
        const step = even.mul(even.oneMinus()).mul(length).toConst()
        If(density.lessThan(CLEAR), () => {
          out.assign(out.mul(passed(depth)).min(THINNEST))
          depth.assign(0)
          gap.addAssign(step)
        }).Else(() => {
          depth.addAssign(density.mul(step))
          whole.addAssign(density.mul(step))
        })
      })
      const other = smoothstep(...GAP, gap).toConst() as Float
      const light = mix(open.mul(passed(whole)), out.mul(passed(depth)), other)
      const line = float(0).toVar() as Variable<Float>
      loop('flashLine', STEM_POINTS - 1, index => {
        const [from, to] = [index, index.add(int(1))].map(
          i => this.#stemArray.element(i).xyz.sub(cell).toConst() as Vec3
        )
        line.addAssign(meanInverseSquare(from, to, float(CLOUD_SOFTNESS)))
      })
      const square = way.dot(way).add(CLOUD_SOFTNESS ** 2)
      const gain = line.mul(square).div(STEM_POINTS - 1)
      return vec4(light.min(THINNEST).mul(gain), other, 0, 1)
    })()
  }

  /** Value of a box at a place in the flash's frame; out of it, that at its edge. */
  #read(box: LevelTexture<Vec2>, place: Vec3): Vec3 {
    const { x, y } = place
    const warped = vec2(x.div(x.abs().add(FINE)), y.div(y.abs().add(FINE)))
    const flat = warped
      .mul(SHRINK / 2)
      .add(0.5)
      .clamp(0.5 / SIZE, 1 - 0.5 / SIZE)
      .toConst() as Vec2
    const slice = this.#heightOf(place)
      .mul(SLICES)
      .sub(0.5)
      .clamp(0, SLICES - 1)
      .toConst() as Float
    const first = slice.floor().toConst() as Float
    const [below, above] = [first, first.add(1).min(SLICES - 1)].map(index => {
      const row = index.div(TILES[0]).floor().toConst() as Float
      const tile = vec2(index.sub(row.mul(TILES[0])), row)
      const at = tile.add(flat).div(vec2(...TILES))
      return box.sample(at.toConst()).level(0).xyz
    })
    return mix(below, above, slice.sub(first)).toConst()
  }

  /** Height in the storm, from 0 at its base to 1 at its top. */
  #heightOf(place: Vec3): Float {
    return place.z.sub(this.#base).div(this.#thickness).toConst()
  }

  /** Scaled extinction at a place in the flash's frame [1/m]. */
  #densityAt(place: Vec3): Float {
    const up = this.#heightOf(place)
    return select(up.clamp(0, 1).equal(up), this.#read(this.#box, place).x.div(1000), 0)
  }

  /**
   * Light that comes out at a place, over what an even ball about the light's start would send there, and from 0 to 1 how much it comes out of another cloud. To be called inside of
   * a shader function.
   *
   * @param offset - Displacement from the camera, in the mapped space [m].
   */
  lightOut(offset: Vec3): Vec2 {
    const shifted = offset.sub(this.#place).toConst() as Vec3
    const [east, north, up] = this.#axes.map(axis => shifted.dot(axis))
    const place = vec3(east, north, up).toConst() as Vec3
    return this.#read(this.#light, place).xy
  }

  /** Follows the camera. @param offset - The flash's place from the camera, in the mapped space [m]. */
  update(offset: Vector3): void {
    this.#place.value.copy(offset)
    const source = this.source.value.copy(offset)
    this.#source.value.toArray().forEach((value, i) => {
      source.addScaledVector(this.#axes[i].value, value)
    })
  }

  /** Draws the box around a flash, before any light of it; the field is up to date. */
  bake(
    renderer: Renderer,
    offset: Vector3,
    { axes, stem }: PlacedChannel,
    { base, top }: StormColumn
  ): void {
    axes.forEach((axis, i) => this.#axes[i].value.copy(axis))
    stem.forEach((point, i) => this.#stem[i].set(...point, 0))
    this.#base.value = base
    this.#thickness.value = top - base
    // Where most of it is in the cloud.
    const inside = stem.filter(([, , z]) => z > base)
    const middle = inside[Math.floor(inside.length / 2)] ?? stem[0]
    this.#source.value.set(...(middle as [number, number, number]))
    this.update(offset)
    for (const [pass, target] of this.#passes) pass.render(renderer, target)
  }

  /** Frees its textures. */
  dispose(): void {
    for (const owned of this.#passes.flat()) owned.dispose()
  }
}

import { FragmentPass, tableTarget } from '@welkin/atmosphere'
import type { Vector3 } from 'three'
import { Fn, float, int, mix, texture, uniform, uv, vec2, vec3, vec4 } from 'three/tsl'
import type { Renderer } from 'three/webgpu'
import type { CloudField } from '../density/CloudField'
import { layerAt } from '../density/tsl/layer'
import { sampleLayer } from '../density/tsl/sampleLayer'
import { subpointOffset, type CloudSample } from '../density/tsl/sample'
import { weatherBackground } from '../density/tsl/weatherBackground'
import {
  loop,
  type Float,
  type Int,
  type LevelTexture,
  type Variable,
  type Vec2,
  type Vec3,
  type Vec4
} from '../tsl-types'
import { number, vector3 } from '../uniforms'
import type { PlacedChannel, StormColumn } from './channel'

/** Cells along the ground and upwards; slices lie in rows of tiles. */
const SIZE = 64
const SLICES = 32
const TILES = [8, 4] as const
/** Half width of the box [m]. */
export const REACH = 8000
/** Samples of a path through it: fewer miss clouds between. */
const SAMPLES = 8
/** Samples of a path out of it, which is longer. */
const SAMPLES_OUT = 24
/** Directions in which light leaves, over which paths are averaged. */
export const DIRECTIONS = 24
/** Scaled depth up to which light is taken to be even [–]. Smaller: bright rims (*Storm at night*). */
export const OPEN = 4
/** Greatest gain of thin sides. */
const THINNEST = 3

/**
 * Density of a storm around a flash, as a box of coarse cells, drawn once for each flash: how much of its light comes out on each side.
 *
 * Light diffuses out where the path is short. With τ the depth from the channel to a place, ⟨⟩ the mean over directions, a place gets
 * (1/τ) / ⟨1/τ⟩ of what an even ball would send there: 1 for a channel in the middle of a ball, less behind other clouds. All light gets out.
 */
export class StormDensity {
  readonly #target = tableTarget('Welkin.LightningDensity', SIZE * TILES[0], SIZE * TILES[1])
  readonly #box = texture(this.#target.texture) as unknown as LevelTexture<Vec2>
  readonly #openTarget = tableTarget('Welkin.LightningWaysOut', 1, 1)
  readonly #open = texture(this.#openTarget.texture) as unknown as LevelTexture<Vec2>
  readonly #pass: FragmentPass
  readonly #openPass: FragmentPass
  readonly #layer = uniform(0, 'int')
  /** Place of the flash on the ground, from the camera, and east, north and up there, in the mapped space. */
  readonly #place = vector3()
  readonly #axes = [vector3(), vector3(), vector3()] as const
  readonly #base = number()
  readonly #thickness = number(1)
  /** Start of light, in the flash's frame [m]. */
  readonly #source = vector3()

  constructor(readonly field: CloudField) {
    this.#pass = new FragmentPass('Welkin.LightningDensity', this.#draw())
    this.#openPass = new FragmentPass(
      'Welkin.LightningWaysOut',
      Fn(() => {
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
          const way = vec3(aside.mul(angle.cos()), aside.mul(angle.sin()), z)
          const end = this.#source.add(way.mul(REACH)).toConst() as Vec3
          // Finest near the source: most of the depth is there.
          const depth = this.#depthTo(end, SAMPLES_OUT, even => {
            return { part: even.mul(even), slope: even.mul(2) }
          })
          sum.addAssign(depth.add(OPEN).reciprocal())
        })
        return vec4(float(DIRECTIONS).div(sum).min(6e4), 0, 0, 1)
      })()
    )
  }

  /** Scaled extinction of a cell [1/km]. */
  #draw(): Vec4 {
    const { field } = this
    return Fn(() => {
      const at = (uv() as unknown as Vec2).mul(vec2(...TILES)).toConst() as Vec2
      const tile = at.floor().toConst() as Vec2
      const flat = at
        .sub(tile)
        .sub(0.5)
        .mul(2 * REACH)
        .toConst() as Vec2
      const slice = tile.y.mul(TILES[0]).add(tile.x).add(0.5).div(SLICES)
      const up = this.#base.add(this.#thickness.mul(slice))
      const [east, north, zenith] = this.#axes
      const offset = this.#place
        .add(east.mul(flat.x))
        .add(north.mul(flat.y))
        .add(zenith.mul(up))
        .toConst() as Vec3
      const distance = offset.length().toConst() as Float
      const sample: CloudSample = { offset, ...field.view.localCoordinates(offset), distance }
      const layer = layerAt(field, int(this.#layer as unknown as Int).toConst())
      const footprint = distance.mul(field.pixelAngle).toConst() as Float
      const subpoint = subpointOffset(field, sample).toConst()
      const background = weatherBackground(field, layer, subpoint, sample, footprint)
      const { extinction } = sampleLayer(field, layer, background, sample, { detail: false })
      return vec4(extinction.mul(field.depthScale).mul(1000), 0, 0, 1)
    })()
  }

  /** Scaled extinction at a place in the flash's frame [1/m]. */
  #densityAt(place: Vec3): Float {
    const flat = place.xy
      .div(2 * REACH)
      .add(0.5)
      .toConst() as Vec2
    const up = place.z.sub(this.#base).div(this.#thickness).toConst() as Float
    const isInside = up.clamp(0, 1).equal(up).and(flat.clamp(0, 1).equal(flat).all())
    const slice = up
      .mul(SLICES)
      .sub(0.5)
      .clamp(0, SLICES - 1)
      .toConst() as Float
    const first = slice.floor().toConst() as Float
    const inTile = flat.clamp(0.5 / SIZE, 1 - 0.5 / SIZE).toConst() as Vec2
    const read = (index: Float): Float => {
      const row = index.div(TILES[0]).floor().toConst() as Float
      const tile = vec2(index.sub(row.mul(TILES[0])), row)
      return this.#box
        .sample(
          tile
            .add(inTile)
            .div(vec2(...TILES))
            .toConst()
        )
        .level(0).x
    }
    const both = mix(read(first), read(first.add(1).min(SLICES - 1)), slice.sub(first))
    return isInside.select(both.div(1000), 0)
  }

  /**
   * Scaled depth from the source to a place in the flash's frame.
   *
   * @param partAt - Part of the path at an evenly spaced number in [0, 1), and its slope: where samples are dense.
   */
  #depthTo(
    place: Vec3,
    samples: number,
    partAt: (even: Float) => { part: Float; slope: Float | number }
  ): Float {
    const way = place.sub(this.#source).toConst() as Vec3
    const sum = float(0).toVar() as Variable<Float>
    loop('wayStep', samples, index => {
      const { part, slope } = partAt(float(index).add(0.5).div(samples).toConst())
      sum.addAssign(this.#densityAt(this.#source.add(way.mul(part)).toConst()).mul(slope))
    })
    return sum.mul(way.length()).div(samples)
  }

  /**
   * Light that comes out at a place, over what an even ball would send there. To be called inside of a shader function.
   *
   * @param offset - Displacement from the camera, in the mapped space [m].
   */
  lightOut(offset: Vec3): Float {
    const shifted = offset.sub(this.#place).toConst() as Vec3
    const [east, north, up] = this.#axes.map(axis => shifted.dot(axis))
    // Finest near the place: what is before it there makes its form.
    const depth = this.#depthTo(vec3(east, north, up).toConst(), SAMPLES, even => {
      const left = even.oneMinus().toConst() as Float
      return { part: left.mul(left).oneMinus(), slope: left.mul(2) }
    })
    const open = this.#open.sample(vec2(0.5)).level(0).x
    return open.div(depth.add(OPEN)).min(THINNEST)
  }

  /** Follows the camera. @param offset - The flash's place from the camera, in the mapped space [m]. */
  update(offset: Vector3): void {
    this.#place.value.copy(offset)
  }

  /** Draws the box around a flash, before any light of it; the field is up to date. */
  bake(
    renderer: Renderer,
    offset: Vector3,
    { axes, stem }: PlacedChannel,
    { base, top }: StormColumn,
    layer: number
  ): void {
    this.update(offset)
    axes.forEach((axis, i) => this.#axes[i].value.copy(axis))
    this.#base.value = base
    this.#thickness.value = top - base
    this.#layer.value = layer
    // Where most of it is in the cloud.
    const inside = stem.filter(([, , z]) => z > base)
    const middle = inside[Math.floor(inside.length / 2)] ?? stem[0]
    this.#source.value.set(...(middle as [number, number, number]))
    this.#pass.render(renderer, this.#target)
    this.#openPass.render(renderer, this.#openTarget)
  }

  /** Frees its textures. */
  dispose(): void {
    for (const owned of [this.#target, this.#openTarget, this.#pass, this.#openPass])
      owned.dispose()
  }
}

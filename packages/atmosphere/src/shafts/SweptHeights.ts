import { Matrix3, Vector3, type Matrix4, type RenderTarget, type Texture } from 'three'
import { Fn, texture, uv, vec4 } from 'three/tsl'
import type { Renderer } from 'three/webgpu'
import { FragmentPass, tableTarget } from '../tables/FragmentPass'
import { sampleLevel0, type Float, type Vec2, type Vec4 } from '../tsl-types'
import { number, vector2 } from '../uniforms'
import { isInField } from './tsl/isInField'

/** Part of a texel by which the light may turn, over the field's width, before the map is drawn anew. */
const TURN = 0.25

/** Greatest height that the map keeps, up or down; half floats hold a little more [m]. */
const MAX_HEIGHT = 6e4

/** Least height over which shadows end [m]. */
const LEAST_BLUR = 0.1

const _toLight = new Vector3()
const _linear = new Matrix3()

/** A field of heights that casts shadows. */
export interface SweptField {
  readonly heightAt: (at: Vec2) => Float
  readonly size: number
  readonly version: number
}

/** Height up to which there is shadow, at each place of a field in one light: heights, swept along the light. */
export class SweptHeights {
  readonly #field: SweptField
  readonly #targets: readonly [RenderTarget, RenderTarget]
  /** Step of a sweep [parts of the field], and how far light falls over it [m]. */
  readonly #step = vector2()
  readonly #fall = number()
  /** Height over which shadows end, below what casts them: light's fall over a texel [m]. */
  blur = 1
  #passes: readonly FragmentPass[] = []
  /** Direction to the light, and version of the heights, that the map is of. */
  readonly #drawn = new Vector3(NaN, NaN, NaN)
  #version = -1

  constructor(field: SweptField) {
    this.#field = field
    const target = (): RenderTarget =>
      tableTarget('Welkin.HeightFieldShadow', field.size, field.size)
    this.#targets = [target(), target()]
  }

  /** Heights up to which there is shadow, in red, and of the ground, in green [m]. */
  get texture(): Texture {
    return this.#targets[0].texture
  }

  /**
   * Draws the map, if light or heights have changed.
   *
   * @param toLight - Direction to the light, in world space.
   * @param toField - World space to places and heights of the field.
   */
  update(renderer: Renderer, toLight: Vector3, toField: Matrix4): void {
    const { size, version } = this.#field
    const along = _toLight.copy(toLight).applyMatrix3(_linear.setFromMatrix4(toField))
    // In texels to the sides, and metres up for each.
    along.divideScalar(Math.max(Math.abs(along.x), Math.abs(along.y), 1e-9))
    along.z /= size
    const turned = Math.hypot(along.x - this.#drawn.x, along.y - this.#drawn.y) * size
    const sunk = Math.abs(along.z - this.#drawn.z) / Math.max(Math.abs(along.z), 1e-3)
    this.blur = Math.max(Math.abs(along.z), LEAST_BLUR)
    if (version === this.#version && turned < TURN && sunk < 1 / size) return
    this.#drawn.copy(along)
    this.#version = version
    this.#draw(renderer, along)
  }

  /** Sweeps heights along the light, twice as far each time. */
  #draw(renderer: Renderer, toLight: Vector3): void {
    const { size, heightAt } = this.#field
    if (this.#passes.length === 0) {
      const first = Fn(() => {
        const height = heightAt(uv()).clamp(-MAX_HEIGHT, MAX_HEIGHT)
        return vec4(height, height, 0, 0)
      })()
      this.#passes = [first, this.#sweep(0), this.#sweep(1)].map(
        output => new FragmentPass('Welkin.HeightFieldShadow', output)
      )
    }
    // As many sweeps as end in the first target.
    const sweeps = 2 * Math.ceil(Math.log2(size) / 2)
    this.#passes[0].render(renderer, this.#targets[0])
    for (let i = 0; i < sweeps; i++) {
      const far = Math.min(2 ** i, size)
      const [x, y] = [Math.round(toLight.x * far), Math.round(toLight.y * far)]
      const along = (x * toLight.x + y * toLight.y) / (toLight.x ** 2 + toLight.y ** 2)
      this.#step.value.set(x, y).divideScalar(size)
      this.#fall.value = Math.min(Math.max(along * toLight.z, -MAX_HEIGHT), MAX_HEIGHT)
      this.#passes[1 + (i % 2)].render(renderer, this.#targets[1 - (i % 2)])
    }
  }

  /** The greater of shadows here and a step towards the light, which falls on its way. */
  #sweep(from: 0 | 1): Vec4 {
    return Fn((): Vec4 => {
      const source = texture(this.#targets[from].texture)
      const at = uv() as unknown as Vec2
      const next = at.add(this.#step).toConst() as Vec2
      const cast = (sampleLevel0(source, next).r as Float).sub(this.#fall)
      const { r: here, g: ground } = sampleLevel0(source, at).toConst() as unknown as Vec4
      const higher = isInField(next).greaterThan(0.5).select(here.max(cast), here)
      return vec4(higher.clamp(-MAX_HEIGHT, MAX_HEIGHT), ground, 0, 0)
    })()
  }

  dispose(): void {
    for (const owned of [...this.#passes, ...this.#targets]) owned.dispose()
    this.#passes = []
    this.#version = -1
  }
}

import { Matrix3, Matrix4, Vector3, type RenderTarget, type Texture } from 'three'
import { Fn, renderGroup, step, texture, uniform, uv, vec2, vec4 } from 'three/tsl'
import type { Renderer, TextureNode } from 'three/webgpu'
import { checkMatrix, checkOptions, fail } from '@welkin/geo'
import { FragmentPass, tableTarget } from '../tables/FragmentPass'
import { sampleLevel0, type Float, type Mat4, type Vec2, type Vec4 } from '../tsl-types'
import { number, vector2 } from '../uniforms'
import type { AtmosphereView } from '../view/AtmosphereView'
import type { AirOccluder, AirPoint, AirShadow, ShadowedShafts } from './AirOccluder'

/** Options of {@link HeightFieldShadow}. */
export interface HeightFieldShadowOptions {
  /** Texels along each edge of its shadow map, a power of two from 2 to 4096; by default 512. */
  size?: number
}

/** Part of a texel by which the light may turn, over the field's width, before the map is drawn anew. */
const TURN = 0.25

/** Greatest height that the map keeps, up or down; half floats hold a little more [m]. */
const MOST = 6e4

const _direction = new Vector3()
const _axes = new Matrix4()
const _linear = new Matrix3()
const _toField = new Matrix4()

/** Heights of an area: a texture whose red channel is height, or a shader function of the place in [0, 1]² [m]. */
export type HeightField = Texture | ((at: Vec2) => Float)

/** Shadow of a height field in one light: at each place the height up to which air is dark, swept along the light. */
class SweptShadow implements AirShadow {
  readonly #field: HeightFieldShadow
  readonly #shafts: ShadowedShafts
  readonly #targets: readonly [RenderTarget, RenderTarget]
  readonly #shadow: TextureNode
  /** Displacements from the camera in the mapped space [m] to places and heights of the field. */
  readonly #toField = uniform(new Matrix4()).setGroup(renderGroup)
  /** Step of a sweep [parts of the field], and how far light falls over it [m]. */
  readonly #step = vector2()
  readonly #fall = number()
  /** Height over which shadows end, below what casts them: light's fall over a texel [m]. */
  readonly #blur = number(1)
  #passes: readonly FragmentPass[] = []
  /** Direction to the light, and version of the heights, that the map is of. */
  readonly #drawn = new Vector3(NaN, NaN, NaN)
  #version = -1

  constructor(field: HeightFieldShadow, shafts: ShadowedShafts) {
    this.#field = field
    this.#shafts = shafts
    const target = (): RenderTarget =>
      tableTarget('Welkin.HeightFieldShadow', field.size, field.size)
    this.#targets = [target(), target()]
    this.#shadow = texture(this.#targets[0].texture)
  }

  update(view: AtmosphereView, renderer: Renderer): void {
    const { matrix, size, version } = this.#field
    view.atmosphere.space.displacement(_axes.identity(), _linear)
    _axes.setFromMatrix3(_linear.invert()).copyPosition(view.camera.matrixWorld)
    _toField.copy(matrix).invert()
    this.#toField.value.multiplyMatrices(_toField, _axes)
    const { source } = this.#shafts
    const toLight = source.direction(_direction, view.camera.position)
    toLight.normalize().applyMatrix3(_linear.setFromMatrix4(_toField))
    // In texels to the sides, and metres up for each.
    const longest = Math.max(Math.abs(toLight.x), Math.abs(toLight.y), 1e-9)
    toLight.divideScalar(longest)
    toLight.z /= size
    const turned = Math.hypot(toLight.x - this.#drawn.x, toLight.y - this.#drawn.y) * size
    const sunk = Math.abs(toLight.z - this.#drawn.z) / Math.max(Math.abs(toLight.z), 1e-3)
    this.#blur.value = Math.max(Math.abs(toLight.z), 0.1)
    if (version === this.#version && turned < TURN && sunk < 1 / size) return
    this.#drawn.copy(toLight)
    this.#version = version
    this.#draw(renderer, toLight)
  }

  /** Sweeps heights along the light, twice as far each time. */
  #draw(renderer: Renderer, toLight: Vector3): void {
    const { size, heightAt } = this.#field
    if (this.#passes.length === 0) {
      const first = Fn(() => vec4(heightAt(uv() as unknown as Vec2).clamp(-MOST, MOST), 0, 0, 0))()
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
      this.#fall.value = Math.min(Math.max(along * toLight.z, -MOST), MOST)
      this.#passes[1 + (i % 2)].render(renderer, this.#targets[1 - (i % 2)])
    }
  }

  /** The greater of shadows here and a step towards the light, which falls on its way. */
  #sweep(from: 0 | 1): Vec4 {
    return Fn((): Vec4 => {
      const source = texture(this.#targets[from].texture)
      const at = uv() as unknown as Vec2
      const next = at.add(this.#step).toConst() as Vec2
      const inside = step(0, next).mul(step(next, vec2(1))) as unknown as Vec2
      const cast = (sampleLevel0(source, next).r as Float).sub(this.#fall)
      const isIn = inside.x.mul(inside.y).greaterThan(0.5)
      const here = (sampleLevel0(source, at).r as Float).toConst()
      return vec4(isIn.select(here.max(cast), here).clamp(-MOST, MOST), 0, 0, 0)
    })()
  }

  transmittance(): (place: AirPoint) => Float {
    return ({ offset }) => {
      const place = (this.#toField as unknown as Mat4).mul(vec4(offset, 1)).xyz.toConst()
      const inside = step(0, place.xy).mul(step(place.xy, vec2(1))) as unknown as Vec2
      const dark = sampleLevel0(this.#shadow, place.xy).r as Float
      const lit = place.z.sub(dark).div(this.#blur).add(1).clamp()
      return inside.x.mul(inside.y).lessThan(0.5).select(1, lit).toConst()
    }
  }

  dispose(): void {
    for (const owned of [...this.#passes, ...this.#targets]) owned.dispose()
    this.#passes = []
    this.#version = -1
  }
}

/**
 * Shadows that hills cast into the air, however far they reach: for light shafts beyond the light's shadow maps.
 *
 * ```ts
 * const matrix = new Matrix4().makeBasis(east, north, up).setPosition(corner)
 * shafts.add(heightFieldShadow(heights, matrix)) // before the first render, or set pipeline.needsUpdate
 * ```
 *
 * Heights are swept along the light's azimuth into a map of the height up to which air is dark, in about log₂ of its size
 * passes. It is drawn anew when the light has turned by a quarter of a texel. The field is flat: take the planet's
 * curvature off the heights of a large one. Two textures of 2 MB at the default size, of which air reads one; heights are
 * kept within ±60 km.
 */
export class HeightFieldShadow implements AirOccluder {
  /** Heights as a shader function of the place in the field [m]. */
  readonly heightAt: (at: Vec2) => Float
  /**
   * Places in the field, in [0, 1]², and heights [m] to world space [world units]: its columns are the field's two edges,
   * up by a metre, and the corner at (0, 0). Shared: count `version` up when it changes.
   */
  readonly matrix: Matrix4
  /** Texels along each edge of its shadow map. */
  readonly size: number
  /** Count it up when heights or matrix have changed. */
  version = 0

  /** @throws If an argument is of the wrong kind, or an option unknown or out of range. */
  constructor(heights: HeightField, matrix: Matrix4, options: HeightFieldShadowOptions = {}) {
    const { size = 512 } = checkOptions('HeightFieldShadow', options, 'size')
    const isTexture = (heights as Texture | undefined)?.isTexture
    if (!isTexture && typeof heights !== 'function')
      fail('HeightFieldShadow', 'heights must be a Texture or a function', heights)
    checkMatrix('HeightFieldShadow', 'matrix', matrix)
    if (!(size >= 2 && size <= 4096 && Number.isInteger(Math.log2(size))))
      fail('HeightFieldShadow', 'size must be a power of two in [2, 4096]', size)
    const red = isTexture ? texture(heights as Texture) : null
    this.heightAt = red === null ? (heights as (at: Vec2) => Float) : at => sampleLevel0(red, at).r
    this.matrix = matrix
    this.size = size
  }

  /** Called by `LightShafts.add`. */
  castInto(shafts: ShadowedShafts): AirShadow {
    return new SweptShadow(this, shafts)
  }
}

/** Shadows that hills cast into the air: see {@link HeightFieldShadow}. */
export const heightFieldShadow = (
  heights: HeightField,
  matrix: Matrix4,
  options?: HeightFieldShadowOptions
): HeightFieldShadow => new HeightFieldShadow(heights, matrix, options)

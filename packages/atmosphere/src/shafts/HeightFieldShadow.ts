import { Matrix3, Matrix4, Vector3, type Camera, type Texture } from 'three'
import { renderGroup, texture, uniform, vec4 } from 'three/tsl'
import type { Renderer } from 'three/webgpu'
import { checkMatrix, checkOptions, fail } from '@welkin/geo'
import { sampleLevel0, type Float, type Mat4, type Vec2 } from '../tsl-types'
import type { AtmosphereView } from '../view/AtmosphereView'
import type { AirOccluder, AirPoint, AirShadow, ShadowedShafts } from './AirOccluder'
import type { ParallelLight } from './shadowMaps'
import { SweptHeights } from './SweptHeights'
import { SweptShadow, type SweptHills } from './SweptShadow'

/** Options of {@link HeightFieldShadow}. */
export interface HeightFieldShadowOptions {
  /** Texels along each edge of its shadow map, a power of two from 2 to 4096; by default 512. */
  size?: number
}

const _direction = new Vector3()
const _position = new Vector3()
const _axes = new Matrix4()
const _linear = new Matrix3()

/**
 * Heights of an area [m]: a texture's red channel, or a shader function of the place in [0, 1]². A texture's places are its
 * texture coordinates: (0, 0) is the first texel of a `DataTexture`, and the lower left corner of a picture with
 * `flipY`. Its numbers are metres, so it has half floats or floats, and no colour space; for others give
 * a function, such as `at => texture(picture, at).r.mul(3000)`.
 */
export type HeightField = Texture | ((at: Vec2) => Float)

/** Sine of the least angle between the axes of a field that can be told from none. */
const LEAST_ANGLE = 1e-9

/** True if axes of a matrix have no length, or lie in one plane. */
function isSingular(matrix: Matrix4): boolean {
  const { elements } = matrix
  const lengths = [0, 4, 8].map(i => Math.hypot(elements[i], elements[i + 1], elements[i + 2]))
  const box = lengths.reduce((product, length) => product * length)
  return !(Math.abs(matrix.determinant()) > LEAST_ANGLE * box)
}

/** Shadow of a height field in the air, in one light. */
class HillsInAir implements AirShadow {
  readonly #shafts: ShadowedShafts
  readonly #swept: SweptShadow
  /** Displacements from the camera in the mapped space [m] to places and heights of the field. */
  readonly #toField = uniform(new Matrix4()).setGroup(renderGroup)

  constructor(field: HeightFieldShadow, shafts: ShadowedShafts) {
    this.#shafts = shafts
    this.#swept = new SweptShadow(field, shafts.light)
  }

  update(view: AtmosphereView, renderer: Renderer): void {
    view.atmosphere.space.displacement(_axes.identity(), _linear)
    _axes.setFromMatrix3(_linear.invert()).copyPosition(view.camera.matrixWorld)
    const { camera } = view
    _position.setFromMatrixPosition(camera.matrixWorld)
    const toLight = this.#shafts.source.direction(_direction, _position)
    const toField = this.#swept.update(renderer, camera, toLight)
    this.#toField.value.multiplyMatrices(toField, _axes)
  }

  transmittance(): (place: AirPoint) => Float {
    return ({ offset }) =>
      this.#swept.transmittance(
        (this.#toField as unknown as Mat4).mul(vec4(offset, 1)).xyz.toConst()
      )
  }

  free(): void {
    this.#swept.dispose()
  }

  dispose(): void {
    this.free()
  }
}

/**
 * Shadows that hills cast into the air, however far they reach: for light shafts beyond the light's shadow maps. On
 * surfaces they fall by {@link terrainShadow}.
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
export class HeightFieldShadow implements AirOccluder, SweptHills {
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
  /** Maps by the source of light, or the light that has none, and how many use them. */
  readonly #swept = new Map<object, { map: SweptHeights; users: number }>()

  /** @throws If an argument is of the wrong kind, the matrix has no inverse, or an option is unknown or out of range. */
  constructor(heights: HeightField, matrix: Matrix4, options: HeightFieldShadowOptions = {}) {
    const { size = 512 } = checkOptions('HeightFieldShadow', options, 'size')
    const isTexture = (heights as Texture | undefined)?.isTexture
    if (!isTexture && typeof heights !== 'function')
      fail('HeightFieldShadow', 'heights must be a Texture or a function', heights)
    checkMatrix('HeightFieldShadow', 'matrix', matrix)
    if (isSingular(matrix)) fail('HeightFieldShadow', 'matrix must have an inverse', matrix)
    if (!(size >= 2 && size <= 4096 && Number.isInteger(Math.log2(size))))
      fail('HeightFieldShadow', 'size must be a power of two in [2, 4096]', size)
    const red = isTexture ? texture(heights as Texture) : null
    this.heightAt = red === null ? (heights as (at: Vec2) => Float) : at => sampleLevel0(red, at).r
    this.matrix = matrix
    this.size = size
  }

  /** Called by `LightShafts.add`. */
  castInto(shafts: ShadowedShafts): AirShadow {
    return new HillsInAir(this, shafts)
  }

  /** Field whose shadows a camera sees, called before they are drawn: this one, but for a field that follows cameras. */
  fieldOf(_camera: Camera, _frame?: number): HeightFieldShadow {
    return this
  }

  /** Map in a light, shared by all that read it: `release` it after use. */
  acquire(light: ParallelLight): SweptHeights {
    const key = light.source ?? light
    const entry = this.#swept.get(key) ?? { map: new SweptHeights(this), users: 0 }
    entry.users++
    this.#swept.set(key, entry)
    return entry.map
  }

  /** Frees a light's map when none reads it. */
  release(light: ParallelLight): void {
    const key = light.source ?? light
    const entry = this.#swept.get(key)
    if (entry === undefined || --entry.users > 0) return
    entry.map.dispose()
    this.#swept.delete(key)
  }
}

/** Shadows that hills cast into the air: see {@link HeightFieldShadow}. */
export const heightFieldShadow = (
  heights: HeightField,
  matrix: Matrix4,
  options?: HeightFieldShadowOptions
): HeightFieldShadow => new HeightFieldShadow(heights, matrix, options)

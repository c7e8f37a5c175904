import {
  DataTexture,
  DataUtils,
  HalfFloatType,
  LinearFilter,
  Matrix4,
  RedFormat,
  Vector3
} from 'three'
import { checkPositive, fail } from '@welkin/geo'
import type { Atmosphere } from '../Atmosphere'
import { checkRange, withDefaults } from '../check'
import { checkAtmosphere } from '../view/ViewNodes'
import { HeightFieldShadow } from './HeightFieldShadow'

/** Options of {@link GroundShadow}. */
export interface GroundShadowOptions {
  /** Edge of the square about the camera whose ground casts shadows, > 0, default 100,000 [m]. */
  width?: number
  /** Heights along its edge, in [16, 1024], default 256. */
  texels?: number
  /** Texels along each edge of its shadow map, a power of two from 2 to 4096; by default 512. */
  size?: number
}

/** Ground of a planet, as a `Terrain` of `@welkin/terrain`. */
export interface ShadowingGround {
  /** Height of the ground below a point of the world, above the ellipsoid [m]. */
  heightBelow(position: Vector3): number
}

const DEFAULTS: Required<GroundShadowOptions> = { width: 1e5, texels: 256, size: 512 }

/** Way from the middle of the square, in edges of it, after which another is begun. */
const AWAY = 1 / 8

/** Rows of heights found in a frame while another square is made. */
const ROWS = 2

const _subpoint = new Vector3()
const _place = new Vector3()
const _world = new Vector3()
const _toWorld = new Matrix4()

/**
 * Shadows of mountains, however far they reach, on the ground and in the air: a {@link HeightFieldShadow} of the ground about
 * the camera, which it follows by itself.
 *
 * ```ts
 * const mountains = groundShadow(atmosphere, terrain)
 * shafts.add(mountains)
 * Object.assign(sun.shadow, { shadowNode: terrainShadow(mountains, sun, shadow(sun)) })
 * ```
 *
 * The planet's curvature is in it. As the camera moves by an eighth of the width, the ground is asked for the heights of
 * another square, two rows a frame, and the square changes once it is whole. The first is made at once: a quarter of a
 * second with mountains from noise.
 */
export class GroundShadow extends HeightFieldShadow {
  /** Shared, not owned. */
  readonly atmosphere: Atmosphere
  /** Shared, not owned. */
  readonly ground: ShadowingGround
  /** Edge of the square [m]. */
  readonly width: number
  /** Heights along its edge. */
  readonly texels: number
  /** Heights over the plane through the square's middle, row by row from south to north, half floats [m]. */
  readonly heights: DataTexture
  /** Heights of the next square, how many are found, and its axes in ECEF: east, north, up. */
  #next: Uint16Array
  #found = 0
  readonly #axes = new Matrix4()
  /** The square in use, from its texture coordinates and heights to ECEF [m]. */
  readonly #square = new Matrix4()
  /** Its middle, on the ellipsoid, ECEF [m]. */
  readonly #middle = new Vector3(NaN, NaN, NaN)

  /** @throws If an argument is missing or out of its range, or the atmosphere's world is flat. */
  constructor(atmosphere: Atmosphere, ground: ShadowingGround, options: GroundShadowOptions = {}) {
    const where = 'GroundShadow'
    checkAtmosphere(where, atmosphere)
    if (atmosphere.flat) fail(where, 'atmosphere must not be flat', atmosphere)
    if (typeof ground?.heightBelow !== 'function')
      fail(where, 'ground must have heightBelow()', ground)
    const { width, texels, size } = withDefaults(where, DEFAULTS, options)
    checkPositive(where, 'width', width)
    checkRange(where, 'texels', texels, 16, 1024)
    if (!Number.isInteger(texels)) fail(where, 'texels must be a whole number', texels)
    const heights = new DataTexture(
      new Uint16Array(texels ** 2),
      texels,
      texels,
      RedFormat,
      HalfFloatType
    )
    heights.name = 'Welkin.GroundShadow'
    heights.minFilter = heights.magFilter = LinearFilter
    super(heights, new Matrix4(), { size })
    this.atmosphere = atmosphere
    this.ground = ground
    this.width = width
    this.texels = texels
    this.heights = heights
    this.#next = new Uint16Array(texels ** 2)
  }

  /**
   * Moves on with a viewer, and with the world's origin; called for each camera that draws its shadows.
   *
   * @param position - World [units].
   */
  override follow(position: Vector3): void {
    this.#find(position)
    // The origin of the world, its axes and units may have changed since.
    if (!Number.isNaN(this.#middle.x)) {
      this.matrix.copy(this.atmosphere.worldToECEF).invert().multiply(this.#square)
    }
  }

  /** Finds some heights of the next square, once the camera is far from the middle of the one in use. */
  #find(position: Vector3): void {
    const { atmosphere, width, texels } = this
    if (this.#found === 0) {
      _subpoint.copy(position).applyMatrix4(atmosphere.worldToECEF)
      atmosphere.ellipsoid.footPoint(_subpoint, _subpoint)
      if (_subpoint.distanceTo(this.#middle) < AWAY * width) return
      atmosphere.ellipsoid.eastNorthUpFrame(_subpoint, this.#axes)
    }
    const isFirst = Number.isNaN(this.#middle.x)
    const end = Math.min(isFirst ? Infinity : this.#found + ROWS * texels, texels ** 2)
    for (; this.#found < end; this.#found++) {
      // Half floats: some devices blend no others.
      this.#next[this.#found] = DataUtils.toHalfFloat(this.#heightAt(this.#found))
    }
    if (end === texels ** 2) this.#change()
  }

  /** Asks for the heights anew, at once, after the ground or the world has changed. */
  refresh(): void {
    this.#middle.set(NaN, NaN, NaN)
    this.#found = 0
  }

  /** Frees the heights. */
  dispose(): void {
    this.heights.dispose()
  }

  /** Height of the next square's ground over the plane through its middle [m]. */
  #heightAt(texel: number): number {
    const { atmosphere, width, texels } = this
    const east = (texel % texels) + 0.5
    const north = Math.floor(texel / texels) + 0.5
    _place.set(east / texels - 0.5, north / texels - 0.5, 0).multiplyScalar(width)
    _place.applyMatrix4(this.#axes)
    _world.copy(_place).applyMatrix4(_toWorld.copy(atmosphere.worldToECEF).invert())
    return this.ground.heightBelow(_world) - atmosphere.ellipsoid.heightAt(_place)
  }

  /** Puts the next square in the place of the one in use. */
  #change(): void {
    const { width } = this
    const { image } = this.heights
    const used = image.data as Uint16Array
    image.data = this.#next
    this.#next = used
    this.#found = 0
    this.heights.needsUpdate = true
    this.#middle.setFromMatrixPosition(this.#axes)
    this.#square.makeScale(width, width, 1).setPosition(-width / 2, -width / 2, 0)
    this.#square.premultiply(this.#axes)
    this.version++
  }
}

/** Shadows of mountains on the ground and in the air: see {@link GroundShadow}. */
export const groundShadow = (
  atmosphere: Atmosphere,
  ground: ShadowingGround,
  options?: GroundShadowOptions
): GroundShadow => new GroundShadow(atmosphere, ground, options)

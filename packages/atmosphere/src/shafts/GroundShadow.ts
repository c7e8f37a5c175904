import {
  DataTexture,
  DataUtils,
  HalfFloatType,
  LinearFilter,
  MathUtils,
  Matrix4,
  RedFormat,
  Vector3
} from 'three'
import type { Camera } from 'three'
import { checkPositive, fail, type Ellipsoid } from '@welkin/geo'
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
  /** Counts up whenever heights have changed, such as those that were loaded; left out, they never do. */
  readonly version?: number
}

const DEFAULTS: Required<GroundShadowOptions> = { width: 1e5, texels: 256, size: 512 }

/**
 * Distance of a camera from the middle of its square after which another square is begun; and from the camera whose square it
 * is up to which other cameras share it: in edges of the square.
 */
const MAX_DISTANCE = 1 / 8

/** Rows of heights found in a frame while another square is made. */
const ROWS_PER_FRAME = 2

/** Distance of a camera from the middle of its square beyond which it has leapt [edges of the square]. */
const LEAP = 3 / 8

/** Heights along the edge of the square that is made first after a leap, and how many are found in a frame: in four frames. */
const COARSE = 64
const COARSE_PER_FRAME = COARSE ** 2 / 4

/** Squares of cameras far apart that there may be at once. */
const MAX_SQUARES = 4

/** Uses by other cameras after which the camera of a square is taken to be gone. */
const MAX_IDLE = 64

const _position = new Vector3()
const _subpoint = new Vector3()
const _place = new Vector3()
const _world = new Vector3()
const _toWorld = new Matrix4()
const _scaling = new Matrix4()

/** Plane of a flat world, in place of an ellipsoid: y is height. */
const PLANE: Pick<Ellipsoid, 'footPoint' | 'heightAt' | 'eastNorthUpFrame'> = {
  footPoint: ({ x, z }, target) => (target ?? new Vector3()).set(x, 0, z),
  heightAt: ({ y }) => y,
  // East is x, and north −z.
  eastNorthUpFrame: ({ x, z }, target) =>
    (target ?? new Matrix4()).set(1, 0, 0, x, 0, 0, 1, 0, 0, -1, 0, z, 0, 0, 0, 1)
}

/**
 * Spreads a square of heights over more texels, linearly between the middles of its cells and on to its edges.
 *
 * @param target - Half floats.
 */
function spread(heights: Float32Array, target: Uint16Array): void {
  const [side, texels] = [heights, target].map(({ length }) => Math.sqrt(length))
  const cellOf = (texel: number): { first: number; part: number } => {
    const place = ((texel + 0.5) / texels) * side - 0.5
    const first = MathUtils.clamp(Math.floor(place), 0, side - 2)
    return { first, part: place - first }
  }
  const columns = Array.from({ length: texels }, (_, i) => cellOf(i))
  for (let row = 0; row < texels; row++) {
    const { first: south, part: north } = cellOf(row)
    columns.forEach(({ first, part }, column) => {
      const at = south * side + first
      const [lower, upper] = [at, at + side].map(i =>
        MathUtils.lerp(heights[i], heights[i + 1], part)
      )
      const height = MathUtils.lerp(lower, upper, north)
      target[row * texels + column] = DataUtils.toHalfFloat(height)
    })
  }
}

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
 * The planet's curvature is in it. As the camera moves by an eighth of the width, or the ground's `version` grows, the ground is
 * asked for the heights of another square, two rows a frame, and the square changes once it is whole. After a leap there is a
 * coarse one in four frames. The first is made at once: a quarter of a second with mountains from noise. Cameras an eighth of the width apart have squares of their own, of which there are
 * up to four; others take the place of the one that was not used for longest.
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
  /** Heights of the next square while that is a coarse one. */
  #coarse: Float32Array | null = null
  /** Frame of the last search, and version of the ground that the next square is of. */
  #frame: number | undefined
  #groundVersion: number | undefined
  /** The square in use, from its texture coordinates and heights to ECEF [m]. */
  readonly #square = new Matrix4()
  /** Its middle, on the ellipsoid, ECEF [m]. */
  readonly #middle = new Vector3(NaN, NaN, NaN)
  /** The camera that it follows, its subpoint, ECEF [m], and the number of its last use. */
  #camera: Camera | null = null
  readonly #subpoint = new Vector3(NaN, NaN, NaN)
  #used = 0
  /** Squares of other cameras, and the number of uses of all. */
  readonly #others: GroundShadow[] = []
  #uses = 0

  /** @throws If an argument is missing or out of its range. */
  constructor(atmosphere: Atmosphere, ground: ShadowingGround, options: GroundShadowOptions = {}) {
    const where = 'GroundShadow'
    checkAtmosphere(where, atmosphere)
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
   * Square of a camera, which follows it: its own, or that of another camera nearby.
   *
   * @param frame - Number of the frame, in which heights are sought once; left out, at each call.
   */
  override fieldOf(camera: Camera, frame?: number): GroundShadow {
    _position.setFromMatrixPosition(camera.matrixWorld)
    this.#uses++
    const square = this.#squareOf(camera)
    if (square.#camera !== camera && this.#isIdle(square)) square.#camera = camera
    if (square.#camera === camera) {
      square.#used = this.#uses
      square.follow(_position, frame)
    } else square.#place()
    return square
  }

  /** Square of a camera at `_position`; of those whose camera is gone one that is near comes first. */
  #squareOf(camera: Camera): GroundShadow {
    const squares = [this, ...this.#others]
    const own = squares.find(square => square.#camera === camera)
    if (own !== undefined) return own
    const { atmosphere, ground, width, texels, size } = this
    _subpoint.copy(_position).applyMatrix4(this.#toFigure)
    this.#figure.footPoint(_subpoint, _subpoint)
    const isNear = (square: GroundShadow): boolean =>
      square.#subpoint.distanceTo(_subpoint) < MAX_DISTANCE * width
    squares.sort((a, b) => a.#used - b.#used)
    const found = squares.find(isNear) ?? squares.find(square => this.#isIdle(square))
    if (found !== undefined) return found
    if (squares.length === MAX_SQUARES) {
      squares[0].#camera = null
      return squares[0]
    }
    const square = new GroundShadow(atmosphere, ground, { width, texels, size })
    this.#others.push(square)
    return square
  }

  #isIdle(square: GroundShadow): boolean {
    return square.#camera === null || this.#uses - square.#used > MAX_IDLE
  }

  /**
   * Moves on with a viewer, and with the world's origin.
   *
   * @param position - World [units].
   * @param frame - As of {@link fieldOf}.
   */
  follow(position: Vector3, frame?: number): void {
    if (frame === undefined || frame !== this.#frame) this.#find(position)
    this.#frame = frame
    this.#place()
  }

  get #figure(): typeof PLANE {
    return this.atmosphere.flat ? PLANE : this.atmosphere.ellipsoid
  }

  /** World space to the figure's, in metres: one matrix, good until the next call. */
  get #toFigure(): Matrix4 {
    const { flat, metersPerUnit, worldToECEF } = this.atmosphere
    return flat ? _scaling.makeScale(metersPerUnit, metersPerUnit, metersPerUnit) : worldToECEF
  }

  #place(): void {
    // The origin of the world, its axes and units may have changed since.
    if (!Number.isNaN(this.#middle.x)) {
      this.matrix.copy(this.#toFigure).invert().multiply(this.#square)
    }
  }

  /** Finds some heights of the next square, once the camera is far from the middle of the one in use or the ground has changed. */
  #find(position: Vector3): void {
    const { width, texels } = this
    const subpoint = this.#subpoint.copy(position).applyMatrix4(this.#toFigure)
    this.#figure.footPoint(subpoint, subpoint)
    const isFirst = Number.isNaN(this.#middle.x)
    // The square that is being made may be left behind, too.
    _place.setFromMatrixPosition(this.#axes)
    const isLeft = this.#found > 0 && subpoint.distanceTo(_place) > LEAP * width
    if (this.#found === 0 || isLeft) {
      const distance = subpoint.distanceTo(this.#middle)
      const isSame = this.ground.version === this.#groundVersion
      if (isSame && distance < MAX_DISTANCE * width) {
        this.#found = 0
        return
      }
      this.#figure.eastNorthUpFrame(subpoint, this.#axes)
      this.#groundVersion = this.ground.version
      const isLeap = distance > LEAP * width && texels > COARSE
      this.#coarse = isLeap ? new Float32Array(COARSE ** 2) : null
      this.#found = 0
    }
    _toWorld.copy(this.#toFigure).invert()
    const heights = this.#coarse ?? this.#next
    const side = this.#coarse ? COARSE : texels
    const most = this.#coarse ? COARSE_PER_FRAME : ROWS_PER_FRAME * texels
    const end = Math.min(isFirst ? Infinity : this.#found + most, heights.length)
    for (; this.#found < end; this.#found++) {
      const height = this.#heightAt(this.#found, side)
      // Half floats: some devices blend no others.
      heights[this.#found] = this.#coarse ? height : DataUtils.toHalfFloat(height)
    }
    if (end === heights.length) this.#change()
  }

  /** Asks for the heights anew, at once, after the ground or the world has changed. */
  refresh(): void {
    for (const square of this.#others) square.refresh()
    this.#middle.set(NaN, NaN, NaN)
    this.#found = 0
    this.#frame = undefined
  }

  /** Frees the heights. */
  dispose(): void {
    for (const square of this.#others) square.dispose()
    this.heights.dispose()
  }

  /** Height of the next square's ground over the plane through its middle, by number of so many along its edge [m]. */
  #heightAt(index: number, side: number): number {
    const { width } = this
    const east = (index % side) + 0.5
    const north = Math.floor(index / side) + 0.5
    _place.set(east / side - 0.5, north / side - 0.5, 0).multiplyScalar(width)
    _place.applyMatrix4(this.#axes)
    _world.copy(_place).applyMatrix4(_toWorld)
    return this.ground.heightBelow(_world) - this.#figure.heightAt(_place)
  }

  /** Puts the next square in the place of the one in use. */
  #change(): void {
    const { width } = this
    const { image } = this.heights
    const used = image.data as Uint16Array
    if (this.#coarse !== null) {
      spread(this.#coarse, this.#next)
      this.#coarse = null
      // Fine ones come next, wherever the camera is.
      this.#groundVersion = NaN
    }
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

import { Matrix4, Mesh, Quaternion, Vector3 } from 'three'
import type {
  Camera,
  InstancedBufferGeometry,
  InstancedBufferAttribute,
  Intersection,
  Raycaster,
  Scene
} from 'three'
import type { MeshStandardNodeMaterial } from 'three/webgpu'
import { checkAtmosphere, checkRange, withDefaults, type Atmosphere } from '@welkin/atmosphere'
import {
  checkDirection,
  checkFinite,
  checkNonNegative,
  checkVector,
  fail,
  setOptions
} from '@welkin/geo'
import type { HeightSample, HeightSource } from './heights/HeightSource'
import { distanceToGround } from './rays/distanceToGround'
import { raycastGround } from './rays/raycastGround'
import { terrainMaterial } from './surface/terrainMaterial'
import { TerrainUniforms } from './TerrainUniforms'
import { viewerOf } from './tiles/cpu/viewer'
import type { Tile } from './tiles/Tile'
import { INSTANCE_ATTRIBUTES, tileGrid } from './tiles/tileGrid'
import { TileTree, type TileSelection } from './tiles/TileTree'

/** Options of {@link Terrain}. */
export interface TerrainOptions {
  /** Cells along a tile's edge, even, in [4, 128], default 32. */
  resolution?: number
  /** Distance at which a tile is split, in diagonals of it, in [1.2, 4], default 1.5. */
  detail?: number
  /** Surface of the sea above the ellipsoid, default 0 [m]; −Infinity for none. */
  seaLevel?: number
  /** Distance within which ground out of view casts shadows into it, default 3,000 [m]. */
  shadowDistance?: number
  /** Camera that tiles are chosen for; null, the default, for each one that draws. */
  camera?: Camera | null
}

/** Options that may change later. */
const SETTINGS = ['seaLevel', 'shadowDistance', 'camera'] as const

const DEFAULTS: Required<TerrainOptions> = {
  resolution: 32,
  detail: 1.5,
  seaLevel: 0,
  shadowDistance: 3000,
  camera: null
}

/** Tiles that there is room for. */
const CAPACITY = 3000

/** Longest side of a cell of the finest tiles [m]. */
const FINEST_CELL = 0.15

/** Least height of the viewer above the ground that distances count from [m]. */
const LEAST_CLEARANCE = 0.5

/** Level of "no sea", below all ground [m]. */
const NO_SEA = -1e9

const positionWorld = new Vector3()
const positionECEF = new Vector3()
const subpoint = new Vector3()
const reference = new Vector3()
const up = new Vector3()
const quaternion = new Quaternion()
const scale = new Vector3()
const matrix = new Matrix4()
const sample: HeightSample = { height: 0, gradient: new Vector3() }

/**
 * Ground of a whole planet, from a pebble at one's feet to the globe: one mesh and one material, lit, shadowed and
 * hazed like any other.
 *
 * ```ts
 * const terrain = new Terrain(atmosphere, new MountainHeights())
 * terrain.castShadow = terrain.receiveShadow = true
 * scene.add(terrain)
 * ```
 *
 * It lies on the atmosphere's ellipsoid, wherever `atmosphere.worldToECEF` puts that, and follows the camera by itself: its own position
 * and rotation are ignored. On a globe the renderer needs `highPrecision`.
 *
 * @see Strugar 2010, "Continuous distance-dependent level of detail for rendering heightmaps", §3
 */
export class Terrain extends Mesh<InstancedBufferGeometry, MeshStandardNodeMaterial> {
  /** Shared, not owned. */
  readonly atmosphere: Atmosphere
  /** Heights of the ground; shared, not owned. */
  readonly source: HeightSource
  /** Cells along a tile's edge. */
  readonly resolution: number
  /** Distance at which a tile is split, in diagonals of it. */
  readonly detail: number
  readonly #uniforms: TerrainUniforms
  readonly #tree: TileTree
  readonly #selection: TileSelection = { tiles: [], inView: 0 }
  #seaLevel = 0
  #shadowDistance = 0
  #camera: Camera | null = null

  /** @throws If an argument is missing or out of its range, or the atmosphere's world is flat. */
  constructor(atmosphere: Atmosphere, source: HeightSource, options: TerrainOptions = {}) {
    const where = 'Terrain'
    checkAtmosphere(where, atmosphere)
    if (atmosphere.flat) fail(where, 'atmosphere must not be flat', atmosphere)
    checkSource(where, source)
    const { resolution, detail, ...settings } = withDefaults(where, DEFAULTS, options)
    checkRange(where, 'resolution', resolution, 4, 128)
    if (resolution % 2 !== 0) fail(where, 'resolution must be even', resolution)
    checkRange(where, 'detail', detail, 1.2, 4)
    const { ellipsoid } = atmosphere
    const uniforms = new TerrainUniforms(ellipsoid)
    super(tileGrid(resolution, CAPACITY), terrainMaterial(source, uniforms, resolution, detail))
    this.atmosphere = atmosphere
    this.source = source
    this.resolution = resolution
    this.detail = detail
    this.#uniforms = uniforms
    const cells = (2 * ellipsoid.maximumRadius) / resolution / FINEST_CELL
    const finestLevel = Math.max(Math.ceil(Math.log2(cells)), 0)
    this.#tree = new TileTree(ellipsoid, source, finestLevel, detail)
    this.set(settings)
    this.name = 'Terrain'
    // Tiles are culled one by one, and the matrix follows the camera.
    this.frustumCulled = false
    this.matrixAutoUpdate = this.matrixWorldAutoUpdate = false
  }

  /**
   * Changes some settings.
   *
   * @throws If one is unknown or out of its range; then nothing has changed.
   */
  set(settings: Pick<TerrainOptions, (typeof SETTINGS)[number]>): this {
    return setOptions('Terrain', this, settings, ...SETTINGS)
  }

  /** Surface of the sea above the ellipsoid [m]; −Infinity for none. */
  get seaLevel(): number {
    return this.#seaLevel
  }

  set seaLevel(value: number) {
    if (value !== -Infinity) checkRange('Terrain', 'seaLevel', value, -1e5, 1e5)
    this.#seaLevel = value
    this.#uniforms.seaLevel.value = Math.max(value, NO_SEA)
  }

  /** Distance within which ground out of view casts shadows into it, if it casts any, ≥ 0 [m]. */
  get shadowDistance(): number {
    return this.#shadowDistance
  }

  set shadowDistance(value: number) {
    checkNonNegative('Terrain', 'shadowDistance', value)
    this.#shadowDistance = value
  }

  /** Camera that tiles are chosen for; null for each one that draws. */
  get camera(): Camera | null {
    return this.#camera
  }

  set camera(value: Camera | null) {
    if (value !== null && !value?.isCamera)
      fail('Terrain', 'camera must be a Camera or null', value)
    this.#camera = value
  }

  /** Number of tiles chosen last, and of those in view. */
  get tileCount(): { chosen: number; inView: number } {
    const { tiles, inView } = this.#selection
    return { chosen: tiles.length, inView }
  }

  /**
   * Height of the ground, or of the sea over it, above the ellipsoid: that of the surface as drawn about a
   * viewer who stands there [m].
   *
   * @param longitude - [°]
   * @param latitude - Geodetic, in [−90, 90] [°].
   * @throws If one is not finite or out of its range.
   */
  heightAt(longitude: number, latitude: number): number {
    return this.#heightAtSubpoint(this.#subpointAt('heightAt', longitude, latitude))
  }

  /**
   * Unit normal of the surface in ECEF: that of a pixel near the viewer, without stones and tufts.
   *
   * @param longitude - [°]
   * @param latitude - Geodetic, in [−90, 90] [°].
   * @throws If one is not finite or out of its range.
   */
  normalAt(longitude: number, latitude: number, target: Vector3 = new Vector3()): Vector3 {
    const position = this.#subpointAt('normalAt', longitude, latitude)
    this.atmosphere.ellipsoid.surfaceNormal(position, target)
    const { height, gradient } = this.source.sampleAt(position, sample)
    if (height <= this.#seaLevel) return target
    gradient.addScaledVector(target, -gradient.dot(target))
    return target.sub(gradient).normalize()
  }

  /**
   * Height of the surface below a point of the world, above the ellipsoid [m].
   *
   * @param position - World [units].
   * @throws If a component is not finite.
   */
  heightBelow(position: Vector3): number {
    checkVector('Terrain.heightBelow', 'position', position)
    const { ellipsoid, worldToECEF } = this.atmosphere
    subpoint.copy(position).applyMatrix4(worldToECEF)
    return this.#heightAtSubpoint(ellipsoid.footPoint(subpoint, subpoint))
  }

  #subpointAt(method: string, longitude: number, latitude: number): Vector3 {
    checkFinite(`Terrain.${method}`, 'longitude', longitude)
    checkRange(`Terrain.${method}`, 'latitude', latitude, -90, 90)
    return this.atmosphere.ellipsoid.geodeticToECEF({ longitude, latitude }, subpoint)
  }

  /** Height of the surface at a point of the ellipsoid [m]. */
  #heightAtSubpoint(position: Vector3): number {
    return Math.max(this.source.sampleAt(position, sample).height, this.#seaLevel)
  }

  /**
   * Chooses tiles for a camera. Drawing does this by itself; call it for what is drawn before the first frame.
   *
   * @param camera - With `matrixWorld` and projection up to date.
   */
  update(camera: Camera): void {
    const { ellipsoid, worldToECEF } = this.atmosphere
    const { source } = this
    positionWorld.setFromMatrixPosition(camera.matrixWorld)
    positionECEF.copy(positionWorld).applyMatrix4(worldToECEF)
    const ground = this.#heightAtSubpoint(ellipsoid.footPoint(positionECEF, subpoint))
    const clearance = Math.max(ellipsoid.heightAt(positionECEF) - ground, LEAST_CLEARANCE)
    const lowest = Math.max(source.lowest, this.#seaLevel)
    const shadowDistance = this.castShadow ? this.#shadowDistance : 0
    const viewer = viewerOf(
      camera,
      positionECEF,
      clearance,
      lowest,
      worldToECEF,
      ellipsoid,
      shadowDistance,
      this.#seaLevel
    )
    this.#uniforms.update(viewer, ground)
    const { tiles } = this.#tree.select(viewer, CAPACITY, this.#selection)
    this.#write(tiles, ground)
    // ECEF axes at the camera.
    matrix.copy(worldToECEF).invert().decompose(subpoint, quaternion, scale)
    this.matrixWorld.compose(positionWorld, quaternion, scale)
    this.matrix.copy(this.matrixWorld)
  }

  /** Writes tiles as instances, from float64 to differences that float32 can hold. */
  #write(tiles: readonly Tile[], ground: number): void {
    const attributes = INSTANCE_ATTRIBUTES.map(
      name => this.geometry.getAttribute(name) as InstancedBufferAttribute
    )
    const [base, offset, cube] = attributes.map(attribute => attribute.array)
    this.#uniforms.referenceECEF(reference)
    for (const [i, { center, normal, level, extent, cube: point, face }] of tiles.entries()) {
      const n = 4 * i
      up.copy(center).sub(positionECEF).addScaledVector(normal, ground).toArray(base, n)
      base[n + 3] = Math.min(this.#tree.range(level), 1e30)
      up.copy(center).sub(reference).toArray(offset, n)
      offset[n + 3] = extent
      point.toArray(cube, n)
      cube[n + 3] = face
    }
    for (const attribute of attributes) {
      attribute.clearUpdateRanges()
      attribute.addUpdateRange(0, 4 * tiles.length)
      attribute.needsUpdate = true
    }
  }

  /** Chooses tiles before three draws them; shadow maps are drawn with those of the viewer, out of view too. */
  override onBeforeRender(_renderer: unknown, scene: Scene, camera: Camera): void {
    const pass = scene.overrideMaterial as { isShadowPassMaterial?: boolean } | null
    const isShadow = pass?.isShadowPassMaterial === true
    if (!isShadow && (this.#camera === null || camera === this.#camera)) this.update(camera)
    const { chosen, inView } = this.tileCount
    this.geometry.instanceCount = isShadow ? chosen : inView
  }

  /**
   * Point where a ray enters the ground or the sea, with all detail that the source has.
   *
   * @param originECEF - [m]
   * @param directionECEF - Any length but 0.
   * @returns ECEF [m], or null if the ray misses.
   * @throws If a component is not finite or the direction is zero.
   */
  intersectRay(
    originECEF: Vector3,
    directionECEF: Vector3,
    target: Vector3 = new Vector3()
  ): Vector3 | null {
    checkVector('Terrain.intersectRay', 'originECEF', originECEF)
    checkDirection('Terrain.intersectRay', 'directionECEF', directionECEF)
    up.copy(directionECEF).normalize()
    const distance = distanceToGround(this, originECEF, up, 0, Infinity)
    return distance === null ? null : target.copy(originECEF).addScaledVector(up, distance)
  }

  /**
   * Hit of a ray of three's `Raycaster` on the ground or the sea: to 1 mm, wherever the camera is. Its normal is in the
   * terrain's own axes, those of ECEF; it has no face.
   */
  override raycast(raycaster: Raycaster, intersects: Intersection[]): void {
    raycastGround(this, raycaster, intersects)
  }

  /** Frees geometry and material; atmosphere and source are shared. */
  override dispose(): void {
    super.dispose()
    this.geometry.dispose()
    this.material.dispose()
  }
}

/** @throws If it is no source of heights. */
function checkSource(where: string, source: HeightSource): void {
  const isSource =
    typeof source?.sampleAt === 'function' &&
    typeof source.sample === 'function' &&
    typeof source.variation === 'function'
  if (!isSource) fail(where, 'source must be a HeightSource', source)
  checkFinite(where, 'source.lowest', source.lowest)
  checkFinite(where, 'source.highest', source.highest)
}

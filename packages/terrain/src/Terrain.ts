import { Matrix4, Quaternion, Vector3 } from 'three'
import type { Camera, InstancedBufferGeometry, Intersection, Raycaster } from 'three'
import type { Scene, Texture } from 'three'
import type { Renderer } from 'three/webgpu'
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
import { CAPACITY, PagedTiles } from './pages/PagedTiles'
import type { PageImages } from './pages/PageImages'
import type { PageSource } from './pages/PageSource'
import { grainTexture } from './surface/grainTexture'
import { distanceToGround } from './rays/distanceToGround'
import { groundNormal } from './rays/Ground'
import { raycastGround } from './rays/raycastGround'
import type { GroundMaps } from './surface/maps/GroundMaps'
import type { GroundMask } from './surface/maps/GroundMask'
import { SeaMesh } from './surface/SeaMesh'
import type { GroundDetail } from './surface/tsl/grain'
import { isShadowPass, terrainMaterial } from './surface/terrainMaterial'
import {
  checkFixed,
  checkSource,
  DEFAULTS,
  SETTING_NAMES,
  type TerrainOptions,
  type TerrainSetting
} from './TerrainOptions'
import { TerrainUniforms } from './TerrainUniforms'
import type { TerrainHorizon } from './tiles/TerrainHorizon'
import { figureOf, isFlat, poleOf, worldToGround, type Figure } from './tiles/cpu/figure'
import { viewerOf } from './tiles/cpu/viewer'
import type { DrawnTiles, TakeFar } from './tiles/FarTiles'
import type { Tile } from './tiles/Tile'
import { tileGrid } from './tiles/tileGrid'
import { ellipsoidInShader, planeInShader } from './tiles/tsl/figure'
import { writeTiles } from './tiles/writeTiles'

/** Least height of the viewer above the ground in the choice of tiles [m]. */
const LEAST_CLEARANCE = 0.5
/** Depth of skirts where no page is missing [cells]: only rounding is hidden. With their width they slope by 68°, more than procedural ground does. */
const SHALLOW = 1

/** Height of "no ceiling", above all ground [m]. */
const NO_CEILING = 1e9
const vectors = Array.from({ length: 7 }, () => new Vector3())
const [positionWorld, positionECEF, subpoint, reference, pole, up, scale] = vectors
const quaternion = new Quaternion()
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
 * It lies on the atmosphere's ellipsoid, wherever `atmosphere.worldToECEF` puts that, and in a `flat` world on the plane y = 0, as a square of 2,097 km
 * about the origin. It follows the camera by itself: its own position and rotation are ignored. On a globe the renderer needs `highPrecision`.
 *
 * @see Strugar 2010, "Continuous distance-dependent level of detail for rendering heightmaps", §3
 */
export class Terrain extends SeaMesh {
  /** Shared, not owned. */
  declare readonly atmosphere: Atmosphere
  /** Heights of the ground; shared, not owned. */
  declare readonly source: HeightSource | PageSource
  /** Imagery of the ground; shared, not owned; null for procedural colours. */
  declare readonly imagery: PageImages | null
  /** Texture maps of the ground's materials; shared, not owned; null for procedural ones. */
  declare readonly maps: GroundMaps | null
  /** Mask of the ground's materials; shared, not owned; null for none. */
  declare readonly mask: GroundMask | null
  /** Leaves out what ground hides; shared, not owned; null for none. */
  declare readonly horizon: TerrainHorizon | null
  /** Cells along a tile's edge. */
  declare readonly resolution: number
  /** Distance at which a tile is split, in diagonals of it. */
  declare readonly detail: number
  /** Most memory of pages on the GPU [MB]. */
  declare readonly pageMemory: number
  readonly #figure: Figure
  readonly #uniforms: TerrainUniforms
  readonly #tiles: PagedTiles
  readonly #grain: Texture
  readonly #takeFar: TakeFar | undefined
  #drawn: DrawnTiles = { tiles: [], inView: 0 }
  #shadowDistance = 0
  #camera: Camera | null = null

  /** @throws If an argument is missing or out of its range. */
  constructor(
    atmosphere: Atmosphere,
    source: HeightSource | PageSource,
    options: TerrainOptions = {}
  ) {
    checkAtmosphere('Terrain', atmosphere)
    checkSource('Terrain', source)
    const all = withDefaults('Terrain', DEFAULTS, options)
    checkFixed('Terrain', all)
    const figure = figureOf(atmosphere)
    const uniforms = new TerrainUniforms(figure)
    const tiles = new PagedTiles(source, figure, all)
    const grain = grainTexture()
    const inShader = isFlat(figure) ? planeInShader : ellipsoidInShader
    const grid = () => tileGrid(all.resolution, CAPACITY)
    const materialOf = (code: GroundDetail) =>
      terrainMaterial(atmosphere, tiles.pages.atlas, grain, uniforms, inShader, all, code)
    super(grid(), materialOf(2), uniforms)
    this.#takeFar = all.far?.(this, grid, materialOf)
    this.#figure = figure
    this.#uniforms = uniforms
    this.#tiles = tiles
    this.#grain = grain
    Object.assign(this, { atmosphere, source }, all)
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
  set(settings: Pick<TerrainOptions, TerrainSetting>): this {
    return setOptions('Terrain', this, settings, ...SETTING_NAMES)
  }

  /** Reflectance of white in the imagery, ≥ 0 [–]. */
  get imageAlbedo(): number {
    return this.#uniforms.imageAlbedo.value
  }

  set imageAlbedo(value: number) {
    checkNonNegative('Terrain', 'imageAlbedo', value)
    this.#uniforms.imageAlbedo.value = value
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

  /** Pages drawn in a frame, ≥ 1: 32 times as many until the first picture is full. */
  get pagesPerFrame(): number {
    return this.#tiles.pagesPerFrame
  }

  set pagesPerFrame(value: number) {
    checkRange('Terrain', 'pagesPerFrame', value, 1, 1000)
    this.#tiles.pagesPerFrame = value
  }

  /** True if nothing is missing in what was drawn last: all tiles have pages, which have faded in. */
  get isFull(): boolean {
    return this.#tiles.isFull
  }

  /** Pages: how many tiles have one, how many there is room for, how many were drawn so far, and memory on the GPU [bytes]. */
  get pages(): { count: number; capacity: number; drawn: number; bytes: number } {
    const { count, drawn, atlas } = this.#tiles.pages
    return { count, capacity: atlas.capacity, drawn, bytes: atlas.bytes }
  }

  /** Counts up whenever heights of the ground have changed, as when some have arrived. */
  get version(): number {
    return this.source.version ?? 0
  }

  /** Number of tiles chosen last, and of those in view. */
  get tileCount(): { chosen: number; inView: number } {
    const { tiles, inView } = this.#tiles.selection
    return { chosen: tiles.length, inView }
  }

  /**
   * Height of the ground, or of the sea over it, above the ellipsoid: that of the surface as drawn about a
   * viewer who stands there [m].
   *
   * @param longitude - East of the prime meridian [°].
   * @param latitude - Geodetic, in [−90, 90] [°].
   * @throws If one is not finite or out of its range, or the world is flat: ask `heightBelow` there.
   */
  heightAt(longitude: number, latitude: number): number {
    return this.#heightAtSubpoint(this.#subpointAt('heightAt', longitude, latitude))
  }

  /**
   * Unit normal of the surface in ECEF: that of a pixel near the viewer, without stones and tufts.
   *
   * @param longitude - East of the prime meridian [°].
   * @param latitude - Geodetic, in [−90, 90] [°].
   * @throws If one is not finite or out of its range.
   */
  normalAt(longitude: number, latitude: number, target: Vector3 = new Vector3()): Vector3 {
    const position = this.#subpointAt('normalAt', longitude, latitude)
    return groundNormal(this, position, target)
  }

  /**
   * Height of the surface below a point of the world, above the ellipsoid [m].
   *
   * @param position - World [units].
   * @throws If a component is not finite.
   */
  heightBelow(position: Vector3): number {
    checkVector('Terrain.heightBelow', 'position', position)
    subpoint.copy(position).applyMatrix4(worldToGround(this.atmosphere))
    return this.#heightAtSubpoint(this.#figure.footPoint(subpoint, subpoint))
  }

  #subpointAt(method: string, longitude: number, latitude: number): Vector3 {
    checkFinite(`Terrain.${method}`, 'longitude', longitude)
    checkRange(`Terrain.${method}`, 'latitude', latitude, -90, 90)
    if (isFlat(this.#figure)) fail(`Terrain.${method}`, 'a flat world has no longitudes')
    return this.atmosphere.ellipsoid.geodeticToECEF({ longitude, latitude }, subpoint)
  }

  /** Height of the surface at a point of the ellipsoid [m]. */
  #heightAtSubpoint(position: Vector3): number {
    return Math.max(this.source.sampleAt(position, sample).height, this.seaLevel)
  }

  /**
   * Chooses tiles for a camera and draws missing pages. Drawing the terrain does this by itself; call it for a full picture at once:
   *
   * ```ts
   * terrain.update(renderer, camera, Infinity)
   * ```
   *
   * Heights that are loaded arrive in later frames.
   *
   * @param camera - With `matrixWorld` and projection up to date.
   * @param most - Pages to draw now, default: what is left of `pagesPerFrame` in this frame. With `Infinity` pages show at once, without a fade.
   * @throws If the pages belong to another renderer that has not been disposed of.
   */
  update(renderer: Renderer, camera: Camera, most?: number): void {
    const figure = this.#figure
    if (figureOf(this.atmosphere) !== figure)
      fail('Terrain', 'atmosphere must stay flat or round, as it was at first')
    const fromWorld = worldToGround(this.atmosphere)
    positionWorld.setFromMatrixPosition(camera.matrixWorld)
    positionECEF.copy(positionWorld).applyMatrix4(fromWorld)
    const ground = this.#heightAtSubpoint(figure.footPoint(positionECEF, subpoint))
    const above = figure.heightAt(positionECEF) - ground
    const viewer = viewerOf(
      camera,
      positionECEF,
      Math.max(above, LEAST_CLEARANCE),
      Math.max(this.source.lowest, this.seaLevel),
      fromWorld,
      figure,
      this.castShadow ? this.#shadowDistance : 0,
      this.seaLevel,
      above >= LEAST_CLEARANCE
    )
    this.#uniforms.update(viewer, ground, poleOf(this.atmosphere, pole))
    this.#tiles.update(renderer, viewer, most)
    const { tree, selection } = this.#tiles
    const isFine = selection.lag === 0
    this.#uniforms.skirt.value = isFine ? SHALLOW : 2 ** (selection.lag + 2)
    this.#uniforms.ceiling.value = isFine ? NO_CEILING : ground + viewer.clearance / 2
    this.#uniforms.referenceECEF(reference)
    this.maps?.update(renderer)
    this.mask?.update(figure, reference)
    const write = (geometry: InstancedBufferGeometry, of: readonly Tile[]): void =>
      writeTiles(geometry, of, positionECEF, reference, ground, tree.ranges)
    this.#drawn =
      this.#takeFar?.(selection, viewer, camera, fromWorld, renderer, write) ?? selection
    write(this.geometry, this.#drawn.tiles)
    // The ground's axes at the camera.
    matrix.copy(fromWorld).invert().decompose(subpoint, quaternion, scale)
    this.matrixWorld.compose(positionWorld, quaternion, scale)
    this.matrix.copy(this.matrixWorld)
  }

  /** Chooses tiles before three draws them; shadow maps are drawn with those of the viewer, out of view too. */
  override onBeforeRender(renderer: unknown, scene: Scene, camera: Camera): void {
    const isShadow = isShadowPass(scene.overrideMaterial)
    if (!isShadow && (this.#camera === null || camera === this.#camera))
      this.update(renderer as Renderer, camera)
    const { tiles, inView } = this.#drawn
    this.geometry.instanceCount = isShadow ? tiles.length : inView
  }

  /**
   * Point where a ray enters the ground or the sea, with all detail that the source has.
   *
   * @param originECEF - Start of the ray [m]; in a flat world along the world's axes, as is the result.
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

  /** Frees geometry, material and pages; atmosphere and source are shared. */
  override dispose(): void {
    super.dispose()
    this.#tiles.dispose()
    this.#grain.dispose()
    this.geometry.dispose()
    this.material.dispose()
  }
}

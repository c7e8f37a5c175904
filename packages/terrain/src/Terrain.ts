import { Matrix4, Quaternion, Vector3 } from 'three'
import type { Camera, InstancedBufferGeometry, Scene, Texture } from 'three'
import type { Renderer } from 'three/webgpu'
import { checkAtmosphere, checkRange, withDefaults, type Atmosphere } from '@welkin/atmosphere'
import { checkNonNegative, fail, setOptions } from '@welkin/geo'
import type { HeightSource } from './heights/HeightSource'
import { CAPACITY, PagedTiles } from './pages/PagedTiles'
import type { PageImages } from './pages/PageImages'
import type { PageSource } from './pages/PageSource'
import { grainTexture } from './surface/grainTexture'
import { GroundMesh } from './rays/GroundMesh'
import type { GroundMaps } from './surface/maps/GroundMaps'
import type { GroundMask } from './surface/maps/GroundMask'
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
const vectors = Array.from({ length: 6 }, () => new Vector3())
const [positionWorld, positionECEF, subpoint, reference, pole, scale] = vectors
const quaternion = new Quaternion()
const matrix = new Matrix4()

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
export class Terrain extends GroundMesh {
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
    const tiles = new PagedTiles(source, figure, all, () => this.onChange?.())
    const grain = grainTexture()
    const inShader = isFlat(figure) ? planeInShader : ellipsoidInShader
    const grid = () => tileGrid(all.resolution, CAPACITY)
    const { atlas } = tiles.pages
    const materialOf = (code?: GroundDetail) =>
      terrainMaterial(atmosphere, atlas, grain, uniforms, inShader, all, code)
    super(grid(), materialOf(), uniforms)
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

  /**
   * Called when another drawing would show more, for renderers that draw on demand: data have arrived, or what failed is asked
   * for again, 5 s later; and within a drawing as long as pages are being drawn or fade in.
   */
  onChange: (() => void) | null = null

  /** Lines that name the sources of heights and imagery: yours to show. */
  get attributions(): string[] {
    const lines = [this.source, this.imagery].flatMap(each => each?.attribution || [])
    return [...new Set(lines)]
  }

  /** Pages: how many tiles have one, how many there is room for, how many were drawn so far, and memory on the GPU [bytes]. */
  get pages(): { count: number; capacity: number; drawn: number; bytes: number } {
    const { count, drawn, atlas } = this.#tiles.pages
    return { count, capacity: atlas.capacity, drawn, bytes: atlas.bytes }
  }

  /** Number of tiles chosen last, and of those in view. */
  get tileCount(): { chosen: number; inView: number } {
    const { tiles, inView } = this.#tiles.selection
    return { chosen: tiles.length, inView }
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
    if (figureOf(this.atmosphere) !== figure) fail('Terrain', 'atmosphere must stay flat or round')
    const fromWorld = worldToGround(this.atmosphere)
    positionWorld.setFromMatrixPosition(camera.matrixWorld)
    positionECEF.copy(positionWorld).applyMatrix4(fromWorld)
    const ground = this.surfaceAt(figure.footPoint(positionECEF, subpoint))
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

  /** Frees geometry, material and pages; atmosphere and source are shared. */
  override dispose(): void {
    super.dispose()
    this.#tiles.dispose()
    this.#grain.dispose()
    this.geometry.dispose()
    this.material.dispose()
  }
}

import type { RenderTarget } from 'three'
import { Vector2 } from 'three'
import { texture } from 'three/tsl'
import type { Renderer, UniformNode } from 'three/webgpu'
import { FragmentPass, tableTarget } from '../tables/FragmentPass'
import { GAP, type TableAtlas } from '../tables/TableAtlas'
import { DEPTH_SIZE, VOLUME_SIZE, VOLUME_SLOTS, VOLUME_TILES } from '../tables/tableSizes'
import { number, vector2 } from '../uniforms'
import type { ViewpointScalars } from '../view/tsl/viewpoint'
import type { Air } from '../scattering/tsl/ray'
import { bakeDepth, bakeSegments, sumSegments } from './tsl/skyVolumeBake'

const [AZIMUTHS, ELEVATIONS] = VOLUME_SIZE
const [TILE_COLUMNS, TILE_ROWS] = VOLUME_TILES

/** Columns of a volume's light, of molecules or aerosols; rows of it; of its depth [texels]. */
const LIGHT_COLUMNS = AZIMUTHS * TILE_COLUMNS
const LIGHT_ROWS = ELEVATIONS * TILE_ROWS
const DEPTH_COLUMNS = DEPTH_SIZE[0]
const DEPTH_ROWS = DEPTH_SIZE[1] + 1

/** Volumes that lie side by side in an atlas, and how wide that is [texels]. */
const ABREAST = 2
export const VOLUMES_WIDTH = ABREAST * (2 * LIGHT_COLUMNS + GAP)

/** Place of a volume in its atlas: the first texels of its light and of its depth. */
export interface VolumeOrigins {
  readonly light: Vector2
  readonly depth: Vector2
}

/** Uniforms of a viewpoint and its volume, and a way to set them all. */
export class ViewpointUniforms implements ViewpointScalars<UniformNode<'float', number>> {
  readonly altitude = number()
  readonly radius = number()
  readonly toHorizon = number()
  readonly toTop = number()
  readonly cosLight = number()
  readonly sinLight = number()
  readonly cosHorizon = number()
  readonly sinHorizon = number()
  readonly belowScale = number()
  readonly aboveScale = number()
  readonly groundStretch = number()
  readonly groundGrowth = number()
  readonly skyStretch = number()
  readonly skyGrowth = number()
  /** First texels of its volume's light and depth in the atlas. */
  readonly lightOrigin = vector2()
  readonly depthOrigin = vector2()

  /** @param volume - Null for none. */
  set(values: ViewpointScalars<number>, volume: VolumeOrigins | null): void {
    for (const key of Object.keys(values) as (keyof ViewpointScalars<number>)[]) {
      this[key].value = values[key]
    }
    if (volume === null) return
    this.lightOrigin.value.copy(volume.light)
    this.depthOrigin.value.copy(volume.depth)
  }
}

/** A volume's place in the atlas. */
export interface SkyVolume extends VolumeOrigins {
  /** Viewpoint that it was computed for; null before the first time. */
  viewpoint: ViewpointScalars<number> | null
  /** Version of the tables that it was computed from. */
  tablesVersion: number
  /** Count of look-ups served by all volumes, when this one last served one. */
  lastUsed: number
}

/** Room that other tables leave to volumes in the atlas [texels]. */
export interface AtlasLayout {
  /** Row that volumes begin at. */
  readonly top: number
  /** Room beside other tables: first texels for the depths of the first volumes, all of a row of them. */
  readonly depths: readonly (readonly [x: number, y: number])[]
}

/**
 * Sky volumes: the light scattered between a place and everything around it, by elevation, azimuth
 * from the source of light and distance, for unit irradiance. A volume serves every camera at its place,
 * whichever way it looks, and every source that stands as high.
 *
 * All lie in one atlas: materials choose theirs by a uniform, where swapping textures would not reach
 * materials that three does not refresh every frame. Each has the light scattered by molecules, beside it
 * that by aerosols straight from the source, and a table of mean extinction along rays.
 */
export class SkyVolumes {
  readonly atlas: TableAtlas
  /** Light of each segment alone, before the sum: nothing that outlasts a bake. */
  readonly segments: RenderTarget
  readonly #ownsSegments: boolean
  readonly #layout: AtlasLayout
  readonly #volumes: SkyVolume[] = []
  readonly #viewpoint = new ViewpointUniforms()
  readonly #depthPass: FragmentPass
  readonly #segmentPass: FragmentPass
  readonly #sumPass: FragmentPass
  #uses = 0

  /**
   * @param atlas - Atlas that keeps them; it grows, and is freed by its owner.
   * @param segments - Segments of other volumes, to share them; their owner frees them.
   */
  constructor(
    air: Air,
    atlas: TableAtlas,
    layout: AtlasLayout = { top: 0, depths: [] },
    segments?: RenderTarget
  ) {
    this.atlas = atlas
    this.#layout = layout
    this.#ownsSegments = segments === undefined
    this.segments = segments ?? tableTarget('SkyVolume.segments', LIGHT_COLUMNS, LIGHT_ROWS, 2)
    this.#depthPass = new FragmentPass('Welkin.SkyVolume.depth', bakeDepth(air, this.#viewpoint))
    this.#segmentPass = new FragmentPass(
      'Welkin.SkyVolume.segments',
      bakeSegments(air, this.#viewpoint, atlas)
    )
    const [molecular, aerosol] = this.segments.textures
    this.#sumPass = new FragmentPass(
      'Welkin.SkyVolume.sum',
      sumSegments(this.#viewpoint, texture(molecular), texture(aerosol))
    )
    this.reserve(VOLUME_SLOTS)
  }

  /**
   * Makes room for so many volumes.
   *
   * @returns True if the atlas grew: then all that was in it is lost.
   */
  reserve(count: number): boolean {
    if (count <= this.#volumes.length) return false
    const { top, depths } = this.#layout
    this.#volumes.length = 0
    let row = top
    for (let slot = 0; slot < count; slot += ABREAST) {
      const depthRow = row
      if (depths[slot] === undefined) row += DEPTH_ROWS + GAP
      for (let i = 0; i < ABREAST; i++) {
        const depth = depths[slot + i] ?? [i * (DEPTH_COLUMNS + GAP), depthRow]
        this.#volumes.push({
          light: new Vector2(i * (2 * LIGHT_COLUMNS + GAP), row),
          depth: new Vector2(...depth),
          viewpoint: null,
          tablesVersion: -1,
          lastUsed: 0
        })
      }
      row += LIGHT_ROWS + GAP
    }
    this.atlas.setSize(VOLUMES_WIDTH, row)
    return true
  }

  /**
   * A volume for a viewpoint: one that is there already, or the one least recently used, computed anew.
   *
   * @param tablesVersion - Version of the tables; volumes from others are stale.
   */
  volumeFor(
    renderer: Renderer,
    viewpoint: ViewpointScalars<number>,
    tablesVersion: number
  ): SkyVolume {
    const fits = (volume: SkyVolume): boolean =>
      volume.viewpoint !== null &&
      volume.tablesVersion === tablesVersion &&
      isSameViewpoint(volume.viewpoint, viewpoint)
    let volume = this.#volumes.find(fits)
    if (volume === undefined) {
      volume = this.#volumes.reduce((oldest, other) =>
        other.lastUsed < oldest.lastUsed ? other : oldest
      )
      volume.viewpoint = viewpoint
      volume.tablesVersion = tablesVersion
      this.#bake(renderer, volume, viewpoint)
    }
    volume.lastUsed = ++this.#uses
    return volume
  }

  /** Forgets what was computed, on another renderer say. */
  invalidate(): void {
    for (const volume of this.#volumes) volume.viewpoint = null
  }

  #bake(renderer: Renderer, volume: SkyVolume, viewpoint: ViewpointScalars<number>): void {
    const { atlas } = this
    const { light, depth } = volume
    this.#viewpoint.set(viewpoint, volume)
    atlas.region(depth.x, depth.y, DEPTH_COLUMNS, DEPTH_ROWS).render(renderer, this.#depthPass)
    this.#segmentPass.render(renderer, this.segments)
    atlas.region(light.x, light.y, 2 * LIGHT_COLUMNS, LIGHT_ROWS).render(renderer, this.#sumPass)
  }

  /** Frees all but the atlas. */
  dispose(): void {
    this.invalidate()
    if (this.#ownsSegments) this.segments.dispose()
    for (const pass of [this.#depthPass, this.#segmentPass, this.#sumPass]) pass.dispose()
  }
}

function isSameViewpoint(a: ViewpointScalars<number>, b: ViewpointScalars<number>): boolean {
  return (
    Math.abs(a.altitude - b.altitude) <= 1e-4 * (b.altitude + 10) &&
    Math.abs(a.cosLight - b.cosLight) <= 1e-6
  )
}

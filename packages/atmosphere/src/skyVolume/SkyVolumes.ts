import type { RenderTarget } from 'three'
import { renderGroup, texture, uniform } from 'three/tsl'
import type { Renderer, UniformNode } from 'three/webgpu'
import type { AtmosphereUniforms } from '../air/AtmosphereUniforms'
import { FragmentPass, tableTarget } from '../tables/FragmentPass'
import { DEPTH_SIZE, VOLUME_SIZE, VOLUME_SLOTS, VOLUME_TILES } from '../tables/tableSizes'
import type { EyeScalars } from '../view/tsl/eye'
import type { Air } from '../scattering/tsl/scattering'
import { bakeDepth, bakeSegments, sumSegments } from './tsl/skyVolumeBake'

const [AZIMUTHS, ELEVATIONS] = VOLUME_SIZE
const [TILE_COLUMNS, TILE_ROWS] = VOLUME_TILES

const scalar = (): UniformNode<'float', number> => uniform(0).setGroup(renderGroup)

/** Uniforms of an eye, and a way to set them all. */
export class EyeUniforms implements EyeScalars<UniformNode<'float', number>> {
  readonly altitude = scalar()
  readonly radius = scalar()
  readonly toHorizon = scalar()
  readonly toTop = scalar()
  readonly cosSun = scalar()
  readonly sinSun = scalar()
  readonly cosHorizon = scalar()
  readonly sinHorizon = scalar()
  readonly belowScale = scalar()
  readonly aboveScale = scalar()
  readonly groundStretch = scalar()
  readonly groundGrowth = scalar()
  readonly skyStretch = scalar()
  readonly skyGrowth = scalar()
  /** Number of the volume in the atlas. */
  readonly slot = scalar()

  set(values: EyeScalars<number>, slot: number): void {
    for (const key of Object.keys(values) as (keyof EyeScalars<number>)[]) {
      this[key].value = values[key]
    }
    this.slot.value = slot
  }
}

/** A volume's place in the atlas. */
export interface SkyVolume {
  readonly slot: number
  /** Viewpoint that it was computed for; null before the first time. */
  eye: EyeScalars<number> | null
  /** Version of the tables that it was computed from. */
  tablesVersion: number
  /** Count of look-ups served by all volumes, when this one last served one. */
  lastUsed: number
}

/**
 * Sky volumes: the light scattered between a place and everything around it, by elevation, azimuth
 * from the sun and distance. A volume serves every camera at its place, whichever way it looks.
 *
 * All lie in one atlas: materials choose theirs by a uniform, where swapping textures would not reach
 * materials that three does not refresh every frame.
 */
export class SkyVolumes {
  /** Attachments: light scattered by molecules, and by aerosols straight from the sun. */
  readonly light: RenderTarget = tableTarget(
    'SkyVolume',
    AZIMUTHS * TILE_COLUMNS,
    ELEVATIONS * TILE_ROWS * VOLUME_SLOTS,
    2
  )
  /** Mean extinction along rays, and in the last column transmittance of all the air. */
  readonly depth: RenderTarget = tableTarget(
    'SkyVolume.depth',
    DEPTH_SIZE[0] + 1,
    DEPTH_SIZE[1] * VOLUME_SLOTS
  )
  /** Light of each segment alone, before the sum: nothing that outlasts a bake. */
  readonly segments: RenderTarget
  readonly #ownsSegments: boolean
  readonly #volumes: SkyVolume[] = Array.from({ length: VOLUME_SLOTS }, (_, slot) => ({
    slot,
    eye: null,
    tablesVersion: -1,
    lastUsed: 0
  }))
  readonly #eye = new EyeUniforms()
  readonly #depthPass: FragmentPass
  readonly #segmentPass: FragmentPass
  readonly #sumPass: FragmentPass
  #uses = 0

  /** @param segments - Those of other volumes, to share them; whose they are frees them. */
  constructor(
    uniforms: AtmosphereUniforms,
    transmittance: RenderTarget,
    diffuse: RenderTarget,
    segments?: RenderTarget
  ) {
    this.#ownsSegments = segments === undefined
    this.segments =
      segments ??
      tableTarget('SkyVolume.segments', AZIMUTHS * TILE_COLUMNS, ELEVATIONS * TILE_ROWS, 2)
    const air: Air = {
      uniforms,
      transmittance: texture(transmittance.texture),
      diffuse: texture(diffuse.texture)
    }
    const [molecular, aerosol] = this.segments.textures.map(part => texture(part))
    this.#depthPass = new FragmentPass('Welkin.SkyVolume.depth', bakeDepth(air, this.#eye))
    this.#segmentPass = new FragmentPass(
      'Welkin.SkyVolume.segments',
      bakeSegments(air, this.#eye, texture(this.depth.texture))
    )
    this.#sumPass = new FragmentPass(
      'Welkin.SkyVolume.sum',
      sumSegments(this.#eye, molecular, aerosol)
    )
  }

  /**
   * A volume for an eye: one that is there already, or the one least recently used, computed anew.
   *
   * @param tablesVersion - Version of the tables; volumes from others are stale.
   */
  volumeFor(renderer: Renderer, eye: EyeScalars<number>, tablesVersion: number): SkyVolume {
    const fits = (volume: SkyVolume): boolean =>
      volume.eye !== null && volume.tablesVersion === tablesVersion && isSameEye(volume.eye, eye)
    let volume = this.#volumes.find(fits)
    if (volume === undefined) {
      volume = this.#volumes.reduce((oldest, other) =>
        other.lastUsed < oldest.lastUsed ? other : oldest
      )
      volume.eye = eye
      volume.tablesVersion = tablesVersion
      this.#bake(renderer, volume.slot, eye)
    }
    volume.lastUsed = ++this.#uses
    return volume
  }

  /** Forgets what was computed, on another renderer say. */
  invalidate(): void {
    for (const volume of this.#volumes) volume.eye = null
  }

  #bake(renderer: Renderer, slot: number, eye: EyeScalars<number>): void {
    this.#eye.set(eye, slot)
    this.#depthPass.render(renderer, this.depth)
    this.#segmentPass.render(renderer, this.segments)
    this.#sumPass.render(renderer, this.light)
  }

  /** Targets that take GPU memory of their own. */
  get targets(): RenderTarget[] {
    return [this.light, this.depth, ...(this.#ownsSegments ? [this.segments] : [])]
  }

  dispose(): void {
    this.invalidate()
    const passes = [this.#depthPass, this.#segmentPass, this.#sumPass]
    for (const owned of [...this.targets, ...passes]) owned.dispose()
  }
}

function isSameEye(a: EyeScalars<number>, b: EyeScalars<number>): boolean {
  return (
    Math.abs(a.altitude - b.altitude) <= 1e-4 * (b.altitude + 10) &&
    Math.abs(a.cosSun - b.cosSun) <= 1e-6
  )
}

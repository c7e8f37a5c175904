import type { RenderTarget } from 'three'
import { renderGroup, texture, uniform } from 'three/tsl'
import type { Renderer, UniformNode } from 'three/webgpu'
import type { AtmosphereUniforms } from './AtmosphereUniforms'
import type { EyeScalars } from './tsl/eye'
import { FragmentPass, tableTarget } from './FragmentPass'
import { DEPTH_COLUMNS, VOLUME_SIZE, VOLUME_TILES } from './tableSizes'
import type { Air } from './tsl/scattering'
import { bakeDepth, bakeSegments, sumSegments } from './tsl/skyVolumeBake'

const [AZIMUTHS, ELEVATIONS] = VOLUME_SIZE
const [TILE_COLUMNS, TILE_ROWS] = VOLUME_TILES

const atlas = (name: string): RenderTarget =>
  tableTarget(name, AZIMUTHS * TILE_COLUMNS, ELEVATIONS * TILE_ROWS, 2)

/** Uniforms of an eye, and a way to set them all. */
export class EyeUniforms implements EyeScalars<UniformNode<'float', number>> {
  readonly altitude = scalar()
  readonly cosSun = scalar()
  readonly cosHorizon = scalar()
  readonly sinHorizon = scalar()
  readonly belowSpan = scalar()
  readonly aboveSpan = scalar()
  readonly groundExponent = scalar()
  readonly skyExponent = scalar()

  set(values: EyeScalars<number>): void {
    for (const key of Object.keys(values) as (keyof EyeScalars<number>)[]) {
      this[key].value = values[key]
    }
  }
}
const scalar = (): UniformNode<'float', number> => uniform(0).setGroup(renderGroup) as never

/**
 * Light scattered between one place and everything around it: by elevation, azimuth from the sun and
 * distance. Serves every camera at that place, whichever way it looks.
 */
export class SkyVolume {
  /** Attachments: light scattered by molecules, and by aerosols straight from the sun. */
  readonly light: RenderTarget = atlas('SkyVolume')
  readonly depth: RenderTarget = tableTarget('SkyVolume.depth', DEPTH_COLUMNS, ELEVATIONS)
  /** What it was computed for; null before the first time. */
  eye: EyeScalars<number> | null = null
  /** Version of the tables that it was computed from. */
  tablesVersion = -1
  /** Count of look-ups served by all volumes, when this one last served one. */
  lastUsed = 0
  /** Cameras that it serves. */
  users = 0

  dispose(): void {
    this.light.dispose()
    this.depth.dispose()
  }
}

/** Computes sky volumes: the passes and the scratch that they share. */
export class SkyVolumeBaker {
  readonly #eye = new EyeUniforms()
  /** Light of each segment alone, before the sum. */
  readonly scratch: RenderTarget = atlas('SkyVolume.segments')
  readonly #depthSource
  readonly #depthPass: FragmentPass
  readonly #segmentPass: FragmentPass
  readonly #sumPass: FragmentPass

  constructor(uniforms: AtmosphereUniforms, transmittance: RenderTarget, diffuse: RenderTarget) {
    const air: Air = {
      uniforms,
      transmittance: texture(transmittance.texture),
      diffuse: texture(diffuse.texture)
    }
    // Any texture will do until the first volume comes.
    this.#depthSource = texture(transmittance.texture)
    const [molecular, aerosol] = this.scratch.textures
    this.#depthPass = new FragmentPass('Welkin.SkyVolume.depth', bakeDepth(air, this.#eye))
    this.#segmentPass = new FragmentPass(
      'Welkin.SkyVolume.segments',
      bakeSegments(air, this.#eye, this.#depthSource)
    )
    this.#sumPass = new FragmentPass(
      'Welkin.SkyVolume.sum',
      sumSegments(texture(molecular!), texture(aerosol!))
    )
  }

  /** Computes a volume for an eye. */
  bake(renderer: Renderer, volume: SkyVolume, eye: EyeScalars<number>): void {
    this.#eye.set(eye)
    this.#depthPass.render(renderer, volume.depth)
    this.#depthSource.value = volume.depth.texture
    this.#segmentPass.render(renderer, this.scratch)
    this.#sumPass.render(renderer, volume.light)
    volume.eye = eye
  }

  dispose(): void {
    this.scratch.dispose()
    for (const pass of [this.#depthPass, this.#segmentPass, this.#sumPass]) pass.dispose()
  }
}

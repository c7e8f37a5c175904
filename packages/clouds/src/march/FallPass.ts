import { FragmentPass, outputs, tableTarget, type Outputs } from '@welkin/atmosphere'
import { FloatType, NearestFilter } from 'three'
import { float, texture, uv, vec4 } from 'three/tsl'
import type { Renderer } from 'three/webgpu'
import type { ShadingContext } from '../light/tsl/shadingContext'
import type { FallOnRay, PrecipitationShafts } from '../precipitation/PrecipitationShafts'
import { encodeDistance } from '../temporal/tsl/packing'
import type { Float, LevelTexture, Vec2, Vec4 } from '../tsl-types'
import type { CastLight } from './CastLight'
import { marchedPixel, type MarchedTargets } from './tsl/marchedPixel'
import { viewRayAt, type FrameInputs } from './tsl/viewRay'

/** Inputs of the pass. */
export interface FallScene extends ShadingContext {
  readonly viewRays: FrameInputs
}

/** Precipitation on a marched ray, and the ray's log₂ of its end and part of its steps. */
export interface FallOnPixel extends FallOnRay {
  readonly end: Float
  readonly steps: Float
}

/** Factor of a share in [0, 1] that is kept behind a whole number. */
const BEHIND = 0.5

/**
 * Precipitation on the rays of a frame, with its light: a pass between the march and the light of the clouds. In a shader with the clouds', fewer rays at
 * a time would be under way. What it writes stands in for the march's, so that the clouds' light samples no more textures with it than without.
 */
export class FallPass {
  readonly #target = tableTarget('Welkin.CloudsFall', 1, 1, 2, NearestFilter)
  readonly #pass: FragmentPass
  readonly #fallen: readonly LevelTexture<Vec2>[]

  constructor(
    scene: FallScene,
    precipitation: PrecipitationShafts,
    marched: MarchedTargets,
    cast: CastLight
  ) {
    // Moonlit rain is a millionth of sunlit rain: too faint for half floats.
    for (const each of this.#target.textures) each.type = FloatType
    this.#fallen = this.#target.textures.map(each => texture(each) as unknown as LevelTexture<Vec2>)
    this.#pass = new FragmentPass('Welkin.CloudsFall', draw(scene, precipitation, marched, cast))
  }

  /** Has the pass compiled anew where casters have changed. */
  set version(version: string) {
    const { material } = this.#pass
    material.customProgramCacheKey = () => version
    material.needsUpdate = true
  }

  setSize(width: number, height: number): void {
    this.#target.setSize(width, height)
  }

  /** Draws the pass; the march and the casters' light go first. */
  render(renderer: Renderer): void {
    this.#pass.render(renderer, this.#target)
  }

  /** Precipitation on the ray of a pixel. To be called inside of a shader function. */
  read(here: Vec2): FallOnPixel {
    const [radiance, ray] = this.#fallen.map(each => each.sample(here).level(0).toConst() as Vec4)
    const steps = ray.w.floor().toConst() as Float
    return {
      radiance,
      distance: ray.x.exp2().toConst(),
      end: ray.y,
      transmittance: ray.z,
      steps: steps.div(2048).toConst(),
      before: ray.w.sub(steps).div(BEHIND).toConst()
    }
  }

  /** Frees its textures. */
  dispose(): void {
    this.#target.dispose()
    this.#pass.dispose()
  }
}

function draw(
  scene: FallScene,
  precipitation: PrecipitationShafts,
  marched: MarchedTargets,
  cast: CastLight
): Outputs {
  const { viewRays } = scene
  return outputs<[Vec4, Vec4]>(2, ([radiance, fallen]) => {
    const { at, noise } = marchedPixel(viewRays)
    const here = uv() as unknown as Vec2
    const { shares } = cast.pointsAt(here)
    const { ray, litFall } = cast.rayAt(here)
    const { direction } = viewRayAt(viewRays, at)
    const distances = marched.distances.sample(here).level(0).toConst() as Vec4
    const looked = { direction, jitter: noise, marched: ray, litFall }
    const seen = precipitation.among(scene, looked, { distances, shares })
    radiance.assign(seen.radiance)
    const steps = float(ray.w.mul(2048).round()).add(seen.before.clamp().mul(BEHIND))
    fallen.assign(vec4(encodeDistance(seen.distance), ray.y, seen.transmittance, steps))
  })
}

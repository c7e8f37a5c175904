import {
  FragmentPass,
  horizontalIrradiance,
  tableTarget,
  transmittanceToLight
} from '@welkin/atmosphere'
import type {
  AtmosphereView,
  DistanceFog,
  FogOvercast,
  HeightFog,
  LightSource
} from '@welkin/atmosphere'
import { fail } from '@welkin/geo'
import { Fn, If, float, mix, texture, uv, varying, vec2, vec4 } from 'three/tsl'
import type { Renderer, TextureNode, UniformNode } from 'three/webgpu'
import { checkClouds } from '../check'
import type { CloudsNode } from '../march/CloudsNode'
import type { Float, Vec2, Vec3, Vec4 } from '../tsl-types'
import { number } from '../uniforms'
import { decksAround } from './tsl/decks'
import { columnOf, cosLightOf } from './tsl/lightColumns'
import { MOST_DIFFUSE, overcastIrradiance } from './tsl/overcast'

/** Cosines of the light that the table holds. */
const COLUMNS = 64

/** Light under clouds over that under a clear sky: see {@link FogOvercast.light}. */
type CloudyLight = ReturnType<FogOvercast['light']>

/** Clouds in the light of fog: see {@link cloudFogLight}. */
export class CloudFogLight implements FogOvercast {
  /** Shared, not owned. */
  readonly fog: HeightFog | DistanceFog
  /** Clouds that change its light; shared, not owned. */
  readonly clouds: CloudsNode
  /** All light on level ground under clouds over that without in one row, the part of direct light that passes in the other. */
  readonly #target = tableTarget('Welkin.CloudFogLight', COLUMNS, 2)
  readonly #table: TextureNode = texture(this.#target.texture)
  readonly #altitude = number()
  /** Share of the clouds' effect on the light of each source: 0 while light shafts have it. */
  readonly #shares = new Map<LightSource, UniformNode<'float', number>>()
  /** Light at a cosine of its source, of which shaders have one each. */
  readonly #lights = new WeakMap<Float, CloudyLight>()
  #pass: FragmentPass | null = null

  /** @throws If an argument is missing, or the fog has clouds already. */
  constructor(fog: HeightFog | DistanceFog, clouds: CloudsNode) {
    if (fog?.overcast === undefined) {
      fail('CloudFogLight', 'fog must be a HeightFog or DistanceFog', fog)
    }
    if (fog.overcast !== null) {
      fail('CloudFogLight', 'fog must have no other CloudFogLight: dispose of that first', fog)
    }
    checkClouds('CloudFogLight', clouds)
    this.fog = fog
    this.clouds = clouds
    fog.overcast = this
  }

  prepare(renderer: Renderer, { camera, height }: AtmosphereView, altitude: number): void {
    const { clouds } = this
    // Other cameras, as of mirrors and environment maps, have the light at that of the clouds.
    if (camera !== clouds.camera || clouds.isDisposed) return
    if (clouds.field.view.update({ camera }) === undefined) return
    this.#altitude.value = Math.min(Math.max(altitude, 0), Math.max(height, 0))
    this.#pass ??= new FragmentPass('Welkin.CloudFogLight', this.#draw())
    this.#pass.render(renderer, this.#target)
  }

  update({ camera }: AtmosphereView): void {
    const { isDisposed, castsInto } = this.clouds
    const shafts = [...castsInto].filter(each => each.isActive && each.camera === camera)
    for (const [source, share] of this.#shares) {
      const isShadowed = shafts.some(each => each.source === source)
      share.value = isDisposed || isShadowed ? 0 : 1
    }
  }

  light(source: LightSource, cosLight: Float): CloudyLight {
    let share = this.#shares.get(source)
    if (share === undefined) this.#shares.set(source, (share = number()))
    let light = this.#lights.get(cosLight)
    if (light === undefined) this.#lights.set(cosLight, (light = this.#read(share, cosLight)))
    return light
  }

  /** Light of a source, the same for all of a picture: read at its vertices. */
  #read(share: Float, cosLight: Float): CloudyLight {
    const column = columnOf(cosLight)
    const read = (row: number): Vec4 => this.#table.sample(vec2(column, row)).level(float(0))
    return {
      diffuse: varying(mix(vec4(1), read(0.25), share)),
      direct: varying(mix(float(1), read(0.75).x, share))
    }
  }

  /** A texel: at the fog's altitude, below the clouds' camera. */
  #draw(): Vec4 {
    const { field, light, shadows } = this.clouds
    const { falling } = shadows
    const { view } = field
    return Fn((): Vec4 => {
      const texel = uv() as unknown as Vec2
      const cosLight = cosLightOf(texel.x)
      const up = view.up as unknown as Vec3
      const altitude = this.#altitude as Float
      const offset = up.mul(altitude.sub(view.height)).toConst() as Vec3
      const decks = decksAround(field, light.nodes, offset, altitude, up, cosLight, falling)
      const result = vec4(decks.above.beam).toVar()
      If(texel.y.lessThan(0.5), () => {
        const { uniforms, transmittance, diffuse } = view.air
        const direct = transmittanceToLight(uniforms, transmittance, altitude, cosLight)
          .mul(cosLight.max(0))
          .toConst() as Vec4
        const sky = horizontalIrradiance(uniforms, diffuse!, altitude, cosLight).up.toConst()
        const plane = { view, offset, altitude, up, cosLight, cosNormal: float(1) }
        const cloudy = overcastIrradiance(field, light.nodes, plane, offset, sky, falling)
        result.assign(
          cloudy.add(direct.mul(decks.above.beam)).div(direct.add(sky).max(1e-20)).min(MOST_DIFFUSE)
        )
      })
      return result
    })()
  }

  /** Leaves the fog under a clear sky, and frees the table. */
  dispose(): void {
    for (const share of this.#shares.values()) share.value = 0
    if (this.fog.overcast === this) this.fog.overcast = null
    this.#target.dispose()
    this.#pass?.dispose()
    this.#pass = null
  }
}

/**
 * Height fog and distance fog in the light under clouds: without, fog below an overcast glows as on a clear day.
 *
 * ```ts
 * const mist = heightFog({ base: 280, falloff: 40, density: 0.01 })
 * atmosphere.add(mist)
 * cloudFogLight(mist, cloudsNode) // before the first render; `dispose()` ends it
 * ```
 *
 * Height fog loses what clouds take from the sun of the light that it scatters once, and of all other light as much as level ground does;
 * all light of distance fog changes as that on level ground. It is the mean over some kilometres below the clouds' camera, from
 * the weather alone. Where light shafts have the shadows of the clouds (`cloudAirShadow`), those count in its
 * place. Layers whose `shadow` is false have no part in it.
 *
 * @throws If an argument is missing, or the fog has clouds already.
 */
export const cloudFogLight = (fog: HeightFog | DistanceFog, clouds: CloudsNode): CloudFogLight =>
  new CloudFogLight(fog, clouds)

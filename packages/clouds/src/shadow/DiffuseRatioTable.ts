import { FragmentPass, tableTarget } from '@welkin/atmosphere'
import type { RenderTarget } from 'three'
import { Fn, texture, uv, vec2 } from 'three/tsl'
import type { Renderer } from 'three/webgpu'
import type { CloudField } from '../density/CloudField'
import { meanDecks } from '../environment/tsl/decks'
import { diffuseRatio } from '../environment/tsl/overcast'
import type { CloudLight } from '../light/CloudLightTable'
import type { Float, LevelTexture, Vec2, Vec4 } from '../tsl-types'

/** Cosines of the light, which crowd about the horizon, and altitudes, which crowd about the ground. */
const SIZE = [32, 128] as const

/**
 * Diffuse light among clouds over that without clouds, by altitude and cosine of the light, where layers are the same
 * everywhere: computed once a frame and not at each sample of each pixel.
 */
export class DiffuseRatioTable {
  readonly #field: CloudField
  readonly #target: RenderTarget
  readonly #pass: FragmentPass
  readonly #table: LevelTexture<Vec2>

  constructor(field: CloudField, light: CloudLight) {
    this.#field = field
    this.#target = tableTarget('Welkin.CloudDiffuse', ...SIZE)
    this.#table = texture(this.#target.texture) as unknown as LevelTexture<Vec2>
    const { view } = field
    const ratio = Fn((): Vec4 => {
      const place = uv().mul(vec2(...SIZE)).sub(0.5).div(vec2(SIZE[0] - 1, SIZE[1] - 1)).toConst()
      const side = place.x.mul(2).sub(1).toConst() as Float
      const cosLight = side.mul(side.abs()).toConst() as Float
      const altitude = place.y.mul(place.y).mul(view.air.uniforms.thickness).toConst() as Float
      return diffuseRatio(view, meanDecks(field, light, altitude, cosLight), altitude, cosLight)
    })
    this.#pass = new FragmentPass('Welkin.CloudDiffuse', ratio())
  }

  /** Draws it: layers and air may have changed. */
  update(renderer: Renderer): void {
    this.#pass.render(renderer, this.#target)
  }

  sample(altitude: Float, cosLight: Float): Vec4 {
    const { thickness } = this.#field.view.air.uniforms
    const side = cosLight.sign().mul(cosLight.abs().sqrt()).mul(0.5).add(0.5)
    const place = vec2(side, altitude.div(thickness).clamp().sqrt())
    const at = place.mul(vec2(SIZE[0] - 1, SIZE[1] - 1)).add(0.5).div(vec2(...SIZE))
    return this.#table.sample(at).level(0)
  }

  dispose(): void {
    this.#target.dispose()
    this.#pass.dispose()
  }
}

import { FragmentPass } from '@welkin/atmosphere'
import { Fn, uv, vec2 } from 'three/tsl'
import type { Renderer } from 'three/webgpu'
import { meanDecks } from '../environment/tsl/decks'
import { columnOf, cosLightOf } from '../environment/tsl/lightColumns'
import { diffuseRatio } from '../environment/tsl/overcast'
import type { CloudLight } from '../light/CloudLightTable'
import type { Float, Vec2, Vec4 } from '../tsl-types'
import { CASCADE_SIZE as ROWS, TABLE_COLUMNS as COLUMNS } from './CascadeState'
import type { CloudShadowMap } from './CloudShadowMap'

/**
 * Diffuse light among clouds over that without clouds, by altitude and cosine of the light, where layers are the same
 * everywhere: computed once a frame and not at each sample of each pixel. Columns crowd about the horizon, rows
 * about the ground. It is kept beside the clouds' shadows, of whose texture it takes no more.
 */
export class DiffuseRatioTable {
  readonly #shadows: CloudShadowMap
  readonly #pass: FragmentPass

  constructor(shadows: CloudShadowMap, light: CloudLight) {
    const { field, falling } = shadows
    this.#shadows = shadows
    const { view } = field
    const ratio = Fn((): Vec4 => {
      const texel = uv() as unknown as Vec2
      const cosLight = cosLightOf(texel.x)
      const altitude = texel.y.mul(texel.y).mul(view.air.uniforms.thickness).toConst() as Float
      return diffuseRatio(
        view,
        meanDecks(field, light, altitude, cosLight, falling),
        altitude,
        cosLight
      )
    })
    this.#pass = new FragmentPass('Welkin.CloudDiffuse', ratio())
  }

  /** Draws the table, each frame: layers and air may have changed. */
  update(renderer: Renderer): void {
    const { target } = this.#shadows
    for (const part of [target.viewport, target.scissor])
      part.set(target.width - COLUMNS, 0, COLUMNS, ROWS)
    target.scissorTest = true
    this.#pass.render(renderer, target)
  }

  /** Reads the table at an explicit level, so inside of branches, too. */
  sample(altitude: Float, cosLight: Float): Vec4 {
    const { nodes, target, field } = this.#shadows
    // Not before the middle of the first column: bilinear reads would mix in the cascade beside it.
    const column = columnOf(cosLight)
      .max(0.5 / COLUMNS)
      .sub(1)
      .mul(COLUMNS / target.width)
      .add(1)
    const row = altitude
      .div(field.view.air.uniforms.thickness)
      .sqrt()
      .min(1 - 0.5 / ROWS)
      .mul(nodes.scale.y)
    return nodes.map.sample(vec2(column, row)).level(0)
  }

  dispose(): void {
    this.#pass.dispose()
  }
}

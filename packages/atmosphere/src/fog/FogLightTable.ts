import type { Camera, RenderTarget } from 'three'
import { Fn, If, texture, uv, vec2, vec4 } from 'three/tsl'
import type { Renderer, TextureNode, UniformNode } from 'three/webgpu'
import { FragmentPass, tableTarget } from '../tables/FragmentPass'
import { sampleLevel0, type Float, type Vec2, type Vec4 } from '../tsl-types'
import { number } from '../uniforms'
import type { FogLight } from './tsl/fogLight'

/** Altitudes above the fog's base that it holds, in falloff heights: their number, the lowest and the highest. */
const ALTITUDES = 512
const LOWEST = -20
const HIGHEST = 40

/** Rows of a source: direct light, and six moments. */
const ROWS = 7

/** Light in the fog about a camera. */
interface CameraLight {
  readonly target: RenderTarget
  readonly texels: TextureNode
  /** True if shaders read it. */
  isRead: boolean
  /** Render that it was last drawn for; null before it is. */
  drawnFor: number | undefined | null
}

/** State that a table is drawn for. */
interface TableState {
  /** μ_s of each source. */
  readonly cosines: readonly number[]
  /** False while there is no fog. */
  readonly isNeeded: boolean
  /** Number of the render, in which one drawing does for all. */
  readonly renderId?: number
}

/**
 * Light of all sources by altitude in a fog of smooth phase function, drawn once a frame for a camera: pixels of fog read it in
 * place of computing it.
 */
export class FogLightTable {
  readonly #cosines: readonly UniformNode<'float', number>[]
  readonly #pass: FragmentPass
  readonly #lights = new Map<Camera, CameraLight>()

  /**
   * @param sources - Number of sources.
   * @param lightOf - Light of a source at an altitude in falloff heights, for the cosine of its zenith angle.
   */
  constructor(
    sources: number,
    lightOf: (source: number, middle: Float, cosLight: Float) => FogLight
  ) {
    this.#cosines = Array.from({ length: sources }, () => number())
    this.#pass = new FragmentPass('Welkin.FogLight', this.#draw(lightOf))
  }

  /** Draws the light for a camera if its shaders read it, and once before they exist. */
  draw(renderer: Renderer, camera: Camera, { cosines, isNeeded, renderId }: TableState): void {
    const light = this.#lightFor(camera)
    const isUsed =
      isNeeded && light.isRead && (renderId === undefined || light.drawnFor !== renderId)
    if (light.drawnFor !== null && !isUsed) return
    light.drawnFor = renderId
    this.#cosines.forEach((uniform, i) => (uniform.value = cosines[i]))
    this.#pass.render(renderer, light.target)
  }

  /**
   * Reads the light of a source in the fog about a camera.
   *
   * @param middle - Altitude above the base, in falloff heights.
   */
  light(camera: Camera, source: number, middle: Float): FogLight {
    const light = this.#lightFor(camera)
    light.isRead = true
    const column = middle
      .sub(LOWEST)
      .mul((ALTITUDES - 1) / (HIGHEST - LOWEST) / ALTITUDES)
      .add(0.5 / ALTITUDES)
      .toConst() as Float
    const rows = ROWS * this.#cosines.length
    const read = (row: number): Vec4 => {
      const at = vec2(column, (ROWS * source + row + 0.5) / rows) as Vec2
      return sampleLevel0(light.texels, at).toConst()
    }
    const [direct, m00, m10, m11, m20, m21, m22] = Array.from({ length: ROWS }, (_, i) => read(i))
    return { direct, diffuse: { m00, m10, m11, m20, m21, m22 } }
  }

  #lightFor(camera: Camera): CameraLight {
    let light = this.#lights.get(camera)
    if (light === undefined) {
      const target = tableTarget('Welkin.FogLight', ALTITUDES, ROWS * this.#cosines.length)
      light = { target, texels: texture(target.texture), isRead: false, drawnFor: null }
      this.#lights.set(camera, light)
    }
    return light
  }

  #draw(lightOf: (source: number, middle: Float, cosLight: Float) => FogLight): Vec4 {
    return Fn((): Vec4 => {
      const texel = uv()
        .mul(vec2(ALTITUDES, ROWS * this.#cosines.length))
        .floor()
        .toConst()
      const middle = texel.x
        .mul((HIGHEST - LOWEST) / (ALTITUDES - 1))
        .add(LOWEST)
        .toConst() as Float
      const result = vec4(0).toVar()
      this.#cosines.forEach((cosLight, source) => {
        const row = texel.y.sub(ROWS * source).toConst()
        If(row.greaterThan(-0.5).and(row.lessThan(ROWS - 0.5)), () => {
          const { direct, diffuse } = lightOf(source, middle, cosLight)
          const { m00, m10, m11, m20, m21, m22 } = diffuse
          const all = [direct, m00, m10, m11, m20, m21, m22].map(each => vec4(each).toConst())
          for (const [i, value] of all.entries()) {
            If(row.equal(i), () => {
              result.assign(value)
            })
          }
        })
      })
      return result
    })()
  }

  /** Frees the tables, which are drawn again when needed. */
  dispose(): void {
    for (const light of this.#lights.values()) {
      light.target.dispose()
      light.drawnFor = null
    }
    this.#pass.dispose()
  }
}

import { Fn, float, uv } from 'three/tsl'
import { vec4 } from 'three/tsl'
import type { RenderTarget } from 'three'
import type { Renderer } from 'three/webgpu'
import type { AtmosphereUniforms } from './AtmosphereUniforms'
import { FragmentPass, tableTarget } from './FragmentPass'
import { TRANSMITTANCE_SIZE } from './tableSizes'
import { segmentDepth, stepExponent, type Air } from './tsl/scattering'
import { transmittanceRay } from './tsl/transmittance'
import { loop, type Float, type Vec2 } from './tsl-types'

/** Two evaluations each. */
const STEPS = 40

/**
 * Optical depth from a point to the top of the air, by altitude and zenith angle.
 *
 * Depth, not transmittance: it keeps its relative precision in half floats where transmittance
 * underflows, and is nearly linear between texels.
 */
export class TransmittanceTable {
  /** Where the table is kept; `target.texture` is what shaders sample. */
  readonly target: RenderTarget = tableTarget('Transmittance', ...TRANSMITTANCE_SIZE)
  readonly #pass: FragmentPass

  constructor(uniforms: AtmosphereUniforms) {
    const air: Air = { uniforms, transmittance: null as never, diffuse: null }
    this.#pass = new FragmentPass(
      'Welkin.Transmittance',
      Fn(() => {
        const { altitude, cosView, distance } = transmittanceRay(uniforms, uv() as Vec2)
        const ray = { altitude, cosView, cosSun: cosView, cosViewSun: cosView }
        const rise = uniforms.thickness.sub(altitude)
        const exponent = stepExponent(uniforms, rise as Float).toConst()
        const scale = distance.div(exponent.exp().sub(1)).toConst()
        const start = float(0).toVar()
        const depth = vec4(0).toVar()
        loop('step', STEPS, step => {
          const x = float(step).add(1).div(STEPS)
          const end = exponent.mul(x).exp().sub(1).mul(scale).toConst()
          depth.addAssign(segmentDepth(air, ray, start as Float, end as Float).depth)
          start.assign(end)
        })
        return depth
      })()
    )
  }

  /** Computes the table from the uniforms. */
  bake(renderer: Renderer): void {
    this.#pass.render(renderer, this.target)
  }

  /** Frees the table. */
  dispose(): void {
    this.target.dispose()
    this.#pass.dispose()
  }
}

import { Fn, float, uv, vec4 } from 'three/tsl'
import type { Renderer } from 'three/webgpu'
import type { AtmosphereUniforms } from '../air/AtmosphereUniforms'
import { FragmentPass } from '../tables/FragmentPass'
import type { TableRegion } from '../tables/TableAtlas'
import { distanceToTop } from '../air/tsl/boundary'
import { march } from '../scattering/tsl/march'
import { segmentDepth } from '../scattering/tsl/segment'
import type { Air } from '../scattering/tsl/ray'
import { horizonCosine, transmittanceRay } from './tsl/transmittance'
import { sine } from '../math/tsl/trigonometry'
import type { Float, Vec4 } from '../tsl-types'

/** Steps of a march to the top of the air; two evaluations each. */
const STEPS = 30

/**
 * Heights on the sun's disc in units of its radius, with the part of its area that each stands for:
 * Gauss–Chebyshev quadrature of the second kind, whose weight is the disc's width.
 */
const DISC = [1, 2, 3, 4].map(k => {
  const angle = (k * Math.PI) / 5
  return { height: Math.cos(angle), area: (Math.sin(angle) ** 2 * 2) / 5 }
})

/** Optical depth from a point to the top of the air. */
function depthToTop(air: Air, altitude: Float, cosView: Float): Vec4 {
  const { bottomRadius, thickness } = air.uniforms
  const distance = distanceToTop(altitude, cosView, bottomRadius, thickness)
  const ray = { altitude, cosView, cosLight: cosView, cosViewLight: cosView }
  const depth = vec4(0).toVar()
  march(air.uniforms, distance, thickness.sub(altitude), STEPS, (start, end) => {
    depth.addAssign(segmentDepth(air, ray, start, end).depth)
  })
  return depth
}

/**
 * Optical depth from a point to the sun, by altitude and zenith angle: −ln of the transmittance's mean
 * over the part of the disc that is above the horizon.
 *
 * Depth, not transmittance: it keeps its relative precision in half floats where transmittance
 * underflows, and is nearly linear between texels.
 */
export class TransmittanceTable {
  /** Region of the atlas that holds the table. */
  readonly region: TableRegion
  readonly #pass: FragmentPass

  /** @param region - Region of `TRANSMITTANCE_SIZE`; its atlas frees it. */
  constructor(uniforms: AtmosphereUniforms, region: TableRegion) {
    this.region = region
    const { sunAngularRadius } = uniforms
    const air: Air = { uniforms, transmittance: null as never, diffuse: null }
    this.#pass = new FragmentPass(
      'Welkin.Transmittance',
      Fn(() => {
        const { altitude, cosView } = transmittanceRay(uniforms, uv())
        const cosHorizon = horizonCosine(uniforms, altitude).toConst()
        const sinView = sine(cosView).toConst()
        const light = vec4(0).toVar()
        const area = float(0).toVar()
        const least = vec4(1e9).toVar()
        for (const part of DISC) {
          const cosPart = cosView.add(sinView.mul(sunAngularRadius).mul(part.height)).min(1)
          const depth = depthToTop(air, altitude, cosPart.max(cosHorizon).toConst())
          const visible = cosPart.greaterThanEqual(cosHorizon).select(part.area, 0).toConst()
          // Relative to the least, so that thick air does not underflow.
          const lower = least.min(depth).toConst()
          light.assign(light.mul(lower.sub(least).exp()).add(lower.sub(depth).exp().mul(visible)))
          least.assign(lower)
          area.addAssign(visible)
        }
        return least.sub(light.div(area).log())
      })()
    )
  }

  /** Computes the table from the uniforms. */
  bake(renderer: Renderer): void {
    this.region.render(renderer, this.#pass)
  }

  /** Frees its shader. */
  dispose(): void {
    this.#pass.dispose()
  }
}

import { Fn, float, mat4, vec4 } from 'three/tsl'
import { diffuseLightReader, diffuseMoments } from '../../diffuseLight/tsl/diffuseLight'
import { SH0, SH20, type Moments } from '../../diffuseLight/tsl/moments'
import { COSINE_2, cosineLobe } from '../../diffuseLight/tsl/skyIrradiance'
import { RADIANCE_SCALE } from '../../tables/tableSizes'
import type { Float, Mat4, Vec3, Vec4 } from '../../tsl-types'
import type { ViewNodes } from '../../view/ViewNodes'
import { foundAtVertices } from './foundAtVertices'

type FourColumns = [Vec4, Vec4, Vec4, Vec4]

/** Moments of the light about a position that give the irradiance of planes that face up, as `skyIrradiance` has it. */
function upwardMoments(view: ViewNodes, position: Vec3): Moments<Vec4> {
  const { uniforms, diffuse } = view.air
  const { altitude, cosLight } = view.localCoordinates(view.toMapped(position).toConst())
  const read = diffuseLightReader(uniforms, diffuse!, altitude, cosLight)
  const moments = diffuseMoments(uniforms, diffuse!, altitude, cosLight)
  // What level planes lack grows with the cosine's square, which is a part of two of the moments' functions.
  const missing = read(6).sub(cosineLobe(moments, float(1), cosLight, cosLight)).div(3 * Math.PI)
  const { m00, m20 } = moments
  return {
    ...moments,
    m00: m00.add(missing.div(SH0)),
    m20: m20.add(missing.div(SH20 * COSINE_2))
  }
}

/**
 * Clear light of sun and sky on a fragment: of the vertices about it if it is near, as a material has it that gives this as its
 * `lightAtVertices` to `SunDirectionalLight` and `SkyLightProbe`. Of the sun alone: vertices have no room for the moon's.
 */
export const lightAtVertices = {
  /**
   * Sunlight.
   *
   * @param sunlightAt - That at a position in view space.
   * @returns Null for the light of another source.
   */
  sun(view: ViewNodes, sunlightAt: (position: Vec3) => Vec3): Vec3 | null {
    if (view.source !== view.atmosphere.sun) return null
    return foundAtVertices(view, position => [Fn(() => sunlightAt(position))()])[0]
  },

  /**
   * Irradiance of the sky, as `skyIrradiance` has it for a plane that faces up. Those that face down by a little, such as undersides of stones, see what is above
   * the horizon for what is below it, of which they have hardly any.
   *
   * @returns Null for the light of another source.
   */
  sky(view: ViewNodes, cosNormal: Float, cosLight: Float, cosNormalLight: Float): Vec4 | null {
    if (view.source !== view.atmosphere.sun) return null
    const [m00, m10, m11, m20, m21, m22] = foundAtVertices(view, position => {
      // Four in a matrix: what is asked for inside of a function stays in its stage.
      const four = (pick: (moments: Moments<Vec4>) => Vec4[]): Vec4[] => {
        const matrix = Fn(() => mat4(...(pick(upwardMoments(view, position)) as FourColumns)))()
        return [0, 1, 2, 3].map(n => (matrix as unknown as Mat4).element(n))
      }
      return [
        ...four(({ m00, m10, m11, m20 }) => [m00, m10, m11, m20]),
        ...four(({ m21, m22 }) => [m21, m22, vec4(0), vec4(0)]).slice(0, 2)
      ]
    })
    const moments = { m00, m10, m11, m20, m21, m22 }
    return cosineLobe(moments, cosNormal, cosLight, cosNormalLight).max(0).div(RADIANCE_SCALE)
  }
}

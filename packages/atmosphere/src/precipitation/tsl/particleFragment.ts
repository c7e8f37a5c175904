import { Fn, atan, float, screenUV, sin, smoothstep, varyingProperty, vec2, vec4 } from 'three/tsl'
import type { Float, Vec2, Vec4 } from '../../tsl-types'
import type { DepthRays } from '../../view/DepthRays'
import type { ParticleKind } from '../ParticleKind'

/** Depth over which particles vanish in front of what the picture's depth has [m]. */
const SOFTNESS = 0.1
/** Growth of a lobed flake's mean opacity per squared unevenness, integrated numerically [–]. */
const LOBED_AREA = 0.09

/** Values that a streak's corners hand to its pixels. */
export interface ParticleVaryings {
  /** Place across and along the streak, over its outer radius. */
  readonly across: Vec2
  /**
   * Half its length and its inner radius (of soft particles the sharpness), both over the outer radius; a random number; depth in view
   * space [world units].
   */
  readonly shape: Vec4
  /** Luminance and opacity. */
  readonly light: Vec4
}

export const particleVaryings = (name: string): ParticleVaryings => ({
  across: varyingProperty('vec2', `${name}Across`),
  shape: varyingProperty('vec4', `${name}Shape`),
  light: varyingProperty('vec4', `${name}Light`)
})

/**
 * Colour of a streak's pixel, premultiplied.
 *
 * @param rays - Depth of what hides it; null where the depth test does.
 * @param unit - Metres to world units.
 */
export function particleFragment(
  { unevenness, isSoft }: ParticleKind,
  { across, shape, light }: ParticleVaryings,
  rays: DepthRays | null,
  unit: Float
): Vec4 {
  return Fn(({ renderer }): Vec4 => {
    const beyond = across.y.abs().sub(shape.x).max(0)
    const end = vec2(across.x, beyond.mul(across.y.sign())).toConst() as Vec2
    const radius = end.length().toVar() as Float
    const opacity = light.w.toVar() as Float
    if (unevenness > 0) {
      // Flakes have lobes, which vanish towards the outer radius, or the quad would cut them; blurred ones are round again.
      const sharp = shape.y.mul(unevenness).toConst() as Float
      const angle = atan(end.y, end.x) as unknown as Float
      const three = sin(angle.mul(3).add(shape.z.mul(40)))
      const two = sin(angle.mul(2).add(shape.z.mul(91)))
      const lobes = three.add(two).mul(Math.SQRT1_2).mul(sharp)
      radius.mulAssign(lobes.mul(radius.mul(radius).min(1).oneMinus()).add(1))
      opacity.mulAssign(sharp.mul(sharp).mul(LOBED_AREA).add(1).reciprocal())
    }
    opacity.mulAssign(smoothstep(isSoft ? 0 : shape.y, 1, radius).oneMinus())
    if (rays !== null) {
      const { position, isSky } = rays.at(renderer, screenUV)
      const inFront = shape.w.sub(position.z).div(unit.mul(SOFTNESS)).clamp()
      opacity.mulAssign(isSky.select(float(1), inFront))
    }
    return vec4(light.rgb.mul(opacity), opacity)
  })()
}

import { Fn, If, dot, vec3, vec4 } from 'three/tsl'
import type { Node, NodeBuilder } from 'three/webgpu'
import { linearSRGB, transmittanceRGB } from '../../air/tsl/color'
import type { Air } from '../../scattering/tsl/ray'
import type { MediumSegment } from '../../skyVolume/tsl/skyVolume'
import type { Float, Vec4 } from '../../tsl-types'
import type { ScreenShadows } from '../../view/AirShadows'
import { fragmentDepth } from './fragmentDepth'
import { viewSegment, type ShellView, type ViewSegment } from './viewSegment'

/** Luminance of the components of linear sRGB. */
const LUMINANCE = /*#__PURE__*/ vec3(0.2126, 0.7152, 0.0722)

/** `Fn` whose body gets the builder. */
const withBuilder = Fn as unknown as (
  body: (inputs: unknown, builder: NodeBuilder) => Node
) => () => Node

/**
 * Colour and depth of a shell's fragments.
 *
 * @param lightOf - Light of the air along a segment, and its optical depth.
 * @param shadows - Shadows in the air, which dim it.
 * @returns Premultiplied colour: in-scatter, with the part of the background that the air hides as alpha;
 *   and the depth that a shell is compared with, that of the segment's middle.
 */
export function shellFragment(
  { uniforms }: Air,
  view: ShellView,
  lightOf: (segment: ViewSegment) => MediumSegment,
  shadows?: Pick<ScreenShadows, 'dim'>
): { color: Vec4; depth: Float } {
  // three writes the depth first, if it does, in the same function.
  const segments = new WeakMap<NodeBuilder, ViewSegment>()
  const segmentOf = (builder: NodeBuilder): ViewSegment => {
    const segment = segments.get(builder) ?? viewSegment(uniforms, view)
    segments.set(builder, segment)
    return segment
  }
  const color = withBuilder((_, builder) => {
    const segment = segmentOf(builder)
    const output = vec4(0).toVar()
    If(segment.length.greaterThan(0), () => {
      const { radiance, depth } = lightOf(segment)
      const transmittance = transmittanceRGB(uniforms, depth.negate().exp())
      const lit = linearSRGB(uniforms, radiance).mul(view.tint)
      const light = shadows?.dim(lit) ?? lit
      output.assign(vec4(light, dot(transmittance, LUMINANCE).oneMinus().clamp()))
    })
    return output
  })
  const depth = withBuilder((_, builder) => fragmentDepth(segmentOf(builder).middleView, builder))
  return { color: color() as Vec4, depth: depth() as Float }
}

import type { DepthTexture, LightShadow } from 'three'
import {
  BasicShadowFilter,
  cos,
  Fn,
  If,
  interleavedGradientNoise,
  screenCoordinate,
  sin,
  texture,
  vec2
} from 'three/tsl'
import type { Node, NodeBuilder } from 'three/webgpu'
import { CSMShadowNode } from 'three/addons/csm/CSMShadowNode.js'

/** Distance of look-ups from the middle [texels]. Smaller: stairs at shadows' edges near the camera. */
const SPREAD = 0.85

/** Inputs of three's filters of shadows. */
interface FilterInputs {
  readonly depthTexture: DepthTexture
  readonly shadowCoord: Node<'vec3'>
  readonly shadow: LightShadow
}

/** Part of the light that passes: of four places around, turned from pixel to pixel, or of two where both have all of it or none. */
const softShadowFilter = /*#__PURE__*/ Fn((inputs): Node<'float'> => {
  const { depthTexture, shadowCoord, shadow } = inputs as unknown as FilterInputs
  const angle = interleavedGradientNoise(screenCoordinate.xy).mul(2 * Math.PI)
  const aside = vec2(cos(angle), sin(angle))
    .mul(SPREAD / shadow.mapSize.x)
    .toConst()
  const across = vec2(aside.y.negate(), aside.x)
  const { xy, z } = shadowCoord
  const passing = (place: Node<'vec2'>): Node<'float'> =>
    texture(depthTexture, place).compare(z) as unknown as Node<'float'>
  const meanOf = (way: Node<'vec2'>): Node<'float'> =>
    passing(xy.add(way))
      .add(passing(xy.sub(way)))
      .mul(0.5)
  const result = meanOf(aside).toVar()
  If(result.greaterThan(0).and(result.lessThan(1)), () => {
    result.addAssign(meanOf(across))
    result.mulAssign(0.5)
  })
  return result
})

/** Cascades of shadows that are soft near the camera alone: farther away a pixel takes one look-up. */
export class Cascades extends CSMShadowNode {
  override setup(builder: NodeBuilder): ReturnType<CSMShadowNode['setup']> {
    const shadows = super.setup(builder)
    // Three's types have no filters of a shadow's own.
    for (const [i, { shadow }] of this.lights.entries()) {
      Object.assign(shadow!, { filterNode: i === 0 ? softShadowFilter : BasicShadowFilter })
    }
    return shadows
  }
}

import type { Vec3 } from '../../tsl-types'
import { coveredPosition } from '../../view/tsl/coveredPosition'
import type { ViewNodes } from '../../view/ViewNodes'
import type { airAtVertices } from './airAtVertices'

/** Material whose triangles are small beside their distance everywhere, such as a terrain's. */
export interface FineMaterial {
  /** `airAtVertices` has sunlight, and the effect of clear air, found at vertices, not pixels, within 200 to 1,000 km by the viewer's height. */
  readonly airAtVertices?: typeof airAtVertices
}

/**
 * Light that changes over kilometres, at a fragment: found there, or as a {@link FineMaterial} has it.
 *
 * @param count - Number of its colours, 1 or 2.
 * @param lightAt - Colours at a position in view space.
 */
export const lightAtFragment = (
  material: object,
  view: ViewNodes,
  count: number,
  lightAt: (position: Vec3) => readonly Vec3[]
): readonly Vec3[] =>
  (material as FineMaterial).airAtVertices?.(view, count, lightAt) ?? lightAt(coveredPosition())

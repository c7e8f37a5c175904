import { BasicShadowFilter } from 'three/tsl'
import type { NodeBuilder } from 'three/webgpu'
import { CSMShadowNode } from 'three/addons/csm/CSMShadowNode.js'

/** Cascades of shadows that are soft near the camera alone: farther away a pixel takes one look-up in place of five. */
export class Cascades extends CSMShadowNode {
  override setup(builder: NodeBuilder): ReturnType<CSMShadowNode['setup']> {
    const shadows = super.setup(builder)
    // Three's types have no filters of a shadow's own.
    for (const { shadow } of this.lights.slice(1)) {
      Object.assign(shadow!, { filterNode: BasicShadowFilter })
    }
    return shadows
  }
}

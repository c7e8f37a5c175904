import { lightning, type CloudsNode, type Lightning } from '@welkin/clouds'
import type { Scene } from 'three'

/** Lightning of the valley's storms, dark until it is asked for: flashes may harm people. They are gentle. */
export function valleyFlashes(scene: Scene, node: CloudsNode): Lightning {
  // #region lightning
  const storm = lightning(node) // before the first render
  scene.add(storm.light) // lights the ground
  storm.enabled = false // until people have been asked, and there is a storm
  // #endregion
  return storm
}

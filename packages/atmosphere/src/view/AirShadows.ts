import type { Node } from 'three/webgpu'
import { checkOptions, fail } from '@welkin/geo'
import type { SkyLayer } from './SkyLayer'

/**
 * Shadows in the air, as `lightShafts` makes them: what they take from the light of an atmosphere is drawn by
 * the nodes that they are given to, after all layers' light and before their media.
 */
export interface AirShadows extends Pick<SkyLayer, 'prepare' | 'update' | 'glow' | 'inScatter'> {
  /**
   * Layer for a post effect, computed once for its pixels and not by every material.
   *
   * @param depthNode - Depth of the scene, as the renderer writes it.
   */
  upTo(depthNode: Node): SkyLayer
}

/** Options of nodes that draw air. */
export interface AirOptions {
  /** Shadows in the air; by default none. */
  shafts?: AirShadows
}

/** @throws If an option is unknown, or shafts are none. */
export function checkShafts(where: string, options: AirOptions): void {
  const { shafts } = checkOptions(where, options, 'shafts')
  if (shafts !== undefined && !shafts.upTo) fail(where, 'shafts must be LightShafts', shafts)
}

import { TimestampQuery } from 'three'
import type { Camera, RenderTarget, Scene } from 'three'
import { InspectorBase } from 'three/webgpu'
import type { WebGPURenderer } from 'three/webgpu'

/** Three's timestamps, of which its types have none. */
interface TimestampBackend {
  hasTimestampQuery(uid: string): boolean
  getTimestamp(uid: string): number
}

/** GPU time of a pass, under the name of what it draws [ms]. */
export type PassTime = readonly [name: string, milliseconds: number]

/**
 * GPU time of each pass of a renderer that keeps timestamps: set it as the renderer's `inspector`.
 *
 * A pass is named after its scene if that has a name, as three's shadow maps have, else after its render target's texture.
 */
export class PassTimes extends InspectorBase {
  readonly #names = new Map<string, string>()

  override beginRender(
    uid: string,
    scene: Scene,
    _camera: Camera,
    target: RenderTarget | null
  ): void {
    const name = scene.name || target?.texture.name
    this.#names.set(uid, name === undefined || name === '' ? 'canvas' : name)
  }

  /**
   * Times since the last call, in the order in which the passes began, and the number of frames that they are of: none
   * where the backend keeps no times.
   */
  async read(renderer: WebGPURenderer): Promise<{ passes: PassTime[]; frames: number }> {
    const names = [...this.#names]
    this.#names.clear()
    await renderer.resolveTimestampsAsync(TimestampQuery.RENDER)
    const backend = renderer.backend as unknown as TimestampBackend
    const frames = new Set<string>()
    const passes = names.flatMap(([uid, name]) => {
      if (!backend.hasTimestampQuery(uid)) return []
      frames.add(uid.slice(uid.lastIndexOf(':')))
      return [[name, backend.getTimestamp(uid)] as const]
    })
    return { passes, frames: frames.size }
  }
}

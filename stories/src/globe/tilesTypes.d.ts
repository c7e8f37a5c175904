import type { Mesh } from 'three'
import type { TMSTilesOverlay } from '3d-tiles-renderer/plugins'

// 3d-tiles-renderer 0.5.3 exports these without types.
declare module '3d-tiles-renderer/plugins' {
  export const TILE_X: unique symbol
  export const TILE_Y: unique symbol
  export const TILE_LEVEL: unique symbol

  export class GeneratedSurfacePlugin {
    constructor(options: { overlay: TMSTilesOverlay })
    loadRootTileset(): Promise<object>
    createChild(x: number, y: number, level: number): { geometricError: number } | null
    parseToMesh(
      buffer: ArrayBuffer,
      tile: object,
      extension: string,
      url: string,
      abortSignal: AbortSignal
    ): Promise<Mesh | null>
    dispose(): void
  }
}

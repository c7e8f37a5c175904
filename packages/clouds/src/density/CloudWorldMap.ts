import { nameTexture } from '@welkin/atmosphere'
import { fail } from '@welkin/geo'
import { RepeatWrapping, type Texture } from 'three'
import { texture as textureNode } from 'three/tsl'
import type { Float, LevelTexture, Vec2, Vec3 } from '../tsl-types'
import { mappedCoverage, type MappedPlanet } from './tsl/coverage'

/**
 * Cloud cover of a whole planet, from an equirectangular picture: north up, longitude −180° at the left edge. Its red
 * channel is the share of the sky that is covered. It should have mipmaps.
 *
 * ```ts
 * texture.wrapS = RepeatWrapping
 * clouds(air, depth, camera, atmosphere, layers, { worldMap: cloudWorldMap(texture) })
 * ```
 */
export class CloudWorldMap {
  /** Shared, not owned. */
  readonly texture: Texture
  /** Width of the picture [texels]. */
  readonly width: number
  readonly #node: LevelTexture<Vec2>

  /** @throws If it is no texture, or does not repeat. */
  constructor(texture: Texture) {
    if (!texture?.isTexture) fail('CloudWorldMap', 'texture must be a Texture', texture)
    if (texture.wrapS !== RepeatWrapping) {
      fail('CloudWorldMap', 'texture.wrapS must be RepeatWrapping', texture.wrapS)
    }
    nameTexture(texture, 'worldMap of clouds')
    this.texture = texture
    this.width = (texture.image as { width?: number } | null)?.width ?? 2048
    this.#node = textureNode(texture) as unknown as LevelTexture<Vec2>
  }

  /** See {@link mappedCoverage}. */
  coverageAt(
    planet: MappedPlanet,
    coverage: Float,
    up: Vec3,
    footprint: Float,
    shift: Vec3
  ): Float {
    return mappedCoverage(this.#node, this.width, planet, coverage, up, footprint, shift)
  }
}

/** Cloud cover of a whole planet: see {@link CloudWorldMap}. */
export const cloudWorldMap = (texture: Texture): CloudWorldMap => new CloudWorldMap(texture)

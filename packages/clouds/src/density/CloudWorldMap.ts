import { checkRange, nameTexture } from '@welkin/atmosphere'
import { checkBoolean, checkOptions, fail } from '@welkin/geo'
import { ClampToEdgeWrapping, RepeatWrapping, type Texture } from 'three'
import { texture as textureNode } from 'three/tsl'
import type { Float, LevelTexture, Vec2, Vec3 } from '../tsl-types'
import { number, vector2 } from '../uniforms'
import { mapShift } from '../layers/layerUniforms'
import { mappedCoverage, type CoverMap, type MappedLayer, type MappedPlanet } from './tsl/coverage'

/**
 * Part of a planet between two meridians and two parallels [degrees]. `east` may be less than `west`: the
 * antimeridian then lies between them.
 */
export interface MapBounds {
  /** Longitude of the western edge. */
  readonly west: number
  /** Geodetic latitude of the southern edge, in [−90, 90]. */
  readonly south: number
  /** Longitude of the eastern edge. */
  readonly east: number
  /** Geodetic latitude of the northern edge, in [−90, 90]. */
  readonly north: number
}

/** Options of {@link CloudWorldMap}. */
export interface CloudWorldMapOptions {
  /**
   * Bounds of the picture, default the whole planet. Beyond it lie further copies of the picture where the texture's
   * wraps are `RepeatWrapping`, or clouds without a map where they are `ClampToEdgeWrapping`.
   */
  bounds?: MapBounds
  /** True: red, green, blue and alpha are the cover of layers 1 to 4. False, the default: red is that of all. */
  perLayer?: boolean
}

const PLANET: MapBounds = { west: -180, south: -90, east: 180, north: 90 }
const radians = Math.PI / 180

/** Size of the bounds, east and north [degrees]. @throws If they are no bounds. */
function sizeOf(bounds: MapBounds): [east: number, north: number] {
  const where = 'CloudWorldMap'
  checkOptions(where, bounds, 'west', 'south', 'east', 'north')
  const { west, south, east, north } = bounds
  checkRange(where, 'bounds.west', west, -360, 360)
  checkRange(where, 'bounds.south', south, -90, 90)
  checkRange(where, 'bounds.east', east, -360, 360)
  checkRange(where, 'bounds.north', north, -90, 90)
  const across = east > west ? east - west : east - west + 360
  if (!(across > 0 && across <= 360)) fail(where, 'bounds must be at most 360° wide', bounds)
  if (north <= south) fail(where, 'bounds.north must be greater than bounds.south', bounds)
  return [across, north - south]
}

/**
 * Cloud cover from a picture, of a whole planet or a part of it: equirectangular, north up, with its west at the left
 * edge. Its red channel is the share of the sky that is covered. It should have mipmaps.
 *
 * ```ts
 * texture.wrapS = RepeatWrapping
 * clouds(air, depth, camera, atmosphere, layers, { worldMap: cloudWorldMap(texture) })
 *
 * const alps = { west: 5, south: 44, east: 17, north: 48 }
 * const radar = cloudWorldMap(picture, { bounds: alps })
 * radar.bounds = { west: 6, south: 44, east: 18, north: 48 }
 * ```
 */
export class CloudWorldMap {
  /** Shared, not owned. */
  readonly texture: Texture
  /** Width of the picture [texels]. */
  readonly width: number
  /** True if all of the planet is mapped: the map then has the weather of regions and fronts. */
  readonly coversPlanet: boolean
  readonly #map: CoverMap & {
    readonly corner: ReturnType<typeof vector2>
    readonly size: ReturnType<typeof vector2>
    readonly texel: ReturnType<typeof vector2>
    readonly shift: ReturnType<typeof number>
  }
  #bounds: MapBounds = PLANET

  /** @throws If it is no texture, its wraps do not suit its bounds, or these are none. */
  constructor(texture: Texture, options: CloudWorldMapOptions = {}) {
    const where = 'CloudWorldMap'
    const names = ['bounds', 'perLayer'] as const
    const { bounds, perLayer = false } = checkOptions(where, options, ...names)
    checkBoolean(where, 'perLayer', perLayer)
    if (!texture?.isTexture) fail(where, 'texture must be a Texture', texture)
    const isRepeated = texture.wrapS === RepeatWrapping
    if (bounds === undefined && !isRepeated) {
      fail(where, 'texture.wrapS must be RepeatWrapping', texture.wrapS)
    }
    const others = [texture.wrapS, texture.wrapT].filter(
      wrap => wrap !== (isRepeated ? RepeatWrapping : ClampToEdgeWrapping)
    )
    if (bounds !== undefined && others.length > 0) {
      const rule = 'texture.wrapS and wrapT must both be RepeatWrapping or ClampToEdgeWrapping'
      fail(where, rule, others[0])
    }
    nameTexture(texture, 'worldMap of clouds')
    this.texture = texture
    this.width = (texture.image as { width?: number } | null)?.width ?? 2048
    this.coversPlanet = isRepeated
    this.#map = {
      texture: textureNode(texture) as unknown as LevelTexture<Vec2>,
      isPlaced: !isRepeated,
      perLayer,
      corner: vector2(),
      size: vector2(),
      texel: vector2(),
      shift: number()
    }
    this.bounds = bounds ?? PLANET
  }

  /** Bounds of the picture; may be changed at any time. Setting it checks it. */
  get bounds(): MapBounds {
    return this.#bounds
  }

  set bounds(bounds: MapBounds) {
    const [east, north] = sizeOf(bounds)
    const { corner, size, texel, shift } = this.#map
    const image = this.texture.image as { height?: number } | null
    corner.value.set(bounds.west, bounds.south).multiplyScalar(radians)
    size.value.set(east, north).multiplyScalar(radians)
    texel.value.set(size.value.x / this.width, size.value.y / (image?.height ?? this.width / 2))
    shift.value = mapShift(texel.value.x)
    this.#bounds = Object.freeze({ ...bounds })
  }

  /** See {@link mappedCoverage}. */
  coverageAt(
    planet: MappedPlanet,
    layer: MappedLayer,
    up: Vec3,
    footprint: Float,
    fields: Vec3
  ): Float {
    return mappedCoverage(this.#map, planet, layer, up, footprint, fields)
  }
}

/** Cloud cover of a whole planet, or a part of it: see {@link CloudWorldMap}. */
export const cloudWorldMap = (texture: Texture, options?: CloudWorldMapOptions): CloudWorldMap =>
  new CloudWorldMap(texture, options)

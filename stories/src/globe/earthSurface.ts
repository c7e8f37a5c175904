import { TilesRenderer } from '3d-tiles-renderer'
import {
  GeneratedSurfacePlugin,
  TILE_LEVEL,
  TILE_X,
  TILE_Y,
  TMSTilesOverlay
} from '3d-tiles-renderer/plugins'
import { Float32BufferAttribute } from 'three'
import type { DataTexture, Mesh, PlaneGeometry, Texture } from 'three'
import {
  attribute,
  materialColor,
  mix,
  replaceDefaultUV,
  smoothstep,
  texture,
  uv,
  vec2
} from 'three/tsl'
import { MeshStandardNodeMaterial } from 'three/webgpu'
import type { Node } from 'three/webgpu'
import { groundDetail } from './detailNoise'

/** The finest level of the imagery. */
const IMAGERY_LEVEL = 2
/**
 * The finest level of the geometry: tiles of 600 m, whose chords are a fraction of a millimetre below the
 * ellipsoid.
 */
const GEOMETRY_LEVEL = 15
/**
 * The coarsest level that is drawn. Pieces of coarser ones are as much as 35 km below the ellipsoid, these 500 m,
 * and they are only ever seen from far away.
 */
const COARSEST_LEVEL = 3
/** Error that no view forgives [m]. */
const NEVER_ENOUGH = 1e6
/** Periods of the detail noise around the equator: 78 km each. */
const DETAIL_PERIODS = 512

interface SurfaceTile {
  [TILE_X]: number
  [TILE_Y]: number
  [TILE_LEVEL]: number
}

/** The part of 3d-tiles-renderer's tiled image source, which has no public types, that is used here. */
interface ImageSource {
  processBufferToTexture(buffer: ArrayBuffer): Promise<Texture>
  lock(x: number, y: number, level: number): Promise<Texture> | Texture
  release(x: number, y: number, level: number): void
}

type Imagery = TMSTilesOverlay & { imageSource: ImageSource; init(): Promise<void> }

interface Tiling {
  setLevel(level: number, options: object): void
  getTileBounds(x: number, y: number, level: number, normalized: boolean, clamp?: boolean): number[]
  getTileContentUVBounds(x: number, y: number, level: number): number[]
}

/**
 * Earth's surface in tiles that load as one comes near: Natural Earth's images, on geometry that goes on
 * dividing where the images end.
 *
 * Without that the surface would be flat pieces of 3°, as much as 2 km below the ellipsoid.
 */
class EarthSurfacePlugin extends GeneratedSurfacePlugin {
  private readonly images = new Set<string>()

  constructor(private readonly imagery: Imagery) {
    super({ overlay: imagery })
    const source = this.source
    const decode = source.processBufferToTexture.bind(source)
    source.processBufferToTexture = async buffer => {
      const map = await decode(buffer)
      // The bitmap has been flipped while decoding; WebGPU would flip it once more.
      map.flipY = false
      map.generateMipmaps = true
      map.anisotropy = 8
      return map
    }
  }

  private get source(): ImageSource {
    return this.imagery.imageSource
  }

  override async loadRootTileset(): Promise<object> {
    await this.imagery.init()
    const tiling = this.imagery.tiling as Tiling
    for (let level = IMAGERY_LEVEL + 1; level <= GEOMETRY_LEVEL; level++) {
      tiling.setLevel(level, { tileCountX: 2 ** (level + 1), tileCountY: 2 ** level })
    }
    const contentUV = tiling.getTileContentUVBounds.bind(tiling)
    tiling.getTileContentUVBounds = (x, y, level) => {
      if (level <= IMAGERY_LEVEL) {
        return contentUV(x, y, level)
      }
      const size = 2 ** (IMAGERY_LEVEL - level)
      const u = (x * size) % 1
      const v = (y * size) % 1
      return [u, v, u + size, v + size]
    }
    return super.loadRootTileset()
  }

  override createChild(x: number, y: number, level: number): { geometricError: number } | null {
    const child = super.createChild(x, y, level)
    if (child !== null && level < COARSEST_LEVEL) {
      child.geometricError = NEVER_ENOUGH
    }
    return child
  }

  override async parseToMesh(
    buffer: ArrayBuffer,
    tile: SurfaceTile,
    extension: string,
    url: string,
    abortSignal: AbortSignal
  ): Promise<Mesh | null> {
    const mesh = await super.parseToMesh(buffer, tile, extension, url, abortSignal)
    if (mesh === null) {
      return null
    }
    const { [TILE_X]: x, [TILE_Y]: y, [TILE_LEVEL]: level } = tile
    const up = Math.max(level - IMAGERY_LEVEL, 0)
    const image = [x >> up, y >> up, level - up] as const
    // The 42 images stay loaded until the end: many tiles share one.
    this.images.add(image.join())
    mesh.userData.map = await this.source.lock(...image)
    const bounds = (this.imagery.tiling as Tiling).getTileBounds(x, y, level, true)
    addDetailCoordinates(mesh.geometry as PlaneGeometry, bounds)
    mesh.receiveShadow = true
    return mesh
  }

  override dispose(): void {
    super.dispose()
    for (const image of this.images) {
      const [x, y, level] = image.split(',').map(Number)
      this.source.release(x, y, level)
    }
  }
}

/**
 * Gives a tile's vertices coordinates for `groundDetail` that go on, up to whole periods, in its neighbours, and such of
 * pictures of the whole globe.
 */
function addDetailCoordinates(geometry: PlaneGeometry, [west, south, east, north]: number[]): void {
  const { widthSegments, heightSegments } = geometry.parameters
  const coordinates: number[] = []
  const places: number[] = []
  const firstX = Math.floor(west * DETAIL_PERIODS)
  const firstY = Math.floor((south * DETAIL_PERIODS) / 2)
  for (let row = 0; row <= heightSegments; row++) {
    for (let column = 0; column <= widthSegments; column++) {
      // The outermost rows and columns are the skirt, below the next inner ones.
      const x = (Math.min(Math.max(column, 1), widthSegments - 1) - 1) / (widthSegments - 2)
      const y = 1 - (Math.min(Math.max(row, 1), heightSegments - 1) - 1) / (heightSegments - 2)
      const place = [west + (east - west) * x, south + (north - south) * y]
      places.push(...place)
      coordinates.push(place[0] * DETAIL_PERIODS - firstX, (place[1] * DETAIL_PERIODS) / 2 - firstY)
    }
  }
  geometry.setAttribute('detail', new Float32BufferAttribute(coordinates, 2))
  geometry.setAttribute('globe', new Float32BufferAttribute(places, 2))
}

/** Material of the surface, shared by all tiles: a graph for each would cost more than drawing it. */
function surfaceNodes(noise: DataTexture): { color: Node<'vec3'>; roughness: Node<'float'> } {
  const detail = attribute<'vec2'>('detail', 'vec2')
  // A texel is 20 km. Shifting the look-up by up to about one turns the blur between texels into coasts and borders.
  const shift = vec2(
    texture(noise, detail.mul(2)).r,
    texture(noise, detail.mul(2).add(0.37)).r
  ).sub(0.5)
  const imagery = replaceDefaultUV(
    () => uv().add(shift.mul(1.8 / 256)),
    materialColor
  ).toVar() as unknown as Node<'vec3'>
  const water = smoothstep(0.01, 0.06, imagery.b.sub(imagery.r))
  const land = groundDetail(noise, detail)
  // A map is lighter than the ground it stands for: this brings woods to an albedo near 0.1 and seas near 0.05.
  const albedo = imagery.pow(1.3).mul(0.8)
  return { color: albedo.mul(mix(land, 1, water.mul(0.9))), roughness: mix(0.95, 0.45, water) }
}

export interface EarthSurface {
  tiles: TilesRenderer
  dispose(): void
}

/**
 * @param url - Directory of a TMS with `tilemapresource.xml`.
 * @param emission - Light that the land gives itself.
 */
export function createEarthSurface(
  url: string,
  noise: DataTexture,
  emission?: Node<'vec3'>
): EarthSurface {
  const tiles = new TilesRenderer()
  tiles.registerPlugin(new EarthSurfacePlugin(new TMSTilesOverlay({ url }) as Imagery))
  tiles.errorTarget = 4
  const { color, roughness } = surfaceNodes(noise)
  tiles.addEventListener('load-model', ({ scene }) => {
    const mesh = scene as Mesh
    const material = new MeshStandardNodeMaterial({ map: mesh.userData.map as Texture })
    material.colorNode = color
    material.roughnessNode = roughness
    if (emission !== undefined) material.emissiveNode = emission
    mesh.material = material
  })
  tiles.addEventListener('dispose-model', ({ scene }) => {
    ;((scene as Mesh).material as MeshStandardNodeMaterial).dispose()
  })
  return { tiles, dispose: () => tiles.dispose() }
}

import { TilesRenderer } from '3d-tiles-renderer'
import {
  CesiumIonAuthPlugin,
  GLTFExtensionsPlugin,
  GoogleCloudAuthPlugin
} from '3d-tiles-renderer/plugins'
import { Mesh, MeshBasicMaterial } from 'three'
import type { Material, MeshStandardMaterial, Object3D } from 'three'
import { DRACOLoader } from 'three/addons/loaders/DRACOLoader.js'

/** Server of tiles. */
export interface TileSource {
  /** A tileset, `ion:` and the number of an asset of Cesium's, or empty for Google's tiles. */
  readonly url: string
  /** Key or token that goes with it. */
  readonly key: string
}

/** Google's Photorealistic 3D Tiles. */
const GOOGLE = 'https://tile.googleapis.com/v1/3dtiles/root.json'
/** Decoder of compressed meshes, which tiles of a server have; fetched from the network, as they are. */
const DRACO = 'https://www.gstatic.com/draco/versioned/decoders/1.5.7/'

/** Tiles with their photographs and no light, which cast shadows. */
export interface UnlitTiles {
  readonly tiles: TilesRenderer
  dispose(): void
}

/** Gives a tile the unlit materials that photogrammetry has, whatever it came with. */
function unlight(scene: Object3D): void {
  scene.traverse(object => {
    if (!(object instanceof Mesh)) return
    const { map, color, vertexColors, side } = object.material as MeshStandardMaterial
    if (!(object.material instanceof MeshBasicMaterial)) {
      object.material = new MeshBasicMaterial({ map, color, vertexColors, side })
    }
    object.castShadow = true
  })
}

function authorise(tiles: TilesRenderer, { url, key }: TileSource): void {
  const asset = /^ion:(\d+)$/.exec(url)?.[1]
  if (asset !== undefined) {
    tiles.registerPlugin(new CesiumIonAuthPlugin({ apiToken: key, assetId: asset }))
  } else if (url === '' || url.startsWith('https://tile.googleapis.com/')) {
    tiles.registerPlugin(new GoogleCloudAuthPlugin({ apiToken: key }))
  } else if (key !== '') {
    tiles.fetchOptions.headers = { Authorization: `Bearer ${key}` }
  }
}

/** @param source - Undefined for the local tiles: a valley's terrain. */
export function unlitTiles(source?: TileSource): UnlitTiles {
  const local = new URL('world-data/terrain/tileset.json', document.baseURI).href
  const isIon = source?.url.startsWith('ion:') === true
  const tiles = new TilesRenderer(
    source === undefined ? local : isIon ? undefined : source.url || GOOGLE
  )
  let draco: DRACOLoader | undefined
  if (source !== undefined) {
    authorise(tiles, source)
    draco = new DRACOLoader().setDecoderPath(DRACO)
    tiles.registerPlugin(new GLTFExtensionsPlugin({ dracoLoader: draco }))
  }
  tiles.errorTarget = source === undefined ? 4 : 12
  tiles.addEventListener('load-model', ({ scene }) => unlight(scene))
  tiles.addEventListener('dispose-model', ({ scene }) => {
    scene.traverse(object => ((object as Mesh).material as Material | undefined)?.dispose())
  })
  return {
    tiles,
    dispose() {
      tiles.dispose()
      draco?.dispose()
    }
  }
}

import { TilesRenderer } from '3d-tiles-renderer'
import type { DataTexture, Material, Mesh, MeshStandardMaterial, Object3D } from 'three'
import { Vector3 } from 'three'
import { materialColor, uniform, uv } from 'three/tsl'
import { MeshStandardNodeMaterial } from 'three/webgpu'
import { groundDetail } from './detailNoise'

/** Periods of the detail noise across the tileset: 560 m each. */
const DETAIL_PERIODS = 96
/** Side of a tile's image, whose outermost texel centres lie on the tile's border: see scripts/terrain/tile.ts. */
const TEXELS = 192

export interface Terrain {
  tiles: TilesRenderer
  dispose(): void
}

/** @param url - Directory of the tileset that scripts/make-terrain.ts makes. */
export function createTerrain(url: string, noise: DataTexture): Terrain {
  const tiles = new TilesRenderer(`${url}tileset.json`)
  tiles.errorTarget = 4

  // Where a tile lies in the quadtree (x, y) and its share of the side (z): detail goes on across tiles and levels.
  const place = uniform(new Vector3()).onObjectUpdate(({ object }, self) => {
    self.value.copy((object as Object3D).userData.place as Vector3)
  })
  const inTile = uv()
    .mul(TEXELS)
    .sub(0.5)
    .div(TEXELS - 1)
  const color = materialColor.mul(
    groundDetail(noise, inTile.mul(place.z).add(place.xy).mul(DETAIL_PERIODS))
  )

  tiles.addEventListener('load-model', ({ scene, url: tileUrl }) => {
    const [level, y, x] = /(\d+)-(\d+)-(\d+)\.glb/.exec(tileUrl)!.slice(1).map(Number)
    const share = 2 ** -level
    scene.traverse(object => {
      const mesh = object as Mesh
      if (mesh.isMesh) {
        const { map, roughness } = mesh.material as MeshStandardMaterial
        if (map !== null) {
          const material = new MeshStandardNodeMaterial({ map, roughness })
          material.colorNode = color
          mesh.material = material
          mesh.userData.place = new Vector3(x * share, y * share, share)
        }
        mesh.castShadow = true
        mesh.receiveShadow = true
      }
    })
  })
  tiles.addEventListener('dispose-model', ({ scene }) => {
    scene.traverse(object => {
      ;((object as Mesh).material as Material | undefined)?.dispose()
    })
  })
  return { tiles, dispose: () => tiles.dispose() }
}

import { BufferGeometry, Float32BufferAttribute, Group, Mesh } from 'three'
import type { NodeMaterial, WebGPURenderer } from 'three/webgpu'
import { EXTENT, hillHeight, ringStep, SECTORS } from './hillHeight'
import { Plants } from './Plants'
import { soilMaterial, type Soil } from './soil'

/** Distances of the grid's rings from the middle [m]. */
function rings(): number[] {
  const distances = [0]
  for (let distance = 3; distance < EXTENT; distance += ringStep(distance)) distances.push(distance)
  return [...distances, EXTENT]
}

/** Depth of the ground of a planet below a plane that touches it at the middle [m]. */
const dropAt = (x: number, z: number, radius: number): number => (x * x + z * z) / (2 * radius)

/** Hills in rings about the middle: they are as fine as one sees them from there. */
function hills(radius: number, soil: Soil): Mesh {
  const distances = rings()
  const [positions, heights, indices] = [[], [], []] as number[][]
  for (const [ring, distance] of distances.entries()) {
    for (let sector = 0; sector < SECTORS; sector++) {
      const angle = (2 * Math.PI * sector) / SECTORS
      const [x, z] = [distance * Math.cos(angle), distance * Math.sin(angle)]
      const height = hillHeight(x, z)
      positions.push(x, height - dropAt(x, z, radius), z)
      heights.push(height)
      if (ring === 0) continue
      const [from, to] = [sector, (sector + 1) % SECTORS].map(n => n + ring * SECTORS)
      indices.push(from - SECTORS, to, from)
      if (ring > 1) indices.push(from - SECTORS, to - SECTORS, to)
    }
  }
  const geometry = new BufferGeometry()
  geometry.setAttribute('position', new Float32BufferAttribute(positions, 3))
  geometry.setAttribute('height', new Float32BufferAttribute(heights, 1))
  geometry.setIndex(indices)
  geometry.computeVertexNormals()
  const mesh = new Mesh(geometry, soilMaterial(soil))
  mesh.castShadow = mesh.receiveShadow = true
  mesh.frustumCulled = false
  return mesh
}

/** Landscape about the camera of a still, in a Y-up frame on the ground. */
export class Landscape extends Group {
  readonly #hills: Mesh
  readonly #plants: Plants | undefined

  /** @param radius - Radius of the planet [m]. */
  constructor(renderer: WebGPURenderer, radius: number, soil: Soil) {
    super()
    this.#hills = hills(radius, soil)
    this.add(this.#hills)
    if (!soil.isFarmed) return
    const ground = (x: number, z: number): number => hillHeight(x, z) - dropAt(x, z, radius)
    this.#plants = new Plants(renderer, ground, soil.isSnowy === true)
    this.add(this.#plants)
  }

  override dispose(): void {
    this.#hills.geometry.dispose()
    ;(this.#hills.material as NodeMaterial).dispose()
    this.#plants?.dispose()
  }
}

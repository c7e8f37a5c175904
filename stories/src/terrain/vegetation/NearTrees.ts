import {
  DoubleSide,
  InstancedBufferAttribute,
  InstancedBufferGeometry,
  Mesh,
  type BufferGeometry,
  type Vector3
} from 'three'
import { attribute, positionGeometry, transformNormalToView, varying } from 'three/tsl'
import { setFoliage, setTwigs } from '../../valley/leaves'
import type { PlantCells } from './PlantCells'
import { PlantMaterial, plantNodes, type PlantUniforms, type Vec3 } from './plantShader'

/** Most trees with branches. */
const MOST = 600

/**
 * Material of trees with branches.
 *
 * @param isBare - Leaves have fallen.
 */
export function branchMaterial(uniforms: PlantUniforms, isBare = false): PlantMaterial {
  const material = new PlantMaterial({ side: DoubleSide })
  if (isBare) setTwigs(material)
  else setFoliage(material)
  const { foot, size, tint, turned } = plantNodes(uniforms)
  material.positionNode = foot.add(turned((positionGeometry as unknown as Vec3).mul(size)))
  const normal = turned(attribute<'vec3'>('normal', 'vec3')).normalize()
  material.normalNode = varying(transformNormalToView(normal as never) as unknown as Vec3)
  const color = attribute<'vec3'>('color', 'vec3').mul(tint)
  material.colorNode = (material.colorNode as Vec3).mul(varying(color))
  return material
}

/** Trees with branches, which cast shadows: those of the cells that are near the viewer. */
export class NearTrees extends Mesh<InstancedBufferGeometry, PlantMaterial> {
  readonly #cells: PlantCells
  readonly #reach: number
  readonly #places = new InstancedBufferAttribute(new Float32Array(4 * MOST), 4)
  readonly #looks = new InstancedBufferAttribute(new Float32Array(4 * MOST), 4)

  /** @param reach - Distance within which trees have branches [m]. */
  constructor(tree: BufferGeometry, cells: PlantCells, uniforms: PlantUniforms, reach: number) {
    const geometry = new InstancedBufferGeometry()
    for (const [name, values] of Object.entries(tree.attributes))
      geometry.setAttribute(name, values)
    geometry.setIndex(tree.index)
    super(geometry, branchMaterial(uniforms))
    geometry.setAttribute('plantPlace', this.#places)
    geometry.setAttribute('plantLook', this.#looks)
    this.#cells = cells
    this.#reach = reach
    this.castShadow = this.receiveShadow = true
    this.frustumCulled = false
  }

  /** Chooses the trees about a viewer, those out of view too: they cast shadows. */
  choose(viewer: Vector3): void {
    let n = 0
    this.#cells.visit(viewer, this.#reach, (places, looks, i) => {
      const away = Math.hypot(
        places[i] - viewer.x,
        places[i + 1] - viewer.y,
        places[i + 2] - viewer.z
      )
      if (away > this.#reach || n === 4 * MOST) return
      for (let j = 0; j < 4; j++) {
        this.#places.array[n + j] = places[i + j]
        this.#looks.array[n + j] = looks[i + j]
      }
      n += 4
    })
    this.geometry.instanceCount = n / 4
    this.#places.needsUpdate = this.#looks.needsUpdate = true
  }
}

import {
  Group,
  InstancedBufferAttribute,
  Mesh,
  type BufferGeometry,
  type InstancedBufferGeometry
} from 'three'
import type { NodeMaterial, WebGPURenderer } from 'three/webgpu'
import { randomSequence } from '../random'
import { NEAR_LAYER, NEAR_REACH } from '../shafts/landShadow'
import { broadleaf } from '../terrain/vegetation/broadleaf'
import {
  createImpostors,
  drawPictures,
  type Frame,
  type TreePictures
} from '../terrain/vegetation/impostors'
import { branchMaterial } from '../terrain/vegetation/NearTrees'
import { plantGeometry, plantUniforms, type Planted } from '../terrain/vegetation/plantShader'
import { branchedSpruce } from '../valley/treeShapes'
import { fieldPlants, PLANT_KINDS, type Plant, type PlantKind } from './fieldPlants'
import { createMeadowGrass } from './meadowGrass'

/** Shapes of plants, and what their pictures show [m]. */
const SHAPES: Record<PlantKind, { shape: () => BufferGeometry; frame?: Frame }> = {
  oak: { shape: () => broadleaf('oak'), frame: { width: 17, height: 19 } },
  lime: { shape: () => broadleaf('lime') },
  birch: { shape: () => broadleaf('birch') },
  spruce: { shape: () => branchedSpruce(12, 6) },
  bush: { shape: () => broadleaf('bush'), frame: { width: 5, height: 3.4 } }
}

/** Distances between which pictures of trees would go [m]. */
const NEVER = [1e6, 2e6] as const

/** Depth of the feet of trees and of tufts below the ground, by which none hangs over a slope [m]. */
const ROOTS = 0.15
const TUFT_ROOTS = 0.03

/** Tufts per square metre of the meadow, and the distances up to which they stand so close, and at all [m]. */
const TUFTS = 10
const GRASS_CLOSE = 26
const GRASS_TO = 105

/** Height of the ground with its planet's curve [m]. */
type Ground = (x: number, z: number) => number

/** Plants that stand for good. */
function planted(plants: readonly Plant[], ground: Ground, roots = ROOTS): Planted {
  const random = randomSequence(3)
  const places = plants.map(({ x, z, size }) => [x, ground(x, z) - roots * size, z, size])
  const looks = plants.map(({ tint }) => [6.3 * random(), random(), 0, tint])
  const [place, look] = [places, looks].map(
    values => new InstancedBufferAttribute(Float32Array.from(values.flat()), 4)
  )
  return {
    add(geometry: InstancedBufferGeometry): void {
      geometry.setAttribute('plantPlace', place).setAttribute('plantLook', look)
      geometry.instanceCount = plants.length
    }
  }
}

/** Tufts of grass about the middle, close before one's feet and fewer farther off. */
function tufts(): Plant[] {
  const random = randomSequence(23)
  const rings = Math.log(GRASS_TO / GRASS_CLOSE)
  const [close, far] = [0.5, rings].map(part => 2 * Math.PI * TUFTS * GRASS_CLOSE ** 2 * part)
  return Array.from({ length: Math.round(close + far) }, (_, i) => {
    const angle = 2 * Math.PI * random()
    const distance = GRASS_CLOSE * (i < close ? Math.sqrt(random()) : Math.exp(rings * random()))
    const [x, z] = [distance * Math.cos(angle), distance * Math.sin(angle)]
    return { x, z, size: 0.7 + 0.6 * random(), tint: 0.16 * random() ** 2 }
  })
}

/** Grass, hedges, trees and woods of the plain: near the origin with branches, farther off as pictures. */
export class Plants extends Group {
  readonly #uniforms = plantUniforms()
  readonly #pictures: TreePictures[] = []
  readonly #shapes: BufferGeometry[] = []

  /** @param isSnowy - Leaves have fallen, and grass lies under snow. */
  constructor(renderer: WebGPURenderer, ground: Ground, isSnowy: boolean) {
    super()
    const uniforms = this.#uniforms
    const all = fieldPlants()
    for (const kind of PLANT_KINDS) {
      const isBare = isSnowy && kind !== 'spruce'
      const { shape, frame } = SHAPES[kind]
      const geometry = shape()
      const pictures = drawPictures(renderer, geometry, frame, isBare)
      this.#shapes.push(geometry)
      this.#pictures.push(pictures)
      const isNear = ({ x, z }: Plant): boolean => Math.hypot(x, z) < NEAR_REACH
      const near = planted(all[kind].filter(isNear), ground)
      const far = planted(
        all[kind].filter(plant => !isNear(plant)),
        ground
      )
      const trees = new Mesh(plantGeometry(geometry, near), branchMaterial(uniforms, isBare))
      trees.castShadow = trees.receiveShadow = true
      trees.frustumCulled = false
      trees.layers.enable(NEAR_LAYER)
      const woods = createImpostors(pictures, far, uniforms, 0, NEVER)
      // Finer than the texels of the shadow map of all the land.
      woods.castShadow = false
      this.add(trees, woods)
    }
    if (!isSnowy) this.add(createMeadowGrass(planted(tufts(), ground, TUFT_ROOTS), uniforms))
    const [first] = this.children as Mesh[]
    first.onBeforeRender = (_renderer, _scene, camera) => {
      // Not that of a shadow.
      if ('isPerspectiveCamera' in camera) {
        uniforms.viewer.value.setFromMatrixPosition(camera.matrixWorld)
      }
    }
  }

  override dispose(): void {
    for (const { color, normal } of this.#pictures) {
      color.dispose()
      normal.dispose()
    }
    for (const shape of this.#shapes) shape.dispose()
    for (const { geometry, material } of this.children as Mesh[]) {
      geometry.dispose()
      ;(material as NodeMaterial).dispose()
    }
  }
}

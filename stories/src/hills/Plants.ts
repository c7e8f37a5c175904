import {
  Group,
  InstancedBufferAttribute,
  Mesh,
  type BufferGeometry,
  type InstancedBufferGeometry
} from 'three'
import { float } from 'three/tsl'
import type { NodeMaterial, WebGPURenderer } from 'three/webgpu'
import { randomSequence } from '../random'
import { NEAR_LAYER, NEAR_REACH } from '../shafts/landShadow'
import { broadleaf } from '../terrain/vegetation/broadleaf'
import { createGrass } from '../terrain/vegetation/grass'
import {
  createImpostors,
  drawPictures,
  type Frame,
  type TreePictures
} from '../terrain/vegetation/impostors'
import { branchMaterial } from '../terrain/vegetation/NearTrees'
import { plantGeometry, plantUniforms, type Planted } from '../terrain/vegetation/plantShader'
import { branchedSpruce } from '../valley/treeShapes'
import { GRASS } from './fieldPlan'
import { fieldPlants, PLANT_KINDS, type Plant, type PlantKind } from './fieldPlants'

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

/** Depth of roots below the ground, by which no plant hangs over a slope [m]. */
const ROOTS = 0.15

/** Tufts per square metre of the meadow, and the distances up to which they stand so close, and at all [m]. */
const TUFTS = 2
const GRASS_CLOSE = 24
const GRASS_TO = 105

/** Colours of the meadow's blades, linear sRGB. */
const STRAW = [0.24, 0.205, 0.095] as const

/** Height of the ground with its planet's curve [m]. */
type Ground = (x: number, z: number) => number

/** Plants that stand for good. */
function planted(plants: readonly Plant[], ground: Ground): Planted & { count: number } {
  const random = randomSequence(3)
  const places = plants.map(({ x, z, size }) => [x, ground(x, z) - ROOTS * size, z, size])
  const looks = plants.map(({ tint }) => [6.3 * random(), random(), 0, tint])
  const [place, look] = [places, looks].map(
    values => new InstancedBufferAttribute(Float32Array.from(values.flat()), 4)
  )
  return {
    count: plants.length,
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
    return { x, z, size: 0.7 + 0.6 * random(), tint: 0.25 * random() - 0.05 }
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
      const fallen = isSnowy && kind !== 'spruce' ? float(1) : null
      const { shape, frame } = SHAPES[kind]
      const geometry = shape()
      const pictures = drawPictures(renderer, geometry, frame, fallen)
      this.#shapes.push(geometry)
      this.#pictures.push(pictures)
      const isNear = ({ x, z }: Plant): boolean => Math.hypot(x, z) < NEAR_REACH
      const near = planted(all[kind].filter(isNear), ground)
      const far = planted(
        all[kind].filter(plant => !isNear(plant)),
        ground
      )
      const trees = new Mesh(plantGeometry(geometry, near), branchMaterial(uniforms, fallen))
      trees.castShadow = trees.receiveShadow = true
      trees.frustumCulled = false
      trees.layers.enable(NEAR_LAYER)
      const woods = createImpostors(pictures, far, uniforms, 0, NEVER)
      // Finer than the texels of the shadow map of all the land.
      woods.castShadow = false
      this.add(trees, woods)
    }
    if (!isSnowy)
      this.add(createGrass('meadow', planted(tufts(), ground), uniforms, [GRASS, STRAW]))
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

import {
  type BufferGeometry,
  Color,
  ConeGeometry,
  CylinderGeometry,
  IcosahedronGeometry,
  Float32BufferAttribute,
  InstancedMesh,
  Matrix4,
  MeshStandardMaterial,
  Quaternion,
  Vector3
} from 'three'
import { mergeGeometries } from 'three/addons/utils/BufferGeometryUtils.js'
import { randomSequence } from '../random'
import { forestAt, groundHeight, VILLAGE } from './ground'

/** Distance from the village within which trees stand one by one [m]. */
const REACH = 2600

/** Colour of a geometry's vertices, linear sRGB. */
function painted(geometry: BufferGeometry, r: number, g: number, b: number): BufferGeometry {
  const { count } = geometry.attributes.position
  const colors = Array.from({ length: count }, () => [r, g, b]).flat()
  return geometry.setAttribute('color', new Float32BufferAttribute(colors, 3))
}

/** A spruce, 10 m high: tiers of branches about a trunk. */
function spruce(): BufferGeometry {
  const tiers = [0, 1, 2, 3].map(i =>
    painted(
      new ConeGeometry(2.3 - 0.5 * i, 3.6 - 0.3 * i, 7, 1, true)
        .translate(0, 2.9 + 1.9 * i, 0)
        .rotateY(i),
      0.032,
      0.05,
      0.02
    )
  )
  const trunk = painted(
    new CylinderGeometry(0.12, 0.2, 2, 5).translate(0, 0.8, 0),
    0.06,
    0.04,
    0.03
  )
  return mergeGeometries([...tiers, trunk])
}

/** A crown with an uneven outline. */
function leafy(size: number): BufferGeometry {
  const crown = new IcosahedronGeometry(size, 1)
  const { position } = crown.attributes
  const vertex = new Vector3()
  for (let i = 0; i < position.count; i++) {
    vertex.fromBufferAttribute(position, i)
    // Faces share places, not vertices.
    const { x, y, z } = vertex
      .clone()
      .multiplyScalar(7 / size)
      .round()
    const bump = Math.abs(Math.sin(12.9 * x + 78.2 * y + 37.7 * z + 10 * size) * 43_758.5) % 1
    vertex.multiplyScalar(0.82 + 0.32 * bump)
    position.setXYZ(i, vertex.x, vertex.y, vertex.z)
  }
  crown.computeVertexNormals()
  return crown
}

/** A broad-leaved tree, 9 m high. */
function limetree(): BufferGeometry {
  const crowns = [
    [0, 5.6, 0, 2.6],
    [1.5, 4.6, 0.6, 1.9],
    [-1.3, 4.9, 0.9, 1.8],
    [0.2, 4.4, -1.5, 1.9],
    [0.1, 7.3, 0.2, 1.7]
  ].map(([x, y, z, size]) => painted(leafy(size).translate(x, y, z), 0.04, 0.066, 0.018))
  const trunk = new CylinderGeometry(0.2, 0.32, 3.4, 6).toNonIndexed().translate(0, 1.6, 0)
  return mergeGeometries([...crowns, painted(trunk, 0.07, 0.055, 0.04)])
}

/** Spruces on the slopes. */
export const createForest = (count: number): InstancedMesh =>
  plant(spruce(), count, 11, (x, z, height) => forestAt(x, z) + (height > 2 ? 0.004 : 0))

/** Broad-leaved trees about the village, along the shore and among the fields. */
export const createGrove = (count: number): InstancedMesh =>
  plant(limetree(), count, 23, (x, z, height) => {
    const fromVillage = Math.hypot(x - VILLAGE.x, z - VILLAGE.z)
    const shore = height > 1.2 && height < 5 ? 0.35 : 0
    const village = fromVillage > 30 && fromVillage < 210 ? 0.12 : 0
    return height > 1.2 && height < 45 ? shore + village + 0.03 : 0
  })

/** @param shareAt - Chance of a tree at a place of a height, in [0, 1]. */
function plant(
  geometry: BufferGeometry,
  count: number,
  seed: number,
  shareAt: (x: number, z: number, height: number) => number
): InstancedMesh {
  const random = randomSequence(seed)
  const material = new MeshStandardMaterial({ vertexColors: true, roughness: 1, side: 2 })
  const mesh = new InstancedMesh(geometry, material, count)
  const matrix = new Matrix4()
  const color = new Color()
  let placed = 0
  for (let tries = 0; placed < count && tries < 60 * count; tries++) {
    const angle = 2 * Math.PI * random()
    const distance = REACH * random() ** 0.8 + 14
    const x = VILLAGE.x + distance * Math.cos(angle)
    const z = VILLAGE.z + distance * Math.sin(angle)
    const height = groundHeight(x, z)
    if (random() > shareAt(x, z, height)) continue
    const size = 0.55 + 0.95 * random() ** 1.5
    matrix.compose(
      new Vector3(x, height - 0.2, z),
      new Quaternion().setFromAxisAngle(new Vector3(0, 1, 0), 6.3 * random()),
      new Vector3(size * (0.8 + 0.3 * random()), size * (0.9 + 0.5 * random()), size)
    )
    mesh.setMatrixAt(placed, matrix)
    mesh.setColorAt(placed, color.setScalar(0.75 + 0.5 * random()))
    placed++
  }
  mesh.count = placed
  mesh.castShadow = mesh.receiveShadow = true
  mesh.frustumCulled = false
  return mesh
}

import {
  BufferGeometry,
  Color,
  ConeGeometry,
  CylinderGeometry,
  DynamicDrawUsage,
  InstancedMesh,
  Matrix4,
  MeshStandardMaterial,
  Quaternion,
  Vector3
} from 'three'
import { mergeGeometries } from 'three/addons/utils/BufferGeometryUtils.js'
import { Float32BufferAttribute } from 'three'
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
    painted(new ConeGeometry(2.3 - 0.5 * i, 3.6 - 0.3 * i, 7, 1, true).translate(0, 2.9 + 1.9 * i, 0).rotateY(i), 0.032, 0.05, 0.02)
  )
  const trunk = painted(new CylinderGeometry(0.12, 0.2, 2, 5).translate(0, 0.8, 0), 0.06, 0.04, 0.03)
  return mergeGeometries([...tiers, trunk])
}

/** Spruces on the slopes and along the shore. */
export function createForest(count: number): InstancedMesh {
  const random = randomSequence(11)
  const geometry = spruce()
  const material = new MeshStandardMaterial({ vertexColors: true, roughness: 1, side: 2 })
  const mesh = new InstancedMesh(geometry, material, count)
  mesh.instanceMatrix.setUsage(DynamicDrawUsage)
  const matrix = new Matrix4()
  const color = new Color()
  let placed = 0
  for (let tries = 0; placed < count && tries < 60 * count; tries++) {
    const angle = 2 * Math.PI * random()
    const distance = REACH * random() ** 0.75
    const x = VILLAGE.x + distance * Math.cos(angle)
    const z = VILLAGE.z + distance * Math.sin(angle)
    const height = groundHeight(x, z)
    const share = forestAt(x, z) + (height > 2 && distance > 120 ? 0.006 : 0)
    if (random() > share) continue
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

import {
  type BufferAttribute,
  Color,
  DoubleSide,
  Float32BufferAttribute,
  Group,
  IcosahedronGeometry,
  InstancedMesh,
  MathUtils,
  Matrix4,
  Mesh,
  PlaneGeometry,
  Quaternion,
  Vector3
} from 'three'
import { MeshStandardNodeMaterial } from 'three/webgpu'
import { soilMaterial, type Soil } from '../hills/soil'
import { randomSequence } from '../random'
import { setFoliage } from '../valley/leaves'
import { smoothNoise } from '../valley/noise'
import { branchedSpruce } from '../valley/treeShapes'

/** Half width of the land [m], and quads along a side. */
const EXTENT = 40_000
const QUADS = 400

/** Direction from the origin across the ridge, clockwise from north [rad]. */
const ACROSS = MathUtils.degToRad(160)
const FORWARD = [Math.sin(ACROSS), -Math.cos(ACROSS)] as const

/** Turf, and rock. */
const TURF: Soil = { low: [0.075, 0.088, 0.032], high: [0.17, 0.155, 0.13], variation: 0.7 }

/** Spruces on the crest, on the slope before it and in the valley. */
const TREES = { crest: 210, slope: 420, valley: 46 } as const
const ROCKS = 16

/** Ranges behind the ridge: distance, half width, height and length of their peaks [m]. */
const RANGES = [
  [2100, 620, 130, 900],
  [4600, 1100, 300, 1700],
  [10_000, 2300, 640, 3800]
] as const

const bell = (t: number): number => Math.exp(-t * t)

/** Distance of the crest from the origin [m], at a place along the ridge. */
const crestAt = (along: number): number => 590 + 70 * smoothNoise(along / 420 + 3, 8)

/** Height of the crest [m]: it falls to the left, where the sun comes over it. */
const crestHeight = (along: number): number =>
  78 +
  34 * MathUtils.smoothstep(along, -220, 420) +
  16 * smoothNoise(along / 210, 2) +
  5 * smoothNoise(along / 60, 5)

/** Height of the land at a place across the ridge and along it [m]. */
function heightAcross(across: number, along: number): number {
  const before = across - crestAt(along)
  const ridge = crestHeight(along) * bell(before / (before < 0 ? 210 : 330))
  const far = RANGES.map(
    ([distance, width, height, length]) =>
      height *
      bell((across - distance) / width) *
      (0.72 + 0.5 * smoothNoise(along / length + distance, 1))
  )
  const swell =
    3 * smoothNoise(across / 90, along / 90) + 0.8 * smoothNoise(across / 23, along / 23)
  return Math.max(ridge, ...far) + swell * MathUtils.smoothstep(Math.hypot(across, along), 8, 70)
}

/** Height of the land [m]: a valley before a ridge, and ranges behind it. */
export const ridgeHeight = (x: number, z: number): number =>
  heightAcross(x * FORWARD[0] + z * FORWARD[1], z * FORWARD[0] - x * FORWARD[1])

/** Place on the ground, across the ridge and along it, to the right as one looks across [m]. */
function placeAt(across: number, along: number): Vector3 {
  const x = across * FORWARD[0] - along * FORWARD[1]
  const z = across * FORWARD[1] + along * FORWARD[0]
  return new Vector3(x, ridgeHeight(x, z), z)
}

function land(radius: number): Mesh {
  const geometry = new PlaneGeometry(2, 2, QUADS, QUADS).rotateX(-Math.PI / 2)
  const positions = geometry.attributes.position as BufferAttribute
  const heights = new Float32Array(positions.count)
  const stretch = (t: number): number => EXTENT * (0.05 * t + 0.95 * t ** 3)
  for (let i = 0; i < positions.count; i++) {
    const [x, z] = [stretch(positions.getX(i)), stretch(positions.getZ(i))]
    heights[i] = ridgeHeight(x, z)
    positions.setXYZ(i, x, heights[i] - (x * x + z * z) / (2 * radius), z)
  }
  geometry.setAttribute('height', new Float32BufferAttribute(heights, 1))
  geometry.computeVertexNormals()
  const mesh = new Mesh(geometry, soilMaterial(TURF))
  mesh.castShadow = mesh.receiveShadow = true
  mesh.frustumCulled = false
  return mesh
}

/** Places of spruces: in groups with gaps on the crest, thinning out down the slope, and some in the valley. */
function treePlaces(random: () => number): Vector3[] {
  const places: Vector3[] = []
  const add = (
    count: number,
    share: (along: number) => number,
    place: () => [number, number]
  ): void => {
    for (let tries = 0, found = 0; found < count && tries < 60 * count; tries++) {
      const [across, along] = place()
      if (random() > share(along)) continue
      places.push(placeAt(across, along))
      found++
    }
  }
  const inGroup = (along: number): number =>
    MathUtils.smoothstep(smoothNoise(along / 46, 11), -0.18, 0.12) + 0.03
  add(TREES.crest, inGroup, () => {
    const along = 1500 * (random() - 0.5)
    return [crestAt(along) + 46 * (random() - 0.6), along]
  })
  add(
    TREES.slope,
    along => 0.2 + inGroup(along + 90),
    () => {
      const along = 1700 * (random() - 0.5)
      return [crestAt(along) - 40 - 330 * random() ** 1.7, along]
    }
  )
  add(
    TREES.valley,
    () => 1,
    () => {
      const across = 70 + 230 * random()
      const side = (random() < 0.5 ? -1 : 1) * (0.16 + 0.75 * random())
      return [across, side * across]
    }
  )
  return places
}

/** Spruces, 11 to 24 m high. */
function trees(): InstancedMesh {
  const random = randomSequence(53)
  const places = treePlaces(random)
  const material = new MeshStandardNodeMaterial({
    roughness: 1,
    vertexColors: true,
    side: DoubleSide
  })
  setFoliage(material)
  const mesh = new InstancedMesh(branchedSpruce(11, 6), material, places.length)
  places.forEach((place, i) => {
    const size = 1.1 + 1.3 * random() ** 1.4
    const width = size * (0.7 + 0.35 * random())
    const turn = new Quaternion().setFromAxisAngle(new Vector3(0, 1, 0), 6.3 * random())
    place.y -= 0.4
    mesh.setMatrixAt(i, new Matrix4().compose(place, turn, new Vector3(width, size, width)))
    mesh.setColorAt(i, new Color().setScalar(0.8 + 0.7 * random()))
  })
  mesh.castShadow = mesh.receiveShadow = true
  mesh.frustumCulled = false
  return mesh
}

/** Rocks on the crest: boulders of uneven faces, in twos and threes. */
function rocks(): InstancedMesh {
  const random = randomSequence(71)
  const boulder = new IcosahedronGeometry(1, 2)
  const position = boulder.attributes.position as BufferAttribute
  const at = new Vector3()
  for (let i = 0; i < position.count; i++) {
    at.fromBufferAttribute(position, i)
    const bump =
      1 +
      0.42 * smoothNoise(1.7 * at.x + 2 * at.y, 1.7 * at.z - at.y) +
      0.18 * smoothNoise(5 * at.x, 5 * at.z + 4 * at.y)
    position.setXYZ(i, bump * at.x, bump * at.y, bump * at.z)
  }
  boulder.computeVertexNormals()
  const material = new MeshStandardNodeMaterial({ color: '#6c675f', roughness: 1 })
  const mesh = new InstancedMesh(boulder, material, ROCKS)
  for (let i = 0; i < ROCKS; i++) {
    const along = -330 + 46 * i + 30 * random() + (i % 3 === 0 ? 22 : 0)
    const size = 2.5 + 6.5 * random() ** 2
    const place = placeAt(crestAt(along) + 14 * (random() - 0.5), along)
    const turn = new Quaternion().setFromAxisAngle(new Vector3(0, 1, 0), 6.3 * random())
    const scale = new Vector3(size * (0.8 + 0.5 * random()), size * (0.8 + 0.8 * random()), size)
    mesh.setMatrixAt(i, new Matrix4().compose(place, turn, scale))
  }
  mesh.castShadow = mesh.receiveShadow = true
  mesh.frustumCulled = false
  return mesh
}

/** A valley before a ridge with spruces and rocks on its crest, in a Y-up frame on the ground: the sun comes over it. */
export class Ridge extends Group {
  /** @param radius - Radius of the planet [m]. */
  constructor(radius: number) {
    super()
    this.add(land(radius), trees(), rocks())
  }

  override dispose(): void {
    this.traverse(object => {
      if (!(object instanceof Mesh)) return
      object.geometry.dispose()
      object.material.dispose()
      if (object instanceof InstancedMesh) object.dispose()
    })
  }
}

import { Ellipsoid } from '@welkin/geo'
import {
  CylinderGeometry,
  Group,
  IcosahedronGeometry,
  InstancedMesh,
  MathUtils,
  Matrix4,
  Mesh,
  PlaneGeometry,
  Vector3
} from 'three'
import type { BufferGeometry, DataTexture } from 'three'
import {
  abs,
  color,
  float,
  floor,
  fract,
  fwidth,
  max,
  mix,
  normalLocal,
  positionLocal,
  sin,
  smoothstep,
  step,
  texture,
  uniform,
  uv,
  vec2,
  vertexColor
} from 'three/tsl'
import { MeshStandardNodeMaterial } from 'three/webgpu'
import type { Node } from 'three/webgpu'
import { topOf } from '../moving/obstacles'
import { randomSequence } from '../random'
import { BLOCK, CITY_EXTENT, createBuildings, STREET_WIDTH } from './cityBuildings'
import type { Point } from './cityBuildings'
import { CITY, PLACES } from './places'

/** Streets lie this far above the ellipsoid, clear of the globe's tiles [m]. */
const GROUND_HEIGHT = 0.3

/** 1 on `width` around every multiple of `period`, smoothed over a pixel. */
function stripes(x: Node<'float'>, period: number, width: number): Node<'float'> {
  const distance = abs(fract(x.div(period).add(0.5)).sub(0.5)).mul(period)
  const soft = max(fwidth(x), 0.02)
  return smoothstep(soft, soft.negate(), distance.sub(width / 2))
}

/** Luminance of the brightest window, a lane under its lamps, and a wall beside them, and lamplight on leaves over their colour [cd/m²]. */
const LIT = { window: 6, lane: 1.2, wall: 0.8, leaves: 5 }
/** Height in which a wall's light from the street falls to a third [m]. */
const LAMPLIGHT = 9

function facadeMaterial(scale: Node<'float'>): MeshStandardNodeMaterial {
  const cell = uv().div(vec2(2.8, 3.5))
  const inCell = fract(cell)
  const sharp = step(0.16, inCell.x)
    .mul(step(inCell.x, 0.84))
    .mul(step(0.28, inCell.y))
    .mul(step(inCell.y, 0.8))
  // Where a window is smaller than a pixel, a wall has the mean of wall and window.
  const blur = smoothstep(0.3, 0.9, max(fwidth(cell.x), fwidth(cell.y)))
  const isWall = step(0.001, uv().x.add(uv().y))
  const window = mix(sharp, float(0.35), blur).mul(isWall)
  const material = new MeshStandardNodeMaterial()
  material.colorNode = mix(vertexColor().rgb, color('#1b2530'), window)
  material.roughnessNode = mix(0.85, 0.12, window)
  const room = fract(sin(floor(cell).dot(vec2(12.9898, 78.233))).mul(43758.5453))
  const isLit = mix(step(0.66, room), float(0.33), blur)
  // Curtains and lamps differ from room to room.
  const brightness = mix(fract(room.mul(37.7)).mul(0.85).add(0.15), float(0.6), blur)
  const light = mix(color('#ffb56b'), color('#ffe3c4'), fract(room.mul(91.3)))
  const rooms = light.mul(window.mul(isLit).mul(brightness).mul(LIT.window))
  const fromBelow = uv().y.div(-LAMPLIGHT).exp().mul(isWall).mul(LIT.wall)
  const walls = vertexColor().rgb.mul(color('#ffc687')).mul(window.oneMinus()).mul(fromBelow)
  material.emissiveNode = rooms.add(walls).mul(scale)
  return material
}

function streetMaterial(noise: DataTexture, scale: Node<'float'>): MeshStandardNodeMaterial {
  const { x, z } = positionLocal
  const grain = texture(noise, positionLocal.xz.div(6))
    .r.add(texture(noise, positionLocal.xz.div(170)).r)
    .mul(0.5)
  const road = max(
    stripes(x, BLOCK.width, STREET_WIDTH - 8),
    stripes(z, BLOCK.depth, STREET_WIDTH - 8)
  )
  const street = max(stripes(x, BLOCK.width, STREET_WIDTH), stripes(z, BLOCK.depth, STREET_WIDTH))
  const dashes = stripes(x, BLOCK.width, 0.18).mul(step(fract(z.div(9)), 0.45))
  const crossing = stripes(z, BLOCK.depth, STREET_WIDTH)
  const lines = dashes.mul(crossing.oneMinus())
  const lots = color('#6d6a60')
  const pavement = mix(lots, color('#8f8c86'), street)
  const surface = mix(pavement, color('#5b5b5d'), road)
  // Outwards the streets fade into the globe beneath them.
  const ragged = grain.sub(0.5).mul(CITY_EXTENT * 0.9)
  const outside = smoothstep(
    CITY_EXTENT * 0.45,
    CITY_EXTENT * 1.05,
    vec2(x, z).length().add(ragged)
  )
  // It writes depth, transparent as it is: the air before it ends at the street.
  const material = new MeshStandardNodeMaterial({ transparent: true })
  material.colorNode = mix(surface, color('#c9c7bd'), lines).mul(grain.mul(0.5).add(0.75))
  material.opacityNode = outside.oneMinus()
  material.roughnessNode = float(0.9)
  // Pools of light, 26 m apart along the lanes.
  const pool = (x: Node<'float'>): Node<'float'> =>
    sin(x.mul((2 * Math.PI) / 26))
      .mul(0.5)
      .add(0.5)
      .pow(2)
  const lamps = mix(pool(x), pool(z), crossing.oneMinus()).mul(0.8).add(0.2)
  material.emissiveNode = color('#ffc687').mul(street.mul(lamps).mul(LIT.lane)).mul(scale)
  return material
}

/** Leaves, lit by the lamps below them. */
function leafMaterial(noise: DataTexture, scale: Node<'float'>): MeshStandardNodeMaterial {
  const green = color('#3f5a2c')
  const material = new MeshStandardNodeMaterial({ roughness: 0.9 })
  const { y } = positionLocal
  // From three sides: none is drawn out.
  const from = [positionLocal.xy, positionLocal.yz, positionLocal.zx]
  const [a, b, c] = from.map(place => texture(noise, place.div(2.3)).r)
  const clumps = a.add(b).add(c).div(3).sub(0.5).mul(1.7).add(0.5).clamp(0, 1).toVar()
  material.colorNode = green.mul(clumps.mul(0.8).add(0.5))
  const below = y.div(-LAMPLIGHT).exp().mul(normalLocal.y.mul(-0.4).add(0.6))
  const lamplight = below.mul(clumps.mul(clumps)).mul(4 * LIT.leaves)
  material.emissiveNode = color('#3f4411').mul(lamplight).mul(scale) // of green leaves
  return material
}

/** A crown of leaves: a sphere pushed in and out, so that it does not look turned on a lathe. */
function crownGeometry(): BufferGeometry {
  const geometry = new IcosahedronGeometry(2.1, 1)
  const { position, normal } = geometry.attributes
  const vertex = new Vector3()
  for (let i = 0; i < position.count; i++) {
    vertex.fromBufferAttribute(position, i)
    normal.setXYZ(i, ...vertex.clone().normalize().toArray())
    const bumps =
      Math.sin(vertex.x * 2.1 + 1) * Math.sin(vertex.y * 1.9) * Math.sin(vertex.z * 2.3 + 2)
    vertex.multiplyScalar(1 + bumps * 0.25)
    position.setXYZ(i, vertex.x, vertex.y * 1.15, vertex.z)
  }
  return geometry
}

function plant(
  geometry: BufferGeometry,
  material: MeshStandardNodeMaterial,
  points: Point[],
  y: number
): InstancedMesh {
  const mesh = new InstancedMesh(geometry, material, points.length)
  const random = randomSequence(7)
  const matrix = new Matrix4()
  const scale = new Vector3()
  points.forEach(({ x, z }, i) => {
    const size = 0.8 + random() * 0.5
    matrix
      .makeRotationY(random() * Math.PI * 2)
      .scale(scale.setScalar(size))
      .setPosition(x, y * size, z)
    mesh.setMatrixAt(i, matrix)
  })
  mesh.castShadow = true
  mesh.receiveShadow = true
  return mesh
}

/** Distance from walls that one keeps, whose near plane is a metre away [m]. */
const BODY = 1.6

export interface City {
  /** Position in ECEF [m]. */
  object: Group
  /** `luminanceScale` of the atmosphere, for lit windows and lanes. */
  scale: { value: number }
  /** Height of the roof over the ground at a position of the world; −∞ in streets [m]. */
  roofAt(position: Vector3): number
  dispose(): void
}

/** A made-up district of boxes and streets, for scale: the imagery knows nothing smaller than 20 km. */
export function createCity(noise: DataTexture): City {
  const scale = uniform(1e-4)
  const originECEF = Ellipsoid.WGS84.geodeticToECEF({ ...CITY, height: GROUND_HEIGHT })
  const object = new Group()
  const streets = new Group()
  object.add(streets)
  Ellipsoid.WGS84.localYUpFrame(originECEF, object.matrix).decompose(
    object.position,
    object.quaternion,
    object.scale
  )
  streets.rotation.y = -PLACES.street.heading * MathUtils.DEG2RAD

  const { geometry, trees, obstacles } = createBuildings()
  const roofs = topOf(obstacles, BODY)
  const place = new Vector3()
  const buildings = new Mesh(geometry, facadeMaterial(scale))
  buildings.castShadow = true
  buildings.receiveShadow = true

  const ground = new Mesh(
    new PlaneGeometry(CITY_EXTENT * 2.2, CITY_EXTENT * 2.2).rotateX(-Math.PI / 2),
    streetMaterial(noise, scale)
  )
  ground.receiveShadow = true

  const leaves = leafMaterial(noise, scale)
  const bark = new MeshStandardNodeMaterial({ color: '#4a3b2e', roughness: 0.95 })
  const crowns = plant(crownGeometry(), leaves, trees, 5)
  const trunks = plant(new CylinderGeometry(0.13, 0.18, 4, 6), bark, trees, 2)
  const meshes = [buildings, ground, crowns, trunks]
  streets.add(...meshes)

  return {
    object,
    scale,
    roofAt(position) {
      streets.updateWorldMatrix(true, false)
      return roofs(streets.worldToLocal(place.copy(position)))
    },
    dispose() {
      for (const { geometry: shape, material } of meshes) {
        shape.dispose()
        ;(material as MeshStandardNodeMaterial).dispose()
      }
      crowns.dispose()
      trunks.dispose()
    }
  }
}

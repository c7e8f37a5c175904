import { BufferAttribute, BufferGeometry, Mesh, Vector3 } from 'three'
import {
  Fn,
  attribute,
  dFdx,
  dFdy,
  float,
  normalGeometry,
  positionGeometry,
  transformNormalToView,
  vec3
} from 'three/tsl'
import { checkRange, numberUniform, vector3Uniform } from '@welkin/atmosphere'
import { checkFinite, checkOptions, checkPositive, fail } from '@welkin/geo'
import type { HeightSample } from '../heights/HeightSource'
import { sampleGround } from '../heights/sampleGround'
import { REFERENCE_STEP } from '../noise/tsl/latticeNoise'
import type { GroundMesh } from '../rays/GroundMesh'
import { figureOf, isFlat, worldToGround } from '../tiles/cpu/figure'
import type { Float, Vec3 } from '../tsl-types'
import { GroundMaterial, viewDirection } from './GroundMaterial'
import { seaSlopeVariance } from './seaWaves'
import { seaSurface, waterColor, waterFresnel } from './tsl/seaSurface'
import { WaterMirrorNode } from './WaterMirrorNode'

/** Rings of the disc, and places on each. */
const RINGS = 64
const PLACES = 96

/** Reflectance of the bed near the shore, wet gravel and silt, linear sRGB. */
const BED = [0.075, 0.078, 0.056] as const

/** Depth of water for the waves, which have no shore here [m]. */
const DEEP = 1000

/** Time between two looks at the bed while heights arrive [ms]. */
const PATIENCE = 1000

/** Lake: water at a level of its own on a terrain. */
export interface LakeOptions {
  /** Place in its middle, east of the prime meridian [°]. */
  longitude: number
  /** Geodetic latitude of the middle, in [−90, 90] [°]. */
  latitude: number
  /** Distance from the middle within which ground below the level is under water, in (0, 100,000] [m]. */
  radius: number
  /** Surface of the water above the ellipsoid [m]. */
  level: number
}

const sample: HeightSample = { height: 0, gradient: new Vector3() }
const place = new Vector3()
const up = new Vector3()

/**
 * Water of a lake over a terrain's ground: as the sea is, with its waves, sky and glint by the terrain's wind, at a level of its own.
 *
 * ```ts
 * scene.add(new Lake(terrain, { longitude: 8.7, latitude: 47.22, radius: 15_000, level: 406 }))
 * ```
 *
 * It is a disc that bends with the planet; the shore is where ground stands out of it. Lakes of another shape are several discs of one level.
 */
export class Lake extends Mesh<BufferGeometry, GroundMaterial> {
  /** Ground below; shared, not owned. */
  readonly terrain: GroundMesh
  /** Surface of the water above the ellipsoid [m]. */
  readonly level: number
  /** Middle of the surface, ECEF [m]. */
  readonly center: Vector3
  readonly #radius: number
  readonly #variance = numberUniform()
  readonly #seconds = numberUniform()
  #version = -1
  #looked = -Infinity

  /** @throws If an option is missing, unknown or out of its range, or the world is flat. */
  constructor(terrain: GroundMesh, options: LakeOptions) {
    checkOptions('Lake', options, 'longitude', 'latitude', 'radius', 'level')
    const { longitude, latitude, radius, level } = options
    const { ellipsoid } = terrain.atmosphere
    if (isFlat(figureOf(terrain.atmosphere))) fail('Lake', 'needs a globe')
    checkFinite('Lake', 'longitude', longitude)
    checkRange('Lake', 'latitude', latitude, -90, 90)
    checkPositive('Lake', 'radius', radius)
    checkRange('Lake', 'radius', radius, 0, 1e5)
    checkFinite('Lake', 'level', level)
    const center = ellipsoid.geodeticToECEF({ longitude, latitude, height: level })
    super(discAt(center, level, radius, terrain), new GroundMaterial())
    this.terrain = terrain
    this.level = level
    this.center = center
    this.#radius = radius
    terrain.lakes.push(this)
    this.name = 'Lake'
    this.frustumCulled = false
    this.receiveShadow = terrain.receiveShadow
    this.matrixAutoUpdate = this.matrixWorldAutoUpdate = false
    this.#setMaterial()
    this.#update()
  }

  #setMaterial(): void {
    const { material, center } = this
    material.name = 'Welkin.Lake'
    material.metalness = 0
    // Cells are not small beside the distance of a viewer on the shore.
    Object.assign(material, { airAtVertices: undefined })
    const turns = vector3Uniform()
    for (const axis of ['x', 'y', 'z'] as const) {
      turns.value[axis] = center[axis] % REFERENCE_STEP
    }
    const offset = (positionGeometry as unknown as Vec3).add(turns).toConst() as Vec3
    const zenith = (normalGeometry as unknown as Vec3).normalize().toConst() as Vec3
    const footprint = (dFdx(offset) as unknown as Vec3)
      .length()
      .max((dFdy(offset) as unknown as Vec3).length())
      .toConst() as Float
    const water = { offset, depth: float(DEEP), up: zenith, footprint, spread: float(0) }
    const { slope, variance } = seaSurface(water, this.#variance, this.#seconds)
    const normal = (transformNormalToView(zenith.sub(slope)) as unknown as Vec3).toConst() as Vec3
    const depth = attribute('depth', 'float') as unknown as Float
    material.colorNode = Fn(() => {
      const cosViewer = normal.dot(viewDirection()).max(0)
      const entering = waterFresnel(cosViewer, variance).oneMinus()
      return waterColor(vec3(...BED), depth).mul(entering)
    })()
    material.normalNode = normal
    material.roughnessNode = variance.sqrt().sqrt()
    material.water = float(1)
    const { atmosphere } = this.terrain
    material.emissiveNode = new WaterMirrorNode(atmosphere, { cover: float(1), normal, variance })
  }

  /** Follows the world, the wind, and heights that have arrived. */
  #update(): void {
    const { terrain } = this
    const { atmosphere, version } = terrain
    this.matrixWorld
      .copy(worldToGround(atmosphere))
      .invert()
      .multiply(this.matrix.makeTranslation(this.center))
    this.matrix.copy(this.matrixWorld)
    this.#variance.value = seaSlopeVariance(terrain.windSpeed)
    this.#seconds.value = terrain.waveTime
    const now = performance.now()
    if (version === this.#version || now - this.#looked < PATIENCE) return
    this.#version = version
    this.#looked = now
    const { position, depth } = this.geometry.attributes
    for (let i = 0; i < depth.count; i++) {
      place.fromBufferAttribute(position, i).add(this.center)
      atmosphere.ellipsoid.footPoint(place, place)
      depth.setX(i, this.level - sampleGround(terrain.source, place, sample).height)
    }
    depth.needsUpdate = true
  }

  /** True within its circle. @param subpoint - On the ellipsoid, ECEF [m]. */
  covers(subpoint: Vector3): boolean {
    const { center } = this
    if (subpoint.dot(center) < 0) return false
    this.terrain.atmosphere.ellipsoid.surfaceNormal(center, up)
    // Along the plane that touches the middle, as the disc was made.
    const away = place.subVectors(subpoint, center)
    return away.addScaledVector(up, -away.dot(up)).length() <= this.#radius
  }

  override onBeforeRender(): void {
    this.#update()
  }

  /** Frees geometry and material and leaves the terrain, which is shared. */
  override dispose(): void {
    const { lakes } = this.terrain
    lakes.splice(lakes.indexOf(this), lakes.includes(this) ? 1 : 0)
    this.geometry.dispose()
    this.material.dispose()
  }
}

/** Disc on the ellipsoid, as differences to its middle, ECEF axes; with normals along geodetic up, and room for depths. */
function discAt(
  center: Vector3,
  level: number,
  radius: number,
  { atmosphere: { ellipsoid } }: GroundMesh
): BufferGeometry {
  const count = 1 + RINGS * PLACES
  const positions = new Float32Array(3 * count)
  const normals = new Float32Array(3 * count)
  const zenith = ellipsoid.surfaceNormal(center, new Vector3())
  // East, but at a pole, where any way is.
  const east = new Vector3(0, 1e-9, 1).cross(zenith).normalize()
  const north = new Vector3().crossVectors(zenith, east)
  for (let i = 0; i < count; i++) {
    const ring = Math.ceil(i / PLACES)
    const angle = (2 * Math.PI * i) / PLACES
    const away = (radius * ring) / RINGS
    place.copy(center)
    place
      .addScaledVector(east, away * Math.cos(angle))
      .addScaledVector(north, away * Math.sin(angle))
    ellipsoid.footPoint(place, place)
    ellipsoid.surfaceNormal(place, up).toArray(normals, 3 * i)
    place
      .addScaledVector(up, level)
      .sub(center)
      .toArray(positions, 3 * i)
  }
  const index: number[] = []
  for (let ring = 0; ring < RINGS; ring++) {
    for (let n = 0; n < PLACES; n++) {
      const next = (n + 1) % PLACES
      const [a, b] = [n, next].map(each => 1 + ring * PLACES + each)
      if (ring === 0) {
        index.push(0, a, b)
        continue
      }
      const [c, d] = [a - PLACES, b - PLACES]
      index.push(c, a, b, c, b, d)
    }
  }
  const geometry = new BufferGeometry()
  geometry.name = 'Welkin.Lake'
  geometry.setAttribute('position', new BufferAttribute(positions, 3))
  geometry.setAttribute('normal', new BufferAttribute(normals, 3))
  geometry.setAttribute('depth', new BufferAttribute(new Float32Array(count), 1))
  return geometry.setIndex(index)
}

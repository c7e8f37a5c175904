import { Mesh, Vector3 } from 'three'
import type { InstancedBufferGeometry, Intersection, Raycaster } from 'three'
import type { MeshStandardNodeMaterial } from 'three/webgpu'
import { checkRange, type Atmosphere } from '@welkin/atmosphere'
import { checkDirection, checkFinite, checkVector, fail } from '@welkin/geo'
import type { HeightSample, HeightSource } from '../heights/HeightSource'
import { sampleGround } from '../heights/sampleGround'
import type { PageSource } from '../pages/PageSource'
import { seaSlopeVariance } from '../surface/seaWaves'
import type { TerrainUniforms } from '../TerrainUniforms'
import { figureOf, isFlat, worldToGround } from '../tiles/cpu/figure'
import { distanceToGround } from './distanceToGround'
import { groundNormal, waterLevel, type GroundWater } from './Ground'
import { raycastGround } from './raycastGround'

/** Level of "no sea", below all ground [m]. */
const NO_SEA = -1e9

const subpoint = new Vector3()
const along = new Vector3()
const sample: HeightSample = { height: 0, gradient: new Vector3() }

/** Mesh of ground and sea that answers questions about its surface, in float64 on the CPU. */
export abstract class GroundMesh extends Mesh<InstancedBufferGeometry, MeshStandardNodeMaterial> {
  /** Shared, not owned. */
  declare readonly atmosphere: Atmosphere
  /** Heights of the ground; shared, not owned. */
  declare readonly source: HeightSource | PageSource
  /** Lakes on it: each adds itself, and leaves when it is disposed of. */
  readonly lakes: GroundWater[] = []

  readonly #sea: Pick<TerrainUniforms, 'seaLevel' | 'seaVariance' | 'waveTime'>
  #seaLevel = 0
  #windSpeed = 0

  constructor(
    geometry: InstancedBufferGeometry,
    material: MeshStandardNodeMaterial,
    uniforms: TerrainUniforms
  ) {
    super(geometry, material)
    this.#sea = uniforms
  }

  /** Surface of the sea above the ellipsoid [m]; −Infinity for none. */
  get seaLevel(): number {
    return this.#seaLevel
  }

  set seaLevel(value: number) {
    if (value !== -Infinity) checkRange('Terrain', 'seaLevel', value, -1e5, 1e5)
    this.#seaLevel = value
    this.#sea.seaLevel.value = Math.max(value, NO_SEA)
  }

  /** Wind over the sea, in [0, 40] [m/s]. */
  get windSpeed(): number {
    return this.#windSpeed
  }

  set windSpeed(value: number) {
    checkRange('Terrain', 'windSpeed', value, 0, 40)
    this.#windSpeed = value
    this.#sea.seaVariance.value = seaSlopeVariance(value)
  }

  /** Time of the sea's waves [s]. */
  get waveTime(): number {
    return this.#sea.waveTime.value
  }

  set waveTime(value: number) {
    checkFinite('Terrain', 'waveTime', value)
    this.#sea.waveTime.value = value
  }

  /** Counts up whenever heights of the ground have changed, as when some have arrived. */
  get version(): number {
    return this.source.version ?? 0
  }

  /**
   * Height of the ground, or of the sea or a lake over it, above the ellipsoid: that of the surface as drawn about a
   * viewer who stands there [m].
   *
   * @param longitude - East of the prime meridian [°].
   * @param latitude - Geodetic, in [−90, 90] [°].
   * @throws If one is not finite or out of its range, or the world is flat: ask `heightBelow` there.
   */
  heightAt(longitude: number, latitude: number): number {
    return this.surfaceAt(this.#subpointAt('heightAt', longitude, latitude))
  }

  /**
   * Unit normal of the surface in ECEF: that of a pixel near the viewer, without stones and tufts.
   *
   * @param longitude - East of the prime meridian [°].
   * @param latitude - Geodetic, in [−90, 90] [°].
   * @throws If one is not finite or out of its range, or the world is flat: ask `normalBelow` there.
   */
  normalAt(longitude: number, latitude: number, target: Vector3 = new Vector3()): Vector3 {
    const position = this.#subpointAt('normalAt', longitude, latitude)
    return groundNormal(this, position, target)
  }

  /**
   * Unit normal of the surface below a point of the world, as `normalAt` has it: in ECEF, in a flat world along the world's axes.
   *
   * @param position - World [units].
   * @throws If a component is not finite.
   */
  normalBelow(position: Vector3, target: Vector3 = new Vector3()): Vector3 {
    return groundNormal(this, this.#subpointBelow('normalBelow', position), target)
  }

  /**
   * Height of the surface below a point of the world, above the ellipsoid [m].
   *
   * @param position - World [units].
   * @throws If a component is not finite.
   */
  heightBelow(position: Vector3): number {
    return this.surfaceAt(this.#subpointBelow('heightBelow', position))
  }

  #subpointBelow(method: string, position: Vector3): Vector3 {
    checkVector(`Terrain.${method}`, 'position', position)
    subpoint.copy(position).applyMatrix4(worldToGround(this.atmosphere))
    return figureOf(this.atmosphere).footPoint(subpoint, subpoint)
  }

  #subpointAt(method: string, longitude: number, latitude: number): Vector3 {
    checkFinite(`Terrain.${method}`, 'longitude', longitude)
    checkRange(`Terrain.${method}`, 'latitude', latitude, -90, 90)
    if (isFlat(figureOf(this.atmosphere)))
      fail(`Terrain.${method}`, `use ${method.replace('At', 'Below')} in a flat world`)
    return this.atmosphere.ellipsoid.geodeticToECEF({ longitude, latitude }, subpoint)
  }

  /** Height of the surface at a point of the ellipsoid [m]. */
  protected surfaceAt(position: Vector3): number {
    return Math.max(sampleGround(this.source, position, sample).height, waterLevel(this, position))
  }

  /**
   * Point where a ray enters the ground, the sea or a lake, with all detail that the source has.
   *
   * @param originECEF - Start of the ray [m]; in a flat world along the world's axes, as is the result.
   * @param directionECEF - Any length but 0.
   * @returns ECEF [m], or null if the ray misses.
   * @throws If a component is not finite or the direction is zero.
   */
  intersectRay(
    originECEF: Vector3,
    directionECEF: Vector3,
    target: Vector3 = new Vector3()
  ): Vector3 | null {
    checkVector('Terrain.intersectRay', 'originECEF', originECEF)
    checkDirection('Terrain.intersectRay', 'directionECEF', directionECEF)
    along.copy(directionECEF).normalize()
    const distance = distanceToGround(this, originECEF, along, 0, Infinity)
    return distance === null ? null : target.copy(originECEF).addScaledVector(along, distance)
  }

  /**
   * Hit of a ray of three's `Raycaster` on the ground, the sea or a lake: to 1 mm, wherever the camera is. Its normal is in the
   * terrain's own axes, those of ECEF; it has no face.
   */
  override raycast(raycaster: Raycaster, intersects: Intersection[]): void {
    raycastGround(this, raycaster, intersects)
  }
}

import { Mesh } from 'three'
import type { InstancedBufferGeometry } from 'three'
import type { MeshStandardNodeMaterial } from 'three/webgpu'
import { checkRange } from '@welkin/atmosphere'
import { checkFinite } from '@welkin/geo'
import type { TerrainUniforms } from '../TerrainUniforms'
import { seaSlopeVariance } from './seaWaves'

/** Level of "no sea", below all ground [m]. */
const NO_SEA = -1e9

/** Mesh with a sea: its level, and its waves. */
export abstract class SeaMesh extends Mesh<InstancedBufferGeometry, MeshStandardNodeMaterial> {
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
}

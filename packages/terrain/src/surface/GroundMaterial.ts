import { airAtVertices } from '@welkin/atmosphere'
import { mix, specularColor, specularColorBlended, vec3 } from 'three/tsl'
import { MeshStandardNodeMaterial } from 'three/webgpu'
import type { Float, Vec3 } from '../tsl-types'
import { WATER_FRESNEL } from './tsl/seaSurface'

/** Reflectance of ground at normal incidence: that of three's standard materials. */
const GROUND_FRESNEL = 0.04

type Variable = Vec3 & { assign(value: Vec3): void }

/** Standard material of ground and water: highlights on water are those of water, half as bright as of other things. */
export class GroundMaterial extends MeshStandardNodeMaterial {
  static override get type(): string {
    return 'GroundMaterial'
  }

  /** See `FineMaterial` of `@welkin/atmosphere`: cells are small beside their distance. */
  readonly airAtVertices = airAtVertices

  /** Share of a pixel that is water; null for none. */
  water: Float | null = null

  override setupSpecular(): void {
    super.setupSpecular()
    if (this.water === null) return
    const reflectance = vec3(mix(GROUND_FRESNEL, WATER_FRESNEL, this.water))
    for (const color of [specularColor, specularColorBlended]) {
      ;(color as unknown as Variable).assign(reflectance)
    }
  }
}

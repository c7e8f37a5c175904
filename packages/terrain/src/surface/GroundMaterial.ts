import { airAtVertices } from '@welkin/atmosphere'
import { diffuseColor, mix, normalView, specularColor, specularColorBlended, vec3 } from 'three/tsl'
import {
  MeshStandardNodeMaterial,
  PhysicalLightingModel,
  type LightingModelDirectInput,
  type NodeBuilder
} from 'three/webgpu'
import type { Float, Vec3 } from '../tsl-types'
import { bouncedLight } from './tsl/bouncedLight'
import { WATER_FRESNEL } from './tsl/seaSurface'

/** Reflectance of ground at normal incidence: that of three's standard materials. */
const GROUND_FRESNEL = 0.04

type Variable = Vec3 & { assign(value: Vec3): void; addAssign(value: Vec3): void }

/** Part of the context of three's lights that is used. */
interface LightingContext {
  readonly ambientOcclusion: Float
  readonly reflectedLight: { readonly indirectDiffuse: Variable }
}

/** Light as of three's standard materials, and what the sides of hollows throw at each other of the sun's light and the sky's. */
class GroundLightingModel extends PhysicalLightingModel {
  /** Irradiance of the ground about a pixel by lights that have a direction. */
  #sunlight: Variable | null = null

  /** @param ground - Normal of the ground without its stones, in the view. */
  constructor(readonly ground: Vec3) {
    super()
  }

  override start(builder: NodeBuilder): void {
    this.#sunlight = vec3(0).toVar('sunlightOnGround') as unknown as Variable
    super.start(builder)
  }

  override direct(light: LightingModelDirectInput, builder: NodeBuilder): void {
    const color = light.lightColor as Vec3
    const cosine = this.ground.dot(light.lightDirection as Vec3).max(0) as unknown as Float
    this.#sunlight?.addAssign(color.mul(cosine))
    super.direct(light, builder)
  }

  override ambientOcclusion(builder: NodeBuilder): void {
    const { ambientOcclusion, reflectedLight } = builder.context as LightingContext
    const albedo = (diffuseColor as unknown as { rgb: Vec3 }).rgb
    const factor = bouncedLight(albedo, ambientOcclusion).toConst('bounced') as unknown as Vec3
    const { indirectDiffuse } = reflectedLight
    const sun = albedo.mul(this.#sunlight!).mul(factor.sub(1)).div(Math.PI)
    indirectDiffuse.assign(indirectDiffuse.mul(factor).add(sun))
    super.ambientOcclusion(builder)
  }
}

/** Standard material of ground and water: highlights on water are those of water, half as bright as of other things. */
export class GroundMaterial extends MeshStandardNodeMaterial {
  static override get type(): string {
    return 'GroundMaterial'
  }

  /** See `FineMaterial` of `@welkin/atmosphere`: cells are small beside their distance. */
  readonly airAtVertices = airAtVertices

  /** Normal of the ground without its stones, in the view; null for the normal of the pixel. */
  ground: Vec3 | null = null

  /** Share of a pixel that is water; null for none. */
  water: Float | null = null

  override setupLightingModel(): GroundLightingModel {
    return new GroundLightingModel(this.ground ?? normalView)
  }

  override setupSpecular(): void {
    super.setupSpecular()
    if (this.water === null) return
    const reflectance = vec3(mix(GROUND_FRESNEL, WATER_FRESNEL, this.water))
    for (const color of [specularColor, specularColorBlended]) {
      ;(color as unknown as Variable).assign(reflectance)
    }
  }
}

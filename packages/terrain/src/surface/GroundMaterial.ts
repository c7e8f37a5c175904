import { airAtVertices, coveredPosition } from '@welkin/atmosphere'
import {
  Fn,
  float,
  diffuseColor,
  mix,
  normalView,
  roughness,
  specularColor,
  specularColorBlended,
  vec3
} from 'three/tsl'
import {
  MeshStandardNodeMaterial,
  PhysicalLightingModel,
  type LightingModelDirectInput,
  type NodeBuilder
} from 'three/webgpu'
import type { Float, Variable, Vec3 } from '../tsl-types'
import { bouncedLight } from './tsl/bouncedLight'
import { WATER_FRESNEL } from './tsl/seaSurface'

/** Reflectance of ground at normal incidence: that of three's standard materials. */
const GROUND_FRESNEL = 0.04

/** Unit vector to the viewer, in view space; three's own would be one more varying. */
export const viewDirection = (): Vec3 =>
  Fn(({ camera }: NodeBuilder) =>
    (camera as unknown as { isOrthographicCamera?: boolean }).isOrthographicCamera
      ? vec3(0, 0, 1)
      : coveredPosition().negate().normalize()
  )().toConst()

/** Part of the context of three's lights that is used. */
interface LightingContext {
  readonly ambientOcclusion: Float
  readonly irradiance: Vec3
  readonly reflectedLight: { readonly indirectDiffuse: Variable<Vec3> }
}

/** Diffuse albedo. */
const albedo = (): Vec3 => (diffuseColor as unknown as { rgb: Vec3 }).rgb

/** Part of three's builder that is used. */
interface LightsBuilder {
  readonly environmentNode: unknown
  readonly material: { readonly envNode: unknown; readonly envMap: unknown }
  readonly lightsNode: {
    getLightNodes(builder: NodeBuilder): unknown
    setupLights(builder: NodeBuilder, nodes: unknown): void
  }
}

/** Reflected light of three's lights. */
interface ReflectedLight {
  readonly directDiffuse: Variable<Vec3>
  readonly directSpecular: Variable<Vec3>
  readonly indirectDiffuse: Variable<Vec3>
}

/**
 * Distribution and visibility of GGX's facets, times π: that of both directions correlated, by Hammon's approximation without roots.
 *
 * @see Walter et al. 2007, "Microfacet models for refraction through rough surfaces", eq. 33
 * @see Guy & Agopian 2018, "Physically based rendering in Filament", §4.4.2 "Geometric shadowing (specular V)", after Hammon 2017
 */
function microfacets(
  roughness: Float,
  cosLight: Float,
  cosViewer: Float,
  cosHalfway: Float
): Float {
  const alpha = roughness.mul(roughness).toConst() as Float
  const square = alpha.mul(alpha).toConst() as Float
  const spread = cosHalfway.mul(cosHalfway).mul(square.sub(1)).add(1).toConst() as Float
  const shadowed = mix(cosLight.mul(cosViewer).mul(2), cosLight.add(cosViewer), alpha)
  return square.mul(0.5).div(spread.mul(spread).mul(shadowed).max(1e-9))
}

/**
 * Light of three's standard materials, with interreflection: light of sun and sky that the sides of hollows throw at each other.
 *
 * Where no environment is mirrored, highlights are of single scattering: multiple scattering would add a thousandth of the light on ground,
 * for a look-up and matrices of metals in each pixel.
 */
class GroundLightingModel extends PhysicalLightingModel {
  /** Irradiance of the ground about a pixel by lights that have a direction. */
  #sunlight: Variable<Vec3> | null = null
  #mirrors = false

  /** @param ground - Normal of the ground without its stones, view space. */
  constructor(readonly ground: Vec3) {
    super()
  }

  override start(builder: NodeBuilder): void {
    const { environmentNode, material, lightsNode } = builder as unknown as LightsBuilder
    this.#mirrors = Boolean(environmentNode || material.envNode || material.envMap)
    this.#sunlight = vec3(0).toVar() as unknown as Variable<Vec3>
    if (this.#mirrors) {
      super.start(builder)
      return
    }
    // As all models of light do: every light, then what comes from all sides.
    lightsNode.setupLights(builder, lightsNode.getLightNodes(builder))
    this.indirect(builder)
  }

  override direct(light: LightingModelDirectInput, builder: NodeBuilder): void {
    const color = light.lightColor as Vec3
    const direction = light.lightDirection as Vec3
    this.#sunlight?.addAssign(color.mul(this.ground.dot(direction).max(0) as unknown as Float))
    if (this.#mirrors) {
      super.direct(light, builder)
      return
    }
    const { directDiffuse, directSpecular } = light.reflectedLight as unknown as ReflectedLight
    const toViewer = viewDirection()
    const halfway = direction.add(toViewer).normalize().toConst()
    const [cosLight, cosViewer, cosHalfway] = [direction, toViewer, halfway].map(
      vector => normalView.dot(vector).clamp().toConst() as unknown as Float
    )
    const irradiance = color.mul(cosLight).div(Math.PI).toConst() as Vec3
    const reflectance = specularColor as unknown as Vec3
    // Schlick's fifth power as three has it: by a Gaussian (Lagarde 2012).
    const cosine = toViewer.dot(halfway).clamp().toConst()
    const gain = cosine.mul(-5.55473).sub(6.98316).mul(cosine).exp2().toConst() as Float
    const entering = reflectance.oneMinus().mul(gain.oneMinus())
    directDiffuse.addAssign(irradiance.mul(albedo().mul(entering)))
    directSpecular.addAssign(
      irradiance
        .mul(mix(reflectance, vec3(1), gain))
        .mul(microfacets(roughness, cosLight, cosViewer, cosHalfway))
    )
  }

  override indirect(builder: NodeBuilder): void {
    if (this.#mirrors) {
      super.indirect(builder)
      return
    }
    const { irradiance, reflectedLight } = builder.context as LightingContext
    const entering = (specularColor as unknown as Vec3).oneMinus()
    reflectedLight.indirectDiffuse.addAssign(irradiance.mul(albedo().mul(entering)).div(Math.PI))
    this.ambientOcclusion(builder)
  }

  override ambientOcclusion(builder: NodeBuilder): void {
    const { ambientOcclusion, reflectedLight } = builder.context as LightingContext
    const factor = bouncedLight(albedo(), ambientOcclusion).toConst() as unknown as Vec3
    const { indirectDiffuse } = reflectedLight
    const sun = albedo().mul(this.#sunlight!).mul(factor.sub(1)).div(Math.PI)
    indirectDiffuse.assign(indirectDiffuse.mul(factor).add(sun))
    if (this.#mirrors) super.ambientOcclusion(builder)
    else indirectDiffuse.assign(indirectDiffuse.mul(ambientOcclusion))
  }
}

/** Standard material of ground and water: highlights on water are those of water, half as bright as of other things. */
export class GroundMaterial extends MeshStandardNodeMaterial {
  static override get type(): string {
    return 'GroundMaterial'
  }

  /** See `FineMaterial` of `@welkin/atmosphere`: cells are small beside their distance. */
  readonly airAtVertices = airAtVertices

  /** Normal of the ground without its stones, view space. */
  ground = normalView as Vec3

  /** Share of a pixel that is water. */
  water = float(0) as Float

  override setupLightingModel(): GroundLightingModel {
    return new GroundLightingModel(this.ground)
  }

  override setupSpecular(): void {
    super.setupSpecular()
    const reflectance = vec3(mix(GROUND_FRESNEL, WATER_FRESNEL, this.water))
    for (const color of [specularColor, specularColorBlended]) {
      ;(color as unknown as Variable<Vec3>).assign(reflectance)
    }
  }
}

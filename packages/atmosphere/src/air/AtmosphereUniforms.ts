import type { Vector3 } from 'three'
import type { UniformNode } from 'three/webgpu'
import {
  spectrumOf,
  type AtmosphereParameters,
  type Spectrum
} from '../parameters/AtmosphereParameters'
import { number, vector3, vector4 } from '../uniforms'
import { homogeneousHeight } from './cpu/medium'
import { asymmetryMoments, cornetteShanksFactor } from './cpu/phase'
import { linearSRGBColumns, whiteBalancedColumns } from './cpu/color'

const columns = (): UniformNode<'vec3', Vector3>[] => [0, 1, 2, 3].map(vector3)

/**
 * The parameters of an atmosphere as shader uniforms: changing a parameter recompiles nothing.
 * Field names and units are those of {@link AtmosphereParameters}.
 */
export class AtmosphereUniforms {
  readonly bottomRadius = number()
  /** Thickness of the air [m]. */
  readonly thickness = number()
  readonly rayleighScattering = vector4()
  readonly rayleighScaleHeight = number()
  /** Altitudes where the layers above the lowest begin [m]. */
  readonly rayleighLayerBases = vector3()
  /** 1/H of those layers less that of the layer below; 0 for unused layers [1/m]. */
  readonly rayleighLayerSlopes = vector3()
  /** Height of the homogeneous atmosphere of molecules [m]. */
  readonly homogeneousHeight = number()
  readonly mieScattering = vector4()
  readonly mieExtinction = vector4()
  readonly mieScaleHeight = number()
  readonly mieAsymmetry = vector4()
  /** 1 if the asymmetry is the same at the four wavelengths, else 0. */
  readonly mieIsGrey = number()
  /** 3/(8π) (1 − g²)/(2 + g²), what is constant in the Cornette–Shanks phase function [1/sr]. */
  readonly miePhaseFactor = vector4()
  /** χ₁ and χ₂, first Legendre coefficients of the aerosols' phase function. */
  readonly mieMoment1 = vector4()
  readonly mieMoment2 = vector4()
  readonly absorptionExtinction = vector4()
  readonly absorptionAltitude = number()
  readonly absorptionHalfWidth = number()
  readonly groundAlbedo = vector4()
  readonly sunAngularRadius = number()
  readonly limbDarkening = vector4()
  /** Columns of the matrix from radiance per unit of solar irradiance [1/sr] to scaled linear sRGB. */
  readonly linearSRGB = columns()
  /** Columns of the matrix from spectral transmittance to that of sunlight seen as linear sRGB. */
  readonly transmittanceRGB = columns()

  /**
   * Copies the parameters.
   *
   * @param luminanceScale - Output per luminance [1/(cd/m²)].
   */
  update(parameters: AtmosphereParameters, luminanceScale: number): void {
    for (const [name, node] of Object.entries(this)) {
      if (name === 'mieAsymmetry') continue
      const value = parameters[name as keyof AtmosphereParameters]
      if (typeof value === 'number') node.value = value
      else if (value !== undefined) node.value.set(...(value as Spectrum))
    }
    this.thickness.value = parameters.topRadius - parameters.bottomRadius
    this.homogeneousHeight.value = homogeneousHeight(parameters)
    let slope = 1 / parameters.rayleighScaleHeight
    for (let i = 0; i < 3; i++) {
      const layer = parameters.rayleighLayers[i]
      const next = layer ? 1 / layer[1] : slope
      this.rayleighLayerBases.value.setComponent(i, layer ? layer[0] : 0)
      this.rayleighLayerSlopes.value.setComponent(i, next - slope)
      slope = next
    }
    const asymmetries = spectrumOf(parameters.mieAsymmetry)
    this.mieIsGrey.value = Number(new Set(asymmetries).size === 1)
    const moments = asymmetries.map(asymmetryMoments)
    this.mieAsymmetry.value.fromArray(asymmetries)
    this.miePhaseFactor.value.fromArray(asymmetries.map(cornetteShanksFactor))
    this.mieMoment1.value.fromArray(moments.map(([, first]) => first))
    this.mieMoment2.value.fromArray(moments.map(([, , second]) => second))
    const linearSRGB = linearSRGBColumns(parameters, luminanceScale)
    this.linearSRGB.forEach((node, i) => node.value.fromArray(linearSRGB[i]))
    const balanced = whiteBalancedColumns(parameters)
    this.transmittanceRGB.forEach((node, i) => node.value.fromArray(balanced[i]))
  }
}

import { Vector3, Vector4 } from 'three'
import { renderGroup, uniform } from 'three/tsl'
import type { UniformNode } from 'three/webgpu'
import {
  spectrumOf,
  type AtmosphereParameters,
  type Spectrum
} from '../parameters/AtmosphereParameters'
import { homogeneousHeight } from './cpu/medium'
import { asymmetryMoments, cornetteShanksFactor } from './cpu/phase'
import { linearSRGBColumns, whiteBalancedColumns } from './cpu/color'

const number = (): UniformNode<'float', number> => uniform(0).setGroup(renderGroup)
const spectrum = (): UniformNode<'vec4', Vector4> => uniform(new Vector4()).setGroup(renderGroup)
const triple = (): UniformNode<'vec3', Vector3> => uniform(new Vector3()).setGroup(renderGroup)
const columns = (): UniformNode<'vec3', Vector3>[] => [0, 1, 2, 3].map(triple)

/**
 * The parameters of an atmosphere as shader uniforms: changing a parameter recompiles nothing.
 * Field names and units are those of {@link AtmosphereParameters}.
 */
export class AtmosphereUniforms {
  readonly bottomRadius = number()
  /** Thickness of the air [m]. */
  readonly thickness = number()
  readonly rayleighScattering = spectrum()
  readonly rayleighScaleHeight = number()
  /** Altitudes where the layers above the lowest begin [m]. */
  readonly rayleighLayerBases = triple()
  /** 1/H of those layers less that of the layer below; 0 for layers that there are not [1/m]. */
  readonly rayleighLayerSlopes = triple()
  /** Height of the homogeneous atmosphere of molecules [m]. */
  readonly homogeneousHeight = number()
  readonly mieScattering = spectrum()
  readonly mieExtinction = spectrum()
  readonly mieScaleHeight = number()
  readonly mieAsymmetry = spectrum()
  /** 1 if the asymmetry is the same at the four wavelengths, else 0. */
  readonly mieIsGrey = number()
  /** 3/(8π) (1 − g²)/(2 + g²), what is constant in the Cornette–Shanks phase function [1/sr]. */
  readonly miePhaseFactor = spectrum()
  /** χ₁ and χ₂, first Legendre coefficients of the aerosols' phase function. */
  readonly mieMoment1 = spectrum()
  readonly mieMoment2 = spectrum()
  readonly absorptionExtinction = spectrum()
  readonly absorptionAltitude = number()
  readonly absorptionHalfWidth = number()
  readonly groundAlbedo = spectrum()
  readonly sunAngularRadius = number()
  readonly limbDarkening = spectrum()
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
    asymmetries.forEach((asymmetry, i) => {
      const [, moment1, moment2] = asymmetryMoments(asymmetry)
      this.mieAsymmetry.value.setComponent(i, asymmetry)
      this.miePhaseFactor.value.setComponent(i, cornetteShanksFactor(asymmetry))
      this.mieMoment1.value.setComponent(i, moment1)
      this.mieMoment2.value.setComponent(i, moment2)
    })
    linearSRGBColumns(parameters, luminanceScale).forEach((column, i) => {
      this.linearSRGB[i].value.set(...column)
    })
    whiteBalancedColumns(parameters).forEach((column, i) => {
      this.transmittanceRGB[i].value.set(...column)
    })
  }
}

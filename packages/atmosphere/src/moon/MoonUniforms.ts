import type { Vector3 } from 'three'
import { Matrix4 } from 'three'
import type { Spectrum } from '../parameters/AtmosphereParameters'
import type { AtmosphereView } from '../view/AtmosphereView'
import type { Flare } from '../halo/Flare'
import { visibleDisc } from '../transmittance/cpu/transmittance'
import { CORONA_LIGHT } from './cpu/eclipse'
import { earthshine, moonIrradiance } from './cpu/moonIrradiance'
import { surfacePhaseFactor } from './cpu/moonPhaseLaw'
import type { MoonGeometry } from './moonGeometry'
import { CORONA_RADII } from './tsl/moonSky'
import { matrix3, number, vector3, vector4 } from '../uniforms'

/** Angle that a pixel of the coarsest picture covers [rad]. */
const MAX_PIXEL_ANGLE = 0.06

const _matrix = new Matrix4()

/** Cosine of an angle, widened by the largest pixel [rad]. */
const cosWidened = (angle: number): number => Math.cos(Math.min(angle + MAX_PIXEL_ANGLE, Math.PI))

/** The moon for one camera, in float64. */
export interface MoonState {
  geometry: MoonGeometry
  /** Camera to moon, world, unit length. */
  directionWorld: Vector3
  /** Angular radius of the disc [rad]. */
  angularRadius: number
  /** Radius of the moon [m]. */
  radius: number
  /** Factor on the moon's light. */
  strength: number
  /** Factor on its earthshine. */
  earthshine: number
  /** Irradiance at the camera above the air, over that of the bare sun. */
  irradiance: Spectrum
}

/** The moon's disc and light as shader uniforms. Directions are in the mapped space, of unit length. */
export class MoonUniforms {
  /** Camera to moon. */
  readonly directionMapped = vector3()
  /** Moon to sun. */
  readonly sunDirectionMapped = vector3()
  /** Mapped space to moon-fixed axes. */
  readonly mappedToMoonFixed = matrix3()
  /** Angular radius of the disc [rad]. */
  readonly angularRadius = number(0)
  /** Radiance of sunlit ground, for a Lommel–Seeliger factor of 1 [1/sr]. */
  readonly sunlit = vector4()
  /** Radiance of the disc in earthshine [1/sr]. */
  readonly earthlit = vector4()
  /** Irradiance by the part of the disc above the horizon, over that of the bare sun: light of the halo. */
  readonly irradiance = vector4()
  /** Cosine of the angle from the sun within which an eclipse or the corona can show. */
  readonly cosNearSun = number(1)
  /** Cosine of the angle from the moon within which its disc or halo can show. */
  readonly cosNearMoon = number(1)
  /** 0 in totality, when the sun's disc is all covered, else 1. */
  readonly sunVisibility = number(1)

  update(view: AtmosphereView, moon: MoonState, halo: Flare): void {
    const { parameters, space } = view.atmosphere
    const { geometry, angularRadius, radius, strength } = moon
    const { distance, phaseAngle } = geometry
    space.direction(moon.directionWorld, this.directionMapped.value)
    // ECEF's axes are the mapped space's, but for 0.3 % of squeezing along them.
    this.sunDirectionMapped.value.copy(geometry.sunDirectionECEF)
    _matrix.makeRotationFromQuaternion(geometry.axes.clone().invert())
    this.mappedToMoonFixed.value.setFromMatrix4(_matrix)
    this.angularRadius.value = angularRadius
    this.sunVisibility.value = view.irradiance[1] < 1.001 * CORONA_LIGHT ? 0 : 1
    // A full disc has the Lommel–Seeliger factor ½ all over: twice the mean gives the irradiance.
    const full = moonIrradiance(0, distance, radius).map(
      value => (value * strength) / (Math.PI * angularRadius ** 2)
    )
    const shine = earthshine(phaseAngle, distance, parameters.bottomRadius)
    const phaseFactor = surfacePhaseFactor(phaseAngle)
    this.sunlit.value.fromArray(full.map(value => 2 * value * phaseFactor))
    this.earthlit.value.fromArray(full.map((value, i) => value * shine[i] * moon.earthshine))
    const cameraRadius = parameters.bottomRadius + Math.max(view.height, 0)
    const visible = visibleDisc(parameters, cameraRadius, view.up.dot(this.directionMapped.value))
    this.irradiance.value.set(...moon.irradiance).multiplyScalar(visible)
    halo.updateMaximumAngle(this.irradiance.value.y > 0)
    this.cosNearSun.value = cosWidened(CORONA_RADII * parameters.sunAngularRadius)
    this.cosNearMoon.value = Math.min(cosWidened(angularRadius), halo.uniforms.cosMaxAngle.value)
  }
}

import { CircleGeometry, Mesh } from 'three'
import {
  cameraPosition,
  Fn,
  positionWorld,
  reflect,
  cos,
  transformNormalToView,
  uniform,
  vec2,
  vec3,
  float
} from 'three/tsl'
import { MeshPhysicalNodeMaterial } from 'three/webgpu'
import { randomSequence } from '../random'

const WAVES = 18
/** Longest and shortest wave [m]. */
const LENGTHS = [6, 0.2] as const
/** Direction of the wind in x and z, and greatest angle by which waves stray from it [rad]. Wider: they cross as a honeycomb. */
const WIND = 1.2
const SPREAD = 1
const GRAVITY = 9.81
/** Wave vectors by which ripples stray from straight lines, so that they form no lattice, and how far [rad/m, m]. */
const STRAY = [
  [0.23, 0.14, 1.1],
  [-0.19, 0.26, 1.1],
  [0.81, -0.47, 0.22],
  [0.52, 0.83, 0.22]
] as const
/** Two texels of the environment, by which to stay clear of the ground below its horizon [rad]. */
const TEXELS = 0.012

export interface Water {
  readonly mesh: Mesh
  /** Mean square slope of the ripples; 0 is a mirror. */
  setSlope(variance: number): void
  /** [s] */
  setTime(seconds: number): void
  dispose(): void
}

/**
 * A disc of water. Ripples are sines about a wind's direction; where one is too short for the pixels its slope
 * goes into the roughness instead, so that distant water mirrors a blurred sky and does not flicker.
 *
 * @param radius - [m]
 */
export function createWater(radius: number): Water {
  const random = randomSequence(7)
  const time = uniform(0)
  const steepness = uniform(1)
  const waves = Array.from({ length: WAVES }, (_, i) => {
    const length = LENGTHS[0] * (LENGTHS[1] / LENGTHS[0]) ** (i / (WAVES - 1))
    const angle = WIND + (random() + random() - 1) * SPREAD
    const k = (2 * Math.PI) / length
    return { k, x: Math.cos(angle) * k, z: Math.sin(angle) * k, phase: random() * 2 * Math.PI }
  })

  const material = new MeshPhysicalNodeMaterial({ color: '#02090c', ior: 1.333, metalness: 0 })

  const ripples = Fn(() => {
    const at = positionWorld.xz.toConst()
    const [dx, dy] = [at.dFdx().toConst(), at.dFdy().toConst()]
    // Where a pixel covers little across and much along the view, what is long counts.
    const footprint = dx.dot(dx).max(dy.dot(dy)).sqrt().toConst()
    const strays = STRAY.map(([x, z, by]) => at.x.mul(x).add(at.y.mul(z)).sin().mul(by))
    const place = at.add(vec2(strays[0].add(strays[2]), strays[1].add(strays[3]))).toConst()
    const slope = vec2(0).toVar()
    const lost = float(0).toVar()
    for (const { k, x, z, phase } of waves) {
      const blur = footprint.mul(k * 0.5)
      const seen = blur.mul(blur).negate().exp().toConst()
      const angle = place.x
        .mul(x)
        .add(place.y.mul(z))
        .sub(time.mul(Math.sqrt(GRAVITY * k)))
        .add(phase)
      slope.addAssign(
        vec2(x / k, z / k)
          .mul(cos(angle))
          .mul(seen)
      )
      lost.addAssign(seen.mul(seen).oneMinus())
    }
    // Each wave has the same share of the variance, half the square of its amplitude.
    const amplitude = steepness.mul(2 / WAVES).sqrt()
    return vec3(slope.mul(amplitude), lost.mul(steepness).div(WAVES))
  })
  const wave = ripples().toVar()

  material.normalNode = Fn(() => {
    const normal = vec3(wave.x.negate(), 1, wave.y.negate()).normalize().toConst()
    const toCamera = cameraPosition.sub(positionWorld).normalize().toConst()
    const mirrored = reflect(toCamera.negate(), normal).toConst()
    // A ray that dips meets the next wave and goes up from there; so do most of those that a pixel blurs.
    const lift = wave.z.sqrt().mul(3).add(TEXELS).toConst()
    const height = mirrored.y.mul(mirrored.y).add(lift.mul(lift)).sqrt()
    const lifted = vec3(mirrored.x, height, mirrored.z).normalize()
    return transformNormalToView(lifted.add(toCamera).normalize())
  })()
  // GGX: α² is twice the variance of slopes, and α the square of three's roughness.
  material.roughnessNode = wave.z.mul(2).sqrt().sqrt().add(0.02).min(1)

  const mesh = new Mesh(new CircleGeometry(radius, 128).rotateX(-Math.PI / 2), material)
  return {
    mesh,
    setSlope: variance => void (steepness.value = variance),
    setTime: seconds => void (time.value = seconds),
    dispose() {
      mesh.geometry.dispose()
      material.dispose()
    }
  }
}

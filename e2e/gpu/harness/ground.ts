import { latticeNoise, latticeNoiseOnCPU, type HeightSource } from '@welkin/terrain'
import { BoxGeometry, Mesh, MeshBasicMaterial, PerspectiveCamera } from 'three'
import { float, vec4 } from 'three/tsl'
import type { GpuContext } from './context'

/** Level ground. */
export const levelGround: HeightSource = {
  lowest: 0,
  highest: 0,
  variation: () => 0,
  sampleAt(_, target) {
    target.height = 0
    target.gradient.set(0, 0, 0)
    return target
  },
  sample: () => vec4(0)
}

/**
 * Hills of one octave of noise: a software renderer draws their pages in a fraction of the time that mountains take.
 *
 * @param wavelength - Wavelength of the noise [m].
 * @param height - Half the height between valleys and summits [m].
 * @param depth - Depth of their mean below the planet's surface [m].
 */
export function hills(wavelength: number, height: number, depth = 0): HeightSource {
  const noise = { x: 0, y: 0, z: 0, value: 0 }
  return {
    lowest: -2 * height - Math.max(depth, 0),
    highest: 2 * height - Math.min(depth, 0),
    variation: distance => (4 * height * distance) / wavelength,
    sampleAt({ x, y, z }, target) {
      latticeNoiseOnCPU(x, y, z, 1 / wavelength, 0, noise)
      target.height = height * noise.value - depth
      target.gradient.set(noise.x, noise.y, noise.z).multiplyScalar(height / wavelength)
      return target
    },
    sample({ reference, offset }, shortest) {
      const { xyz, w } = latticeNoise(reference, offset, float(1 / wavelength), float(0))
      const kept = float(wavelength).div(shortest).sub(1).clamp(0, 1)
      return vec4(xyz.div(wavelength), w)
        .mul(kept.mul(height))
        .sub(vec4(0, 0, 0, depth))
    }
  }
}

/** A box in the air over the origin, which casts no shadow yet, and a camera above it that looks down. */
export function boxFromAbove(aspect: number): { box: Mesh; camera: PerspectiveCamera } {
  const box = new Mesh(new BoxGeometry(4, 1, 4), new MeshBasicMaterial({ color: 0 }))
  box.position.y = 5
  const camera = new PerspectiveCamera(60, aspect, 0.1, 1e7)
  camera.position.y = 25
  camera.rotation.x = -Math.PI / 2
  camera.updateMatrixWorld()
  return { box, camera }
}

/** Part of its light that each pixel of a row has of what it had before. */
export const sharesOf = (row: readonly number[], before: readonly number[]): number[] =>
  row.map((value, x) => value / Math.max(before[x], 1e-9))

/**
 * Checks the shadow of a {@link boxFromAbove} under a sun 40° up in the east, by the middle row of a picture 64 pixels wide.
 *
 * @throws If there is none, it is everywhere, or the ground was black before.
 */
export function expectBoxShadow(
  t: GpuContext,
  row: readonly number[],
  before: readonly number[]
): void {
  const shares = sharesOf(row, before)
  const shadow = shares.slice(0, 26).filter(share => share < 0.05).length
  const lit = shares.slice(38).filter(share => share > 0.95).length
  t.note(`${shadow} pixels in the shadow of a box, ${lit} in the light`)
  if (before.slice(0, 26).some(value => value === 0)) throw new Error('the ground is black')
  if (shadow < 4) throw new Error('a box casts no shadow on the ground')
  if (lit < 24) throw new Error('the ground is dark where no shadow is')
}

import { Break, Fn, If, float, vec4 } from 'three/tsl'
import { layout, loop, type Float, type Vec3, type Vec4 } from '../../tsl-types'
import type { Octaves } from '../cpu/fractalSum'
import { latticeNoise } from './latticeNoise'

/** Share of an octave that is kept: none at the shortest wavelength, all at twice that. */
export const keptShare = (inverse: Float, shortest: Float): Float =>
  float(1).div(inverse.mul(shortest)).sub(1).clamp(0, 1)

/**
 * Fractal sum of noise.
 *
 * @param reference - As of `latticeNoise`, like `offset`.
 * @param shortest - Shortest wavelength [m], see `HeightSource.sample`.
 * @param seed - Added to that of the octaves.
 * @returns Gradient (xyz) [1/m] and value (w). Twin: ../cpu/fractalSum.ts
 */
export const fractalSum = (
  name: string,
  octaves: Octaves
): ((reference: Vec3, offset: Vec3, shortest: Float, seed: Float) => Vec4) =>
  Fn(
    ([reference, offset, shortest, seed]: [Vec3, Vec3, Float, Float]) => {
      const sum = vec4(0).toVar()
      const inverse = float(octaves.inverse).toVar()
      const amplitude = float(1).toVar()
      loop('octave', octaves.count, octave => {
        const kept = keptShare(inverse, shortest).mul(amplitude).toConst()
        If(kept.lessThanEqual(0), () => {
          Break()
        })
        const index = seed.add(float(octave)).add(octaves.seed)
        const noise = latticeNoise(reference, offset, inverse, index).toConst()
        sum.addAssign(vec4(noise.xyz.mul(inverse), noise.w).mul(kept))
        inverse.mulAssign(2)
        amplitude.mulAssign(octaves.gain)
      })
      return sum
    },
    layout(name, 'vec4', { reference: 'vec3', offset: 'vec3', shortest: 'float', seed: 'float' })
  )

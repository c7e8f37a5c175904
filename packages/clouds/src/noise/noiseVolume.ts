import { fail } from '@welkin/geo'
import { RepeatWrapping, type Data3DTexture } from 'three'
import { texture3D } from 'three/tsl'
import type { LevelTexture, Vec3 } from '../tsl-types'
import type { NoiseFunction } from './CloudNoise'

/**
 * Noise out of a volume, for a `CloudNoise`. The volume may have any size; it is shared, not owned.
 *
 * @throws If it is no volume, or does not repeat.
 */
export function noiseVolume(volume: Data3DTexture): NoiseFunction {
  const where = 'noiseVolume'
  if (!volume?.isData3DTexture) fail(where, 'volume must be a Data3DTexture', volume)
  for (const name of ['wrapS', 'wrapT', 'wrapR'] as const) {
    if (volume[name] !== RepeatWrapping) {
      fail(where, `volume.${name} must be RepeatWrapping`, volume[name])
    }
  }
  const node = texture3D(volume) as unknown as LevelTexture<Vec3>
  return place => node.sample(place).level(0)
}

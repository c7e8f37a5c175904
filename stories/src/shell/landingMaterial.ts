import type { Texture } from 'three'
import { mix, positionLocal, texture, uv, vec3 } from 'three/tsl'
import { MeshStandardNodeMaterial } from 'three/webgpu'
import { createNoiseTexture, groundDetail } from '../globe/detailNoise'

/** Width over which the coarsest noise of the ground repeats [km]. */
const PERIOD = 40

/** Colours of what grows and of what is bare, over those of the map. */
const GROWN = [0.62, 0.74, 0.36] as const
const BARE = [1.12, 1, 0.84] as const

/** Material of the ground about the place of the landing: the map's colours far away, and patches of land close by. */
export function landingMaterial(map: Texture): MeshStandardNodeMaterial {
  const material = new MeshStandardNodeMaterial({ roughness: 1 })
  const noise = createNoiseTexture()
  material.addEventListener('dispose', () => noise.dispose())
  const place = positionLocal.xz.div(PERIOD).toConst()
  const detail = groundDetail(noise, place)
  const grown = texture(noise, place.mul(4)).r.sub(0.35).mul(3).clamp()
  const tint = mix(vec3(...BARE), vec3(...GROWN), grown)
  material.colorNode = texture(map, uv()).rgb.mul(tint).mul(detail)
  return material
}

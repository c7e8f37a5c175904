import { DataUtils } from 'three'
import type { Texture } from 'three'
import { Fn, float, texture, uv, vec2, vec3 } from 'three/tsl'
import type { Renderer } from 'three/webgpu'
import type { Spectrum } from '../parameters/AtmosphereParameters'
import { FragmentPass, tableTarget } from '../tables/FragmentPass'
import type { Float, Vec2, Vec3, Vec4 } from '../tsl-types'
import { equirectangular } from './tsl/equirectangular'
import type { GradientSampler } from './tsl/groundTexture'

/** Size of the map of the whole planet whose mean is taken [texels]. */
const WIDTH = 128
const HEIGHT = 64

/**
 * Mean of an albedo over the whole planet, drawn on the GPU and read back.
 *
 * @param albedoAt - Albedo at a geodetic normal (ECEF axes), for a footprint in units of the radius; `read`
 *   samples an equirectangular texture there.
 */
export async function meanGroundAlbedo(
  renderer: Renderer,
  albedoAt: (normal: Vec3, footprint: Float, read: (source: Texture) => Vec4) => Vec4
): Promise<Spectrum> {
  const target = tableTarget('PlanetGround.albedo', WIDTH, HEIGHT)
  const pass = new FragmentPass(
    'Welkin.PlanetGround.albedo',
    Fn(() => {
      // Rows of equal area.
      const z = uv().y.mul(2).sub(1).toConst() as Float
      const longitude = uv()
        .x.sub(0.5)
        .mul(2 * Math.PI)
        .toConst() as Float
      const level = z.mul(z).oneMinus().max(0).sqrt()
      const normal = vec3(longitude.cos().mul(level), longitude.sin().mul(level), z).toConst()
      const coordinates = equirectangular(normal).toConst() as Vec2
      const across = vec2(1 / WIDTH, 0) as unknown as Vec2
      const along = vec2(0, 1 / HEIGHT) as unknown as Vec2
      const read = (source: Texture): Vec4 =>
        (texture(source) as unknown as GradientSampler).sample(coordinates).grad(across, along)
      return albedoAt(normal, float(3 / HEIGHT), read)
    })()
  )
  pass.render(renderer, target)
  const halves = await renderer.readRenderTargetPixelsAsync(target, 0, 0, WIDTH, HEIGHT)
  target.dispose()
  pass.dispose()
  const sum = [0, 0, 0, 0]
  ;(halves as Uint16Array).forEach((half, i) => (sum[i % 4] += DataUtils.fromHalfFloat(half)))
  return sum.map(value => Math.min(value / (WIDTH * HEIGHT), 1)) as unknown as Spectrum
}

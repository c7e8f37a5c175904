import { DirectionalLight, Vector3 } from 'three'
import type { Camera, Light, RenderTarget } from 'three'
import { Fn, float, screenCoordinate, texture, vec2, vec3 } from 'three/tsl'
import type { Renderer, TextureNode } from 'three/webgpu'
import { WhiteSurfaces } from '../lights/WhiteSurfaces'
import { tableTarget } from '../tables/FragmentPass'
import { sampleLevel0, type Float, type Mat3, type Vec3 } from '../tsl-types'
import { matrix3, vector3, vector4 } from '../uniforms'
import { isLamp } from './LampUniforms'
import type { FallingLattice } from './FallingLattice'

/** Classes of size; for each, directional light is measured at one distance. */
const CLASSES = 4
/** Distance of that measurement over the one up to which the class is drawn [–]. */
const MIDDLE = 0.4

const _target = new Vector3()

/** Light of parallel rays, where it is measured. */
class MeasuredRays {
  readonly #target = tableTarget('Welkin.PrecipitationSunlight', CLASSES, 1)
  readonly #texture: TextureNode = texture(this.#target.texture)
  /** To the light, in view space. */
  readonly direction = vector3()
  readonly #surfaces: WhiteSurfaces

  constructor(
    readonly light: DirectionalLight,
    depth: Vec3
  ) {
    this.#surfaces = new WhiteSurfaces('Welkin.PrecipitationSunlight', depth, this.direction)
  }

  render(renderer: Renderer, camera: Camera): void {
    this.#surfaces.render(renderer, camera, [this.light], this.#target)
  }

  update({ matrixWorldInverse }: Camera): void {
    const { light, direction } = this
    _target.setFromMatrixPosition(light.target.matrixWorld)
    direction.value.setFromMatrixPosition(light.matrixWorld).sub(_target)
    direction.value.transformDirection(matrixWorldInverse)
  }

  /** Illuminance of a plane towards it, at the place of a class. */
  illuminance(sizeClass: Float): Vec3 {
    const u = sizeClass.add(0.5).div(CLASSES)
    return sampleLevel0(this.#texture, vec2(u as Float, 0.5)).rgb.mul(Math.PI)
  }

  dispose(): void {
    this.#target.dispose()
    this.#surfaces.dispose()
  }
}

/**
 * Light at the camera, as white Lambert surfaces receive it from three's lights: shadows of clouds, night and overcast skies
 * included.
 *
 * Surfaces of six directions are lit by probes and ambient lights, and others by each directional light, at some distances in
 * front of the camera. They are a few texels, drawn for every camera.
 */
export class MeasuredLight {
  readonly rays: readonly MeasuredRays[]
  readonly #around: readonly Light[]
  readonly #target: RenderTarget = tableTarget('Welkin.PrecipitationSkylight', 6, 1)
  readonly #texture: TextureNode = texture(this.#target.texture)
  /** Directions in the lattice's frame to view space. */
  readonly #axes = matrix3()
  /** Distances at which directional light is measured [world units]. */
  readonly #distances = vector4()
  readonly #surfaces: WhiteSurfaces

  constructor(
    lights: readonly Light[],
    private readonly reach: readonly number[]
  ) {
    this.#around = lights.filter(light => !isLamp(light) && !(light instanceof DirectionalLight))
    const texel = screenCoordinate.x.floor().toConst() as Float
    const here = Fn((): Vec3 => {
      const { x, y, z, w } = this.#distances
      const near = texel.lessThan(0.5).select(x, y)
      const far = texel.lessThan(2.5).select(z, w)
      return vec3(0, 0, texel.lessThan(1.5).select(near, far).negate())
    })()
    const normal = Fn((): Vec3 => {
      const axis = texel.mul(0.5).floor().toConst() as Float
      const sign = texel.sub(axis.mul(2)).mul(-2).add(1).toConst() as Float
      const along = (n: number): Float => axis.equal(n).select(sign, float(0))
      return (this.#axes as unknown as Mat3).mul(vec3(along(0), along(1), along(2))).normalize()
    })()
    this.#surfaces = new WhiteSurfaces('Welkin.PrecipitationSkylight', vec3(0, 0, 0), normal)
    this.rays = lights
      .filter(light => light instanceof DirectionalLight)
      .map(light => new MeasuredRays(light, here))
  }

  /** Draws the measurements. */
  render(renderer: Renderer, camera: Camera): void {
    this.#surfaces.render(renderer, camera, this.#around, this.#target)
    for (const rays of this.rays) rays.render(renderer, camera)
  }

  /** Sets uniforms for a camera. */
  update(camera: Camera, { toView, unit }: FallingLattice): void {
    this.#axes.value.setFromMatrix4(toView).multiplyScalar(1 / unit)
    this.#distances.value.fromArray(this.reach).multiplyScalar(MIDDLE * unit)
    for (const rays of this.rays) rays.update(camera)
  }

  /**
   * Irradiance of a plane by sky and ground, over π: mean radiance, weighted by the cosine, of what it faces. It is
   * blended between six planes (McTaggart 2004, "Half-Life 2 shading").
   *
   * @param normal - Unit vector in the lattice's frame.
   */
  radianceAround(normal: Vec3): Vec3 {
    const faced = (n: number, component: Float): Vec3 => {
      const back = component.lessThan(0).select(1, 0)
      const u = float(back as Float)
        .add(2 * n + 0.5)
        .div(6)
      const read = sampleLevel0(this.#texture, vec2(u as Float, 0.5)).rgb.toConst()
      return read.mul(component.mul(component))
    }
    return faced(0, normal.x).add(faced(1, normal.y)).add(faced(2, normal.z))
  }

  dispose(): void {
    this.#target.dispose()
    this.#surfaces.dispose()
    for (const rays of this.rays) rays.dispose()
  }
}

import { FragmentPass, tableTarget } from '@welkin/atmosphere'
import { Matrix4 } from 'three'
import type { PerspectiveCamera } from 'three'
import {
  Break,
  float,
  Fn,
  If,
  Loop,
  max,
  mix,
  positionWorld,
  reflectVector,
  roughness,
  smoothstep,
  texture,
  uniform,
  uv,
  vec2,
  vec3,
  vec4
} from 'three/tsl'
import type { Node, Renderer, TextureNode } from 'three/webgpu'
import { screenPlace } from './screenPlace'

/** Places along a mirrored ray at which the picture is asked, and the distances of the first and the last [m]. */
const STEPS = 26
const REACH = [4, 40_000] as const
/** Halvings of the step in which a ray goes behind what is seen. */
const HALVINGS = 5
/** Depth behind what is seen within which it is met: over the distance, and at least [m]. */
const THICKNESS = [0.08, 6] as const
/** Greatest distance that the picture tells apart from the sky [m]. */
export const SKY_DEPTH = 60_000
/** Distance beyond the picture's edges, over its size, at which the mirror image has faded. */
const FADE = 0.14

/** Least rise of a mirrored direction, which does not go down into the water. */
const LEAST_RISE = 0.004

type Vec2 = Node<'vec2'>
type Vec4 = Node<'vec4'>

/**
 * Mirror image of the picture before, for still water: mirrored rays are followed over the screen until they go behind what
 * was seen there, or into the sky. It has all that the picture has: clouds, haze, mountains and trees.
 */
export class LakeMirror {
  readonly #picture: TextureNode
  /** The picture before, at half its size. */
  readonly #target = tableTarget('LakeMirror', 1, 1)
  readonly #image = texture(this.#target.texture)
  readonly #pass: FragmentPass
  readonly #toScreen = uniform(new Matrix4())
  /** Part of the screen's height that a radian covers, and 1 once there is a picture. */
  readonly #scale = uniform(1)
  readonly #isDrawn = uniform(0)
  /** Luminance scale of the picture that was kept, and that of the next one over it. */
  #kept = 1
  readonly #gain = uniform(1)

  /** @param picture - Light of the last frame, and distance along the camera's axis in alpha, up to {@link SKY_DEPTH}. */
  constructor(picture: TextureNode) {
    this.#picture = texture(picture.value)
    const light = this.#picture.sample(uv()).level(float(0)) as unknown as Vec4
    this.#pass = new FragmentPass('LakeMirror', light)
  }

  /** False for water without a mirror image, which then costs nothing. Default true. */
  isOn = true

  /** Makes the texture that the water reads, before its first frame. */
  prepare(renderer: Renderer): void {
    renderer.initRenderTarget(this.#target)
  }

  /**
   * Has the mirror image in the luminance scale of the frame that is drawn next: from night to noon it falls by a factor of 10⁵
   * within a frame. From noon to night the image stays as bright as it was shown, or else noon would dazzle.
   */
  scaleTo(luminanceScale: number): void {
    this.#gain.value = Math.min(luminanceScale / this.#kept, 1)
  }

  /** Keeps the picture that was just drawn in a luminance scale, and its camera. */
  update(renderer: Renderer, camera: PerspectiveCamera, luminanceScale: number): void {
    this.#isDrawn.value = Number(this.isOn)
    if (!this.isOn) return
    this.#kept = luminanceScale
    const { width, height } = this.#picture.value.image as { width: number; height: number }
    this.#target.setSize(Math.ceil(width / 2), Math.ceil(height / 2))
    this.#pass.render(renderer, this.#target)
    this.#toScreen.value.multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse)
    this.#scale.value = camera.projectionMatrix.elements[5] / 2
  }

  /** Light from the mirrored direction, and the part of it that the picture has, for a fragment of the water. */
  sample(): Vec4 {
    return Fn(() => {
      const direction = vec3(reflectVector.x, max(reflectVector.y, LEAST_RISE), reflectVector.z)
        .normalize()
        .toConst()
      const from = this.#toScreen.mul(vec4(positionWorld, 1)).toConst()
      const along = this.#toScreen.mul(vec4(direction, 0)).toConst()
      // What is too small for ripples stretches the image upwards.
      const stretch = roughness.mul(roughness).mul(this.#scale).toConst()
      const image = vec4(0).toVar()
      If(this.#isDrawn.greaterThan(0), () => {
        image.assign(this.#follow(from, along, stretch))
      })
      return image
    })().toVar()
  }

  /** Follows a mirrored ray over the screen, from a place along a direction, both in clip space. */
  #follow(from: Vec4, along: Vec4, stretch: Node<'float'>): Vec4 {
    return Fn(() => {
      /** Place on the screen, and distance along the camera's axis. */
      const at = (far: Node<'float'>): Node<'vec3'> => {
        const clip = from.add(along.mul(far)).toConst()
        return vec3(screenPlace(clip), clip.w).toConst()
      }
      const depthAt = (place: Vec2): Node<'float'> => this.#read(place).a
      const hit = vec3(0).toVar()
      const isHit = float(0).toVar()
      const before = float(0).toVar()
      // A hit needs a step in front of what is drawn: water beside a tree, where half-sized pixels are of both, begins behind it.
      const wasInFront = float(0).toVar()
      const growth = (REACH[1] / REACH[0]) ** (1 / (STEPS - 1))
      const far = float(REACH[0]).toVar()
      Loop(STEPS, () => {
        const place = at(far)
        const depth = depthAt(place.xy).toConst()
        const slack = max(place.z.mul(THICKNESS[0]), THICKNESS[1])
        const nearest = at(before).z.sub(slack)
        const isBehind = place.z.greaterThan(depth).toConst()
        If(isBehind.and(wasInFront.greaterThan(0)).and(depth.greaterThan(nearest)), () => {
          const [near, behind] = [before.toVar(), far.toVar()]
          Loop(HALVINGS, () => {
            const middle = near.add(behind).mul(0.5).toConst()
            const there = at(middle)
            If(there.z.greaterThan(depthAt(there.xy)), () => {
              behind.assign(middle)
            }).Else(() => {
              near.assign(middle)
            })
          })
          hit.assign(at(behind))
          isHit.assign(1)
          Break()
        })
        wasInFront.assign(isBehind.select(0, 1))
        before.assign(far)
        far.mulAssign(growth)
      })
      If(isHit.equal(0), () => {
        // Where nothing was met, the sky, or what hides it: rims of mountains are at a mean of both depths, which no ray meets.
        hit.assign(vec3(screenPlace(along), along.w))
        isHit.assign(1)
      })
      // Ripples lead a little beyond the picture: there its edges go on.
      const outside = max(hit.xy.sub(0.5).abs().sub(0.5), 0)
      const fade = smoothstep(FADE, 0, max(outside.x, outside.y))
      const isAhead = hit.z.greaterThan(0).select(1, 0)
      const light = [-1, 0, 1].map(part => this.#read(hit.xy.add(vec2(0, stretch.mul(part)))).rgb)
      const mean = light[0].add(light[1].mul(2)).add(light[2]).mul(this.#gain.mul(0.25))
      return vec4(mean, isHit.mul(fade).mul(isAhead))
    })()
  }

  #read(place: Vec2): Vec4 {
    return this.#image.sample(place).level(float(0))
  }

  /** Frees the picture. */
  dispose(): void {
    this.#target.dispose()
    this.#pass.dispose()
  }
}

/** Fresnel's reflectance of water, by Schlick's approximation. */
export const waterReflectance = (cosView: Node<'float'>): Node<'float'> =>
  mix(float(0.02), float(1), cosView.oneMinus().clamp(0, 1).pow(5))

import { BufferGeometry, Float32BufferAttribute, Mesh, NoBlending, Scene } from 'three'
import type { Light, Object3D, RenderTarget } from 'three'
import {
  Fn,
  lights as lightsNode,
  modelWorldMatrix,
  overrideNodes,
  positionGeometry,
  positionLocal,
  positionView,
  positionWorld,
  screenUV,
  textureSize,
  vec2,
  vec3,
  vec4
} from 'three/tsl'
import { MeshLambertNodeMaterial, RendererUtils } from 'three/webgpu'
import type { Node, Renderer } from 'three/webgpu'
import type { DepthRays } from '../view/DepthRays'
import type { Vec2, Vec3 } from '../tsl-types'
import { depthNormal } from './tsl/depthNormal'

/** Middle of the depth's texel at a fragment, and the depth's size. */
function texelHere({ depthNode }: DepthRays): { at: Vec2; size: Vec2 } {
  const size = vec2(textureSize(depthNode, 0 as never) as never).toConst() as Vec2
  return { at: screenUV.mul(size).floor().add(0.5).div(size).toConst(), size }
}

/** The scene that a light stands in. */
function sceneOf(light: Object3D): Object3D {
  let root = light
  while (root.parent !== null) root = root.parent
  return root
}

/**
 * White Lambert surfaces where a picture's depth has them, in the light of three's lights.
 *
 * A triangle over the whole picture, whose positions and normals are those of the depth. It stands at the camera, so
 * that positions are small, however large the world is.
 */
export class WhiteSurfaces {
  readonly #rays: DepthRays
  readonly #lights = lightsNode()
  readonly #material = new MeshLambertNodeMaterial()
  readonly #triangle: Mesh
  readonly #scene = new Scene()
  #shown: readonly Light[] = []

  /** @param normal - Normals in view space; left out, they are found from depth. */
  constructor(rays: DepthRays, normal?: Node) {
    this.#rays = rays
    const geometry = new BufferGeometry()
    geometry.setAttribute(
      'position',
      new Float32BufferAttribute([-1, 3, 0, -1, -1, 0, 3, -1, 0], 3)
    )
    geometry.setAttribute('normal', new Float32BufferAttribute([0, 0, 1, 0, 0, 1, 0, 0, 1], 3))
    Object.assign(this.#material, {
      name: 'Welkin.SurfaceLighting',
      blending: NoBlending,
      depthTest: false,
      depthWrite: false,
      fog: false,
      lightsNode: this.#lights,
      vertexNode: vec4(positionGeometry.xy, 0, 1),
      colorNode: vec3(1),
      normalNode: normal ?? this.#normal(),
      contextNode: this.#atDepth()
    })
    this.#triangle = new Mesh(geometry, this.#material)
    this.#triangle.frustumCulled = false
    this.#triangle.receiveShadow = true
    this.#triangle.name = 'Welkin.SurfaceLighting'
    const scene = this.#scene
    scene.matrixWorldAutoUpdate = false
    scene.children = [this.#triangle]
    // Shadow maps are drawn of the scene that is being drawn: for them it has the lights' scene in it.
    const { camera } = rays
    scene.onBeforeRender = (_renderer, _scene, seenFrom) => {
      const [light] = this.#shown
      scene.children = seenFrom === camera ? [this.#triangle] : [sceneOf(light)]
    }
  }

  #normal(): Vec3 {
    return Fn(({ renderer }): Vec3 => {
      const { at, size } = texelHere(this.#rays)
      return depthNormal(renderer, this.#rays, at, size)
    })()
  }

  /** Replaces the triangle's positions by those of the depth. */
  #atDepth(): Node {
    const position = Fn(({ renderer }): Vec3 => {
      const { at } = texelHere(this.#rays)
      return this.#rays.at(renderer, at).position
    })()
    const world = modelWorldMatrix.mul(vec4(position, 1)).xyz
    return overrideNodes(
      [
        [positionLocal, position],
        [positionView, position],
        [positionWorld, world]
      ],
      null,
      'fragment'
    )
  }

  /** Draws into the target; the renderer is left as it was. */
  render(renderer: Renderer, lights: readonly Light[], target: RenderTarget): void {
    const shown = lights.filter(({ visible }) => visible)
    if (shown.length !== this.#shown.length || shown.some((light, i) => light !== this.#shown[i])) {
      this.#shown = shown
      this.#lights.setLights([...shown])
    }
    const { camera } = this.#rays
    this.#triangle.matrixWorld.copy(camera.matrixWorld)
    const state = RendererUtils.resetRendererState(renderer, {} as never)
    renderer.setRenderTarget(target)
    renderer.setClearColor(0x000000, 1)
    renderer.autoClear = true
    if (shown.length === 0) renderer.clear()
    else renderer.render(this.#scene, camera)
    RendererUtils.restoreRendererState(renderer, state)
  }

  dispose(): void {
    this.#material.dispose()
    this.#triangle.geometry.dispose()
  }
}

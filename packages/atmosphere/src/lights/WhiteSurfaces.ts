import { BufferGeometry, Float32BufferAttribute, Mesh, NoBlending, Scene } from 'three'
import type { Camera, Light, Object3D, RenderTarget } from 'three'
import {
  lights as lightsNode,
  modelWorldMatrix,
  overrideNodes,
  positionGeometry,
  positionLocal,
  positionView,
  positionWorld,
  screenUV,
  vec3,
  vec4
} from 'three/tsl'
import { MeshLambertNodeMaterial, RendererUtils } from 'three/webgpu'
import type { Node, Renderer } from 'three/webgpu'
import type { Vec3 } from '../tsl-types'

/** The scene that a light stands in. */
function sceneOf(light: Object3D): Object3D {
  let root = light
  while (root.parent !== null) root = root.parent
  return root
}

/**
 * White Lambert surfaces in the light of three's lights, one for each pixel of a target.
 *
 * A triangle over the whole picture, whose positions and normals are those that it is given. It stands at the camera, so
 * that positions are small, however large the world is.
 */
export class WhiteSurfaces {
  readonly #lights = lightsNode()
  readonly #material = new MeshLambertNodeMaterial()
  readonly #triangle: Mesh
  readonly #scene = new Scene()
  #shown: readonly Light[] = []
  #camera: Camera | null = null

  /**
   * @param name - Name in a graphics debugger.
   * @param position - Position of a pixel's surface, in view space [world units].
   * @param normal - Its normal, in view space.
   */
  constructor(name: string, position: Vec3, normal: Node) {
    const geometry = new BufferGeometry()
    geometry.setAttribute(
      'position',
      new Float32BufferAttribute([-1, 3, 0, -1, -1, 0, 3, -1, 0], 3)
    )
    geometry.setAttribute('normal', new Float32BufferAttribute([0, 0, 1, 0, 0, 1, 0, 0, 1], 3))
    const contextNode = overrideNodes(
      [
        [positionLocal, position],
        [positionView, position],
        [positionWorld, modelWorldMatrix.mul(vec4(position, 1)).xyz]
      ],
      null,
      'fragment'
    )
    // Normals that are given may be a texture's, which asks for these.
    const getAttribute = (attribute: string): Node | null => (attribute === 'uv' ? screenUV : null)
    Object.assign(contextNode.value as object, { getAttribute })
    Object.assign(this.#material, {
      name,
      blending: NoBlending,
      depthTest: false,
      depthWrite: false,
      fog: false,
      lightsNode: this.#lights,
      vertexNode: vec4(positionGeometry.xy, 0, 1),
      colorNode: vec3(1),
      normalNode: normal,
      contextNode
    })
    this.#triangle = new Mesh(geometry, this.#material)
    this.#triangle.frustumCulled = false
    this.#triangle.receiveShadow = true
    this.#triangle.name = name
    const scene = this.#scene
    scene.matrixWorldAutoUpdate = false
    scene.children = [this.#triangle]
    // Shadow maps are drawn of the scene that is being drawn: for them it has the lights' scene in it.
    scene.onBeforeRender = (_renderer, _scene, seenFrom) => {
      const [light] = this.#shown
      scene.children = seenFrom === this.#camera ? [this.#triangle] : [sceneOf(light)]
    }
  }

  /** Draws into the target; the renderer is left as it was. */
  render(renderer: Renderer, camera: Camera, lights: readonly Light[], target: RenderTarget): void {
    const shown = lights.filter(({ visible }) => visible)
    if (shown.length !== this.#shown.length || shown.some((light, i) => light !== this.#shown[i])) {
      this.#shown = shown
      this.#lights.setLights([...shown])
    }
    this.#camera = camera
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

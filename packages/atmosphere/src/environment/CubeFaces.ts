import type { PerspectiveCamera } from 'three'
import { BackSide, BoxGeometry, CubeCamera, Mesh, NoBlending } from 'three'
import { NodeMaterial } from 'three/webgpu'
import type { CubeRenderTarget, Node, Renderer } from 'three/webgpu'

/** Fills cubes, face by face, with what a shader makes of `positionWorldDirection`. */
export class CubeFaces {
  readonly material = new NodeMaterial()
  readonly #box = new Mesh(new BoxGeometry(5, 5, 5), this.material)
  readonly #cameras = new CubeCamera(1, 10, null as never)

  /** @param name - Name of the passes in a graphics debugger. */
  constructor(name: string) {
    this.material.name = name
    this.material.side = BackSide
    this.material.blending = NoBlending
    for (const key of ['depthTest', 'depthWrite', 'toneMapped', 'fog'] as const) {
      this.material[key] = false
    }
  }

  /** The shader: a colour in the direction of a fragment. */
  set shader(output: Node) {
    this.material.fragmentNode = output
    this.material.needsUpdate = true
  }

  /** Draws a face of a level. The renderer's target is that one afterwards. */
  draw(renderer: Renderer, target: CubeRenderTarget, face: number, level = 0): void {
    if (this.#cameras.coordinateSystem !== renderer.coordinateSystem) {
      this.#cameras.coordinateSystem = renderer.coordinateSystem
      this.#cameras.updateCoordinateSystem()
    }
    renderer.setRenderTarget(target, face, level)
    renderer.render(this.#box, this.#cameras.children[face] as PerspectiveCamera)
  }

  dispose(): void {
    this.#box.geometry.dispose()
    this.material.dispose()
  }
}

declare module 'virtual:recipes' {
  import type { Atmosphere } from '@welkin/atmosphere'
  import type { PerspectiveCamera, Scene } from 'three'
  import type { PassNode, RenderPipeline, WebGPURenderer } from 'three/webgpu'

  /** Names that a recipe goes on from. */
  interface Given {
    renderer: WebGPURenderer
    scene: Scene
    camera: PerspectiveCamera
    atmosphere: Atmosphere
  }

  /** Recipes of the README for three's post effects, in order. */
  export const recipes: ((given: Given) => { pipeline: RenderPipeline; scenePass: PassNode })[]
}

import { createNoiseTexture } from './globe/detailNoise'
import { createRenderer, exposureOf } from './scene'
import type { RendererArgs, SceneHandle } from './scene'
import { TexturePictures } from './showTextures'

export interface TablesArgs extends RendererArgs {
  /** [stops], 0 shows 1 as white. */
  exposure: number
}

/** Textures of the atmosphere as pictures; until it is here, the ground's detail noise stands in. */
export async function createTables(
  canvas: HTMLCanvasElement,
  args: TablesArgs
): Promise<SceneHandle<TablesArgs>> {
  const renderer = await createRenderer(canvas, args.forceWebGL)
  renderer.setClearColor('#14181d')
  const noise = createNoiseTexture()
  const pictures = new TexturePictures(canvas, [
    { label: 'Detail noise', texture: noise, width: 256, height: 256, color: texel => texel.rrr },
    {
      label: 'Detail noise, wide',
      texture: noise,
      width: 256,
      height: 64,
      color: texel => texel.rrr
    }
  ])
  const current = { ...args }
  const apply = (): void => {
    pictures.set('Detail noise', { scale: exposureOf(current.exposure) })
  }
  apply()

  return {
    renderer,
    scene: pictures.scene,
    camera: pictures.camera,
    ready: Promise.resolve(),
    progress: 1,
    render() {
      renderer.render(pictures.scene, pictures.camera)
    },
    resize(width, height, pixelRatio) {
      renderer.setPixelRatio(pixelRatio)
      renderer.setSize(width, height, false)
      pictures.resize(width, height)
    },
    update(changes) {
      Object.assign(current, changes)
      apply()
    },
    dispose() {
      pictures.dispose()
      noise.dispose()
      void renderer.dispose()
    }
  }
}

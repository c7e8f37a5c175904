import { createMoon } from './moon.scene'
import type { MoonArgs } from './moon.scene'
import type { SceneHandle } from './scene'

/** The moon's scene, which looks at the sun. */
export const createEclipse = (
  canvas: HTMLCanvasElement,
  args: MoonArgs
): Promise<SceneHandle<MoonArgs>> => createMoon(canvas, args)

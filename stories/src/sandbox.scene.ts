import type { AtmosphereParametersInit } from '@welkin/atmosphere'
import { Mesh, MeshStandardMaterial, PerspectiveCamera, Scene, Vector3 } from 'three'
import { afterLast } from './afterLast'
import { Explorer } from './moving/Explorer'
import { travel, TURN_SECONDS } from './moving/travel'
import { parametersOf } from './sandbox/airArgs'
import type { AirArgs } from './sandbox/airArgs'
import { keepStand } from './sandbox/keepStand'
import { planetGeometry } from './sandbox/planetMesh'
import { EARTH, presets } from './sandbox/presets'
import type { PresetName } from './sandbox/presets'
import { SandboxSky } from './sandbox/SandboxSky'
import type { LightsArgs } from './sandbox/SandboxSky'
import { overlayOn } from './overlay'
import { createThings } from './sandbox/things'
import { createRenderer, disposeMeshes, drawSettled, EXPOSURE_FRAMES, frameClock } from './scene'
import type { RendererArgs, SceneHandle } from './scene'
import { storyHandle } from './storyHandle'

export interface SandboxArgs extends RendererArgs, AirArgs, LightsArgs {
  preset: PresetName
  /** Preset that the sliders were last set to. */
  shown: PresetName
  /** Height of the camera above the ground [m]. */
  height: number
  /** Direction of view from north, clockwise [°]. */
  heading: number
  /** Direction of view above the horizontal [°]. */
  pitch: number
}

/** Time after the last change of a planet's size until it is built [ms]. */
const SIZING = 200

/** All parameters of air, sun and moon under sliders, over a planet of any size. */
export async function createSandbox(
  canvas: HTMLCanvasElement,
  args: SandboxArgs
): Promise<SceneHandle<SandboxArgs>> {
  const renderer = await createRenderer(canvas, args.forceWebGL)
  const scene = new Scene()
  const camera = new PerspectiveCamera(60, 1, 0.5, 1e9)
  const ground = new Mesh(planetGeometry(1e4), new MeshStandardMaterial({ roughness: 0.95 }))
  ground.receiveShadow = true
  const things = createThings()
  scene.add(ground, ...things)
  const current = { ...args }
  const note = overlayOn(canvas)
  let handle: SceneHandle<SandboxArgs> | undefined
  let sky: SandboxSky | undefined
  /** Parameters on show, as text. */
  let shownAir = ''

  const center = new Vector3()
  const explorer = args.frame
    ? undefined
    : new Explorer(camera, canvas, {
        upAt: (position, target) => target.copy(position).sub(center).normalize(),
        heightAt: position => position.distanceTo(center) + center.y
      })

  /** Shows a planet of another size, which takes an atmosphere of its own. */
  const build = (init: AtmosphereParametersInit): void => {
    const made = new SandboxSky(init, {
      renderer,
      scene,
      camera,
      path: current.path,
      frame: current.frame
    })
    made.atmosphere.luminanceScale = sky?.atmosphere.luminanceScale ?? 1e-4
    const before = sky?.parameters.bottomRadius
    sky?.dispose()
    sky = made
    const { bottomRadius } = made.parameters
    center.set(0, -bottomRadius, 0)
    ground.geometry.dispose()
    ground.geometry = planetGeometry(bottomRadius)
    if (before === undefined || current.frame) travel(undefined, camera, placeCamera, 0)
    else keepStand(camera, before, bottomRadius)
  }

  const placeCamera = (moved: PerspectiveCamera): void => {
    const { height, heading, pitch } = current
    const [turn, lift] = [-heading, pitch].map(angle => (angle * Math.PI) / 180)
    // Farther away the higher it is, so that it sees the things from above.
    moved.position.set(0, height, 14 + Math.min(height, 200))
    moved.rotation.set(lift, turn, 0, 'YXZ')
  }

  /** @param isSettled - True if no slider moves: a planet of another size is built then. */
  const applyAir = (isSettled: boolean): string[] => {
    const { init, notes } = parametersOf(current, EARTH)
    const air = JSON.stringify(init)
    if (air === shownAir) return notes
    if (sky === undefined || sky.parameters.bottomRadius !== init.bottomRadius) {
      if (!isSettled) {
        sized.ask()
        return notes
      }
      build(init)
    }
    const { parameters } = sky!
    // #region sandbox
    // #shown const { parameters } = atmosphere
    // #shown const init = { turbidity: 4, ozone: 350, mieAnisotropy: 0.76 } // and all else
    parameters.set(init) // at any time; tables are baked again, no shader is compiled
    // #endregion
    shownAir = air
    const [blue, green, yellow, red] = init.groundAlbedo!
    ground.material.color.setRGB(red, (green + yellow) / 2, blue)
    return notes
  }

  const takePreset = (): void => {
    if (current.preset === current.shown) return
    const changes = { ...presets[current.preset], shown: current.preset }
    Object.assign(current, changes)
    handle?.onArgs?.(changes)
  }

  /** Shows the arguments; what is refused leaves the picture as it is, and says so. */
  const apply = (isSettled: boolean): void => {
    takePreset()
    const messages: string[] = []
    for (const step of [() => applyAir(isSettled), () => (sky?.apply(current), [])]) {
      try {
        messages.push(...step())
      } catch (error) {
        messages.push(error instanceof Error ? error.message : String(error))
      }
    }
    note.textContent = messages.join('\n')
    note.hidden = messages.length === 0
  }
  const sized = afterLast(SIZING, () => apply(true))
  apply(true)

  const elapsed = frameClock(args.frame)
  const draw = (): void => {
    const seconds = elapsed()
    explorer?.update(seconds)
    camera.updateMatrixWorld()
    if (!current.frame) sky?.exposure.adapt(seconds)
    sky?.render()
  }

  handle = storyHandle({
    renderer,
    scene,
    camera,
    explorer,
    current,
    apply(before) {
      apply(current.frame)
      const isMoved = (['height', 'heading', 'pitch'] as const).some(
        name => before[name] !== current[name]
      )
      if (isMoved) travel(explorer, camera, placeCamera, TURN_SECONDS)
    },
    draw,
    async warmUp() {
      if (current.frame) await drawSettled(EXPOSURE_FRAMES, draw, () => sky?.exposure)
    },
    dispose() {
      sized.cancel()
      note.remove()
      sky?.dispose()
      disposeMeshes([ground, ...things])
    }
  })
  return handle
}

import { GlobeControls } from '3d-tiles-renderer'
import type { AutoExposureNode } from '@welkin/atmosphere'
import { Ellipsoid, fitGlobeCamera } from '@welkin/geo'
import { Group, PerspectiveCamera, Scene, Vector3 } from 'three'
import type { DataTexture } from 'three'
import type { WebGPURenderer } from 'three/webgpu'
import { Air } from '../air'
import { Explorer } from '../moving/Explorer'
import { EYE_HEIGHT } from '../moving/Walk'
import { createRenderer, fitToCanvas, frameClock, WARM_UP_FRAMES } from '../scene'
import type { RendererArgs, SceneHandle } from '../scene'
import { createNoiseTexture } from './detailNoise'
import { createCityLights } from './cityLights'
import { createEarthSurface } from './earthSurface'
import { groundHeight } from './groundHeight'
import { loadTiles, tilesProgress } from './loadTiles'
import { flyToPlace, moveCamera } from './places'
import type { Place } from './places'
import { shareMouse } from './shareMouse'
import { aimShadow, prepareShadow } from './sunShadow'
import { createTerrain } from './terrain'

/**
 * The Earth in tiles, pictures of all of it and terrain of one valley, under a sky, and a camera that moves
 * about it.
 */
export interface Land {
  readonly renderer: WebGPURenderer
  readonly scene: Scene
  readonly camera: PerspectiveCamera
  readonly air: Air
  /** Noise for all else that stands on the land. */
  readonly noise: DataTexture
  /** Scale of the towns' light, where there is some: the atmosphere's `luminanceScale`. */
  readonly townScale: { value: number } | undefined
}

/** Additions of a story to the land. */
export interface LandStory<Args> {
  /** Camera of the arguments; the camera moves when this is another object. */
  place(args: Args): Place
  /** Frames to draw before one counts; {@link WARM_UP_FRAMES} if left out. */
  readonly warmUpFrames?: number
  /** Exposure of the picture, which adapts to it; left out, there is none. */
  readonly exposure?: AutoExposureNode
  /** Called before the frames of a screenshot: settles when all that these need is there. */
  prepare?(): Promise<void>
  /** Follows its arguments. */
  apply(args: Args): void
  /** @param altitude - Altitude of the camera above the ellipsoid [m]. */
  beforeDraw?(altitude: number): void
  /** Height of what one cannot walk through at a position, over the ground; −∞ where there is nothing [m]. */
  roofAt?(position: Vector3): number
  dispose?(): void
}

/** Direction above the horizontal that drags may turn to [rad]. */
const HIGHEST_PITCH = 1.2

/**
 * A scene on the Earth's land, in a world that is ECEF, in metres.
 *
 * @param fieldOfView - Vertical [degrees].
 * @param create - Makes what is the story's own.
 * @param hasTowns - True for towns that give light.
 */
export async function createLand<Args extends RendererArgs>(
  canvas: HTMLCanvasElement,
  args: Args,
  fieldOfView: number,
  create: (land: Land) => LandStory<Args>,
  { hasTowns = false }: { hasTowns?: boolean } = {}
): Promise<SceneHandle<Args>> {
  const renderer = await createRenderer(canvas, args.forceWebGL)
  const scene = new Scene()
  const camera = new PerspectiveCamera(fieldOfView, 1, 1, 1e7)
  const noise = createNoiseTexture()
  const data = new URL('world-data/', document.baseURI)
  const towns = hasTowns ? await createCityLights(new URL('earth/', data).href, noise) : undefined
  const imagery = new URL('natural-earth/', data).href
  const surface = createEarthSurface(imagery, noise, towns?.emission)
  const terrain = createTerrain(new URL('terrain/', data).href, noise)
  const tilesets = [surface.tiles, terrain.tiles]
  const ground = new Group()
  ground.add(surface.tiles.group, terrain.tiles.group)
  scene.add(ground)
  for (const tiles of tilesets) tiles.setCamera(camera)

  const air = new Air(renderer, scene, camera, args.path)
  const story = create({ renderer, scene, camera, air, noise, townScale: towns?.scale })
  const { warmUpFrames = WARM_UP_FRAMES } = story
  prepareShadow(air.sun)

  const controls = new GlobeControls(ground, camera, args.frame ? undefined : canvas)
  controls.setEllipsoid(surface.tiles.ellipsoid, surface.tiles.group)
  controls.cameraRadius = EYE_HEIGHT
  controls.maxAltitude = HIGHEST_PITCH + Math.PI / 2
  controls.enableDamping = true
  hidePivot(controls)
  const groundAt = groundHeight(terrain.tiles.group, surface.tiles.group)
  const explorer = args.frame
    ? undefined
    : new Explorer(camera, canvas, {
        groundAt,
        footingAt: position => groundAt(position) + Math.max(story.roofAt?.(position) ?? 0, 0),
        upAt: (position, target) => Ellipsoid.WGS84.surfaceNormal(position, target),
        heightAt: position => Ellipsoid.WGS84.heightAt(position),
        pole: new Vector3(0, 0, 1),
        others: 'right drag turns about a place, Ctrl drags the globe and zooms'
      })
  const endSharing = shareMouse(
    canvas,
    controls,
    () => isLoaded && !explorer?.isWalking && !explorer?.isFlying
  )
  const elapsed = frameClock(args.frame)

  const current = { ...args }
  const up = new Vector3()
  let ready: Promise<void> = Promise.resolve()
  let disposed = false
  let loads = 0
  /** False until the land stands: coarse tiles would lift the camera. */
  let isLoaded = false

  const prepare = (): void => {
    camera.updateMatrixWorld()
    fitGlobeCamera(camera, { depth: renderer.reversedDepthBuffer ? 'reversed' : 'standard' })
    for (const tiles of tilesets) tiles.update()
  }

  const draw = (): void => {
    prepare()
    const altitude = Ellipsoid.WGS84.heightAt(camera.position)
    Ellipsoid.WGS84.surfaceNormal(camera.position, up)
    story.beforeDraw?.(altitude)
    aimShadow(air.sun, camera, Math.max(altitude, 2), up)
    air.render()
  }

  const load = (): void => {
    const count = ++loads
    const isOver = (): boolean => disposed || count !== loads
    ready = loadTiles(tilesets, prepare, isOver).then(async () => {
      if (current.frame && !isOver()) await story.prepare?.()
      for (let i = 0; current.frame && !isOver() && i < warmUpFrames; i++) {
        draw()
        // Passes draw their scene once in an animation frame.
        const isLast = i >= warmUpFrames - WARM_UP_FRAMES
        if (isLast || story.exposure) await new Promise(requestAnimationFrame)
        await story.exposure?.settle()
      }
      if (!isOver()) isLoaded = true
      // Whoever awaits a load that another has cut short awaits that one.
      if (!disposed && isOver()) await ready
    })
    // A failure is reported to whoever awaits `ready`.
    ready.catch(() => {})
  }

  const goTo = (place: Place): void => {
    moveCamera(camera, place)
    controls.setCamera(camera)
    load()
  }

  /** Flies there; a single frame is there at once. */
  const flyTo = (place: Place): void => {
    if (explorer === undefined) goTo(place)
    else void flyToPlace(explorer, camera, place)
  }

  story.apply(current)
  goTo(story.place(current))

  return {
    renderer,
    scene,
    camera,
    explorer,
    get ready() {
      return ready
    },
    get progress() {
      return tilesProgress(tilesets)
    },
    render() {
      const seconds = elapsed()
      if (explorer !== undefined) {
        story.exposure?.adapt(seconds)
        explorer.update(seconds)
        controls.enabled &&= isLoaded && !explorer.isWalking && !explorer.isFlying
        controls.update()
      }
      draw()
    },
    resize(width, height, pixelRatio) {
      fitToCanvas(renderer, camera, width, height, pixelRatio)
      for (const tiles of tilesets) {
        tiles.setResolution(camera, width * pixelRatio, height * pixelRatio)
      }
      load()
    },
    update(changes) {
      const before = story.place(current)
      Object.assign(current, changes)
      story.apply(current)
      const place = story.place(current)
      if (place !== before) flyTo(place)
    },
    dispose() {
      disposed = true
      endSharing()
      explorer?.dispose()
      controls.dispose()
      story.dispose?.()
      surface.dispose()
      towns?.dispose()
      terrain.dispose()
      air.dispose()
      noise.dispose()
      void renderer.dispose()
    }
  }
}

/** The ring that marks the point of a drag has a GLSL material, which WebGPURenderer cannot draw. */
function hidePivot(controls: GlobeControls): void {
  const { pivotMesh } = controls as unknown as { pivotMesh: { material: { visible: boolean } } }
  pivotMesh.material.visible = false
}

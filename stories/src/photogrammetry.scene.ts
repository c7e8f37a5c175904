import {
  aerialPerspective,
  Atmosphere,
  SkyLightProbe,
  SunDirectionalLight,
  surfaceLighting
} from '@welkin/atmosphere'
import { Ellipsoid, fitGlobeCamera } from '@welkin/geo'
import { Group, Object3D, PerspectiveCamera, Scene, Vector3 } from 'three'
import { pass } from 'three/tsl'
import { RenderPipeline } from 'three/webgpu'
import { groundHeight } from './globe/groundHeight'
import { loadTiles, tilesProgress } from './globe/loadTiles'
import { flyToPlace, moveCamera } from './globe/places'
import { aimShadow, prepareShadow } from './globe/sunShadow'
import { Explorer } from './moving/Explorer'
import { overlayOn } from './overlay'
import { SIGHTS, type SightName } from './photogrammetry/places'
import { unlitTiles, type TileSource, type UnlitTiles } from './photogrammetry/unlitTiles'
import { createRenderer, dateOf, exposureOf, fitToCanvas, frameClock } from './scene'
import type { RendererArgs, SceneHandle, TimeArgs } from './scene'

export interface PhotogrammetryArgs extends RendererArgs, TimeArgs, TileSource {
  place: SightName
  /** Share of Welkin's light in the picture. */
  strength: number
  /** Albedo of the photographs' white. */
  albedo: number
}

/** Frames until shadows and exposure are those of the view. */
const STILL_FRAMES = 4

/** Tiles of photographs, lit at any hour: from any server, or local ones. */
export async function createPhotogrammetry(
  canvas: HTMLCanvasElement,
  args: PhotogrammetryArgs
): Promise<SceneHandle<PhotogrammetryArgs>> {
  const renderer = await createRenderer(canvas, args.forceWebGL)
  const scene = new Scene()
  const camera = new PerspectiveCamera(50, 1, 1, 1e7)
  const current = { ...args }
  // #region photogrammetry
  const pipeline = new RenderPipeline(renderer)
  const atmosphere = new Atmosphere({ frame: 'ecef' })
  const sun = new SunDirectionalLight(atmosphere)
  const sky = new SkyLightProbe(atmosphere)
  scene.add(sun, sun.target, sky) // and tiles, whose materials are unlit
  const scenePass = pass(scene, camera, { samples: 0 })
  const depth = scenePass.getTextureNode('depth')
  const lit = surfaceLighting(scenePass.getTextureNode(), depth, camera, [sun, sky])
  pipeline.outputNode = aerialPerspective(lit, depth, camera, atmosphere)
  // #endregion
  prepareShadow(sun)

  const ground = new Group()
  scene.add(ground)
  const note = args.frame ? undefined : overlayOn(canvas)
  const explorer = args.frame
    ? undefined
    : new Explorer(camera, canvas, {
        groundAt: groundHeight(ground, new Object3D()),
        upAt: (position, target) => Ellipsoid.WGS84.surfaceNormal(position, target),
        heightAt: position => Ellipsoid.WGS84.heightAt(position),
        pole: new Vector3(0, 0, 1)
      })
  const elapsed = frameClock(args.frame)
  const up = new Vector3()
  const size = { width: 1, height: 1 }
  let shown: UnlitTiles | undefined
  let ready: Promise<void> = Promise.resolve()
  let loads = 0
  /** True while the tiles on show are of the whole world, whose places one flies to. */
  let isWorld = false
  let reason = ''

  const sourceOf = ({ url, key }: TileSource): TileSource | undefined =>
    url === '' && key === '' ? undefined : { url, key }

  const prepare = (): void => {
    camera.updateMatrixWorld()
    fitGlobeCamera(camera, { depth: renderer.reversedDepthBuffer ? 'reversed' : 'standard' })
    shown?.tiles.update()
  }
  const draw = (): void => {
    prepare()
    const height = Ellipsoid.WGS84.heightAt(camera.position)
    Ellipsoid.WGS84.surfaceNormal(camera.position, up)
    aimShadow(sun, camera, Math.max(height, 2), up)
    pipeline.render()
  }
  const say = (): void => {
    if (note === undefined || shown === undefined) return
    const credits = shown.tiles.getAttributions().filter(({ type }) => type === 'string')
    note.textContent = [reason, ...credits.map(({ value }) => String(value))].join('\n').trim()
    note.style.display = note.textContent === '' ? 'none' : ''
  }

  /** Shows tiles of a source, or local ones if it has none to give. */
  const show = (source: TileSource | undefined): void => {
    const count = ++loads
    shown?.dispose()
    ground.clear()
    isWorld = source !== undefined
    const mine = (shown = unlitTiles(source))
    ground.add(mine.tiles.group)
    mine.tiles.setCamera(camera)
    mine.tiles.setResolution(camera, size.width, size.height)
    if (source === undefined) moveCamera(camera, SIGHTS.local)
    else moveCamera(camera, SIGHTS[current.place])
    const isOver = (): boolean => count !== loads
    ready = loadTiles([mine.tiles], prepare, isOver).then(
      async () => {
        for (let i = 0; current.frame && !isOver() && i < STILL_FRAMES; i++) {
          await new Promise(requestAnimationFrame)
          draw()
        }
      },
      (error: Error) => {
        if (source === undefined) throw error
        if (isOver()) return
        reason = `These tiles could not be loaded, so these are local ones.\n${error.message}`
        show(undefined)
      }
    )
    ready.catch(() => {})
  }
  const showAsked = (): void => {
    const source = sourceOf(current)
    const isOnline = navigator.onLine || source?.url.startsWith(location.origin) === true
    reason = ''
    if (source === undefined)
      reason = 'Local tiles: put a URL and a key into the controls for the world’s.'
    else if (!isOnline) reason = 'No network: these are local tiles.'
    show(isOnline ? source : undefined)
  }

  const apply = (): void => {
    atmosphere.date = dateOf(current.day, current.hour)
    renderer.toneMappingExposure = exposureOf(current.exposure)
    lit.set({ strength: current.strength, albedo: current.albedo })
  }
  apply()
  showAsked()

  return {
    renderer,
    scene,
    camera,
    explorer,
    get ready() {
      return ready
    },
    get progress() {
      return shown === undefined ? 0 : tilesProgress([shown.tiles])
    },
    render() {
      explorer?.update(elapsed())
      draw()
      say()
    },
    resize(width, height, pixelRatio) {
      fitToCanvas(renderer, camera, width, height, pixelRatio)
      Object.assign(size, { width: width * pixelRatio, height: height * pixelRatio })
      if (current.frame) showAsked()
      else shown?.tiles.setResolution(camera, size.width, size.height)
    },
    update(changes) {
      const { url, key, place } = current
      Object.assign(current, changes)
      apply()
      const isOther = url !== current.url || key !== current.key
      if (!isOther && place === current.place) return
      if (isOther || !isWorld || explorer === undefined) showAsked()
      else void flyToPlace(explorer, camera, SIGHTS[current.place])
    },
    dispose() {
      loads++
      explorer?.dispose()
      note?.remove()
      shown?.dispose()
      pipeline.dispose()
      scenePass.dispose()
      lit.dispose()
      for (const light of [sun, sky]) light.dispose()
      atmosphere.dispose()
      void renderer.dispose()
    }
  }
}

import {
  aerialPerspective,
  airglow,
  Atmosphere,
  exposureFor,
  milkyWay,
  moon,
  MoonDirectionalLight,
  NightLightProbe,
  SkyLightProbe,
  stars,
  SunDirectionalLight,
  surfaceLighting
} from '@welkin/atmosphere'
import { CloudCover, cloudPreset, clouds, cloudShadow, cloudSkyLight } from '@welkin/clouds'
import { Ellipsoid, fitGlobeCamera } from '@welkin/geo'
import { Group, Object3D, PerspectiveCamera, Scene, Vector3 } from 'three'
import { pass, shadow } from 'three/tsl'
import { RenderPipeline } from 'three/webgpu'
import { STILL_QUALITY } from './clouds/still'
import { groundHeight } from './globe/groundHeight'
import { flyToView, lookFrom } from './globe/places'
import { aimShadow, prepareShadow } from './globe/sunShadow'
import { Explorer } from './moving/Explorer'
import { overlayOn } from './overlay'
import { KEY, KeptSource, type SourceArgs } from './photogrammetry/KeptSource'
import type { SightName } from './photogrammetry/places'
import { ShownTiles } from './photogrammetry/ShownTiles'
import { createRenderer, dateOf, exposureOf, fitToCanvas, frameClock } from './scene'
import type { RendererArgs, SceneHandle, TimeArgs } from './scene'

export interface PhotogrammetryArgs extends RendererArgs, TimeArgs, SourceArgs {
  place: SightName
  /** Share of Welkin's light in the picture. */
  strength: number
  /** Share of the sky that clouds cover. */
  clouds: number
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
  const luna = moon()
  const moonlight = new MoonDirectionalLight(atmosphere, luna)
  const moonlitSky = new SkyLightProbe(atmosphere, luna.source)
  const night = new NightLightProbe(atmosphere)
  atmosphere.add(milkyWay(), stars(), luna, airglow()) // far before near
  const lights = [sun, sky, moonlight, moonlitSky, night]
  scene.add(...lights, sun.target, moonlight.target) // and tiles, whose materials are unlit
  const scenePass = pass(scene, camera, { samples: 0 })
  const depth = scenePass.getTextureNode('depth')
  const lit = surfaceLighting(scenePass.getTextureNode(), depth, camera, lights)
  const air = aerialPerspective(lit, depth, camera, atmosphere)
  pipeline.outputNode = air
  // #endregion
  // #region clouds over photogrammetry
  const layers = cloudPreset('fairWeather')
  const node = clouds(air, depth, camera, atmosphere, layers)
  pipeline.outputNode = node
  sun.castShadow = moonlight.castShadow = true
  Object.assign(sun.shadow, { shadowNode: cloudShadow(node, shadow(sun)) }) // of tiles and clouds
  Object.assign(moonlight.shadow, { shadowNode: cloudShadow(node, null, luna.source) })
  for (const probe of [sky, moonlitSky, night]) cloudSkyLight(probe, node)
  // #endregion
  prepareShadow(sun)
  const cover = new CloudCover(layers, { light: node.light })
  if (args.frame) {
    node.quality = STILL_QUALITY
    node.field.bake(renderer)
    node.time = 0
  }

  const note = args.frame ? undefined : overlayOn(canvas)
  const group = new Group()
  scene.add(group)
  const explorer = args.frame
    ? undefined
    : new Explorer(camera, canvas, {
        groundAt: groundHeight(group, new Object3D()),
        upAt: (position, target) => Ellipsoid.WGS84.surfaceNormal(position, target),
        heightAt: position => Ellipsoid.WGS84.heightAt(position),
        pole: new Vector3(0, 0, 1)
      })
  const elapsed = frameClock(args.frame)
  const up = new Vector3()
  let ready: Promise<void> = Promise.resolve()

  const prepare = (): void => {
    camera.updateMatrixWorld()
    fitGlobeCamera(camera, { depth: renderer.reversedDepthBuffer ? 'reversed' : 'standard' })
    tiles.update()
  }
  const tiles = new ShownTiles(group, {
    camera,
    get place() {
      return current.place
    },
    prepare,
    goTo(view, flies) {
      if (flies && explorer !== undefined) void flyToView(explorer, camera, view)
      else lookFrom(camera, view)
    }
  })
  const draw = (): void => {
    prepare()
    const height = Ellipsoid.WGS84.heightAt(camera.position)
    Ellipsoid.WGS84.surfaceNormal(camera.position, up)
    aimShadow(sun, camera, Math.max(height, 2), up)
    // Of the light and not of the picture: photographs that nothing lights keep their brightness.
    const exposure = exposureFor(atmosphere, camera, { sources: [luna.source], clouds: cover })
    atmosphere.luminanceScale = 1e-4 * exposure
    pipeline.render()
  }
  const say = (): void => {
    if (note === undefined) return
    note.textContent = tiles.text
    note.style.display = note.textContent === '' ? 'none' : ''
  }
  let asked = 0
  const ask = (): void => {
    const source = kept?.current ?? { url: current.url, key: current[KEY] }
    tiles.ask(source, { onLine: navigator.onLine, origin: location.origin })
    const count = ++asked
    ready = tiles.ready.then(async () => {
      // Exposure takes its numbers from the tables.
      if (current.frame) await atmosphere.bake(renderer)
      // Only what was asked for last is drawn.
      for (let i = 0; current.frame && count === asked && i < STILL_FRAMES; i++) {
        await new Promise(requestAnimationFrame)
        draw()
      }
    })
    ready.catch(() => {})
  }

  const apply = (): void => {
    atmosphere.date = dateOf(current.day, current.hour)
    renderer.toneMappingExposure = exposureOf(current.exposure)
    lit.set({ strength: current.strength, albedo: current.albedo })
    layers.at(0).coverage = current.clouds
  }
  const kept = args.frame ? undefined : new KeptSource(args, ask)
  apply()
  ask()

  const handle: SceneHandle<PhotogrammetryArgs> = {
    renderer,
    scene,
    camera,
    explorer,
    get ready() {
      return ready
    },
    get progress() {
      return tiles.progress
    },
    render() {
      kept?.show(handle.onArgs)
      explorer?.update(elapsed())
      draw()
      say()
    },
    resize(width, height, pixelRatio) {
      fitToCanvas(renderer, camera, width, height, pixelRatio)
      tiles.setSize(width * pixelRatio, height * pixelRatio)
      if (current.frame) ask()
    },
    update(changes) {
      const { place } = current
      Object.assign(current, changes)
      apply()
      if (kept === undefined) ask()
      else if (!kept.take(current) && place !== current.place) tiles.revisit()
    },
    dispose() {
      explorer?.dispose()
      kept?.dispose()
      note?.remove()
      tiles.dispose()
      pipeline.dispose()
      scenePass.dispose()
      lit.dispose()
      node.dispose()
      for (const light of lights) light.dispose()
      atmosphere.dispose()
      void renderer.dispose()
    }
  }
  return handle
}

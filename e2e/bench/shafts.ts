import {
  aerialPerspective,
  aerialPerspectiveFog,
  Atmosphere,
  heightFog,
  forwardShafts,
  lightShafts,
  skyBackground,
  SunDirectionalLight,
  type LightShaftsQuality
} from '@welkin/atmosphere'
import { cloudAirShadow, CloudLightTable, CloudNoise, cloudPreset, clouds } from '@welkin/clouds'
import {
  BoxGeometry,
  HalfFloatType,
  Mesh,
  MeshLambertMaterial,
  PerspectiveCamera,
  PlaneGeometry,
  RenderTarget,
  Scene
} from 'three'
import { CSMShadowNode } from 'three/addons/csm/CSMShadowNode.js'
import { pass } from 'three/tsl'
import { RenderPipeline, type WebGPURenderer } from 'three/webgpu'
import { gpuMilliseconds, nextFrame, release, type HeadlessDevice } from '../headless/device'
import type { Path } from './scene'
import { median } from './statistics'

const WARM_UP = 10
const CLOUDS_WARM_UP = 60

/** Towers along an edge of a city, and their distance [m]. */
const TOWERS = 14
const SPACING = 90

/** Milliseconds of GPU that light shafts add to a frame that has the same shadows. */
export interface ShaftCost {
  path: Path
  cascades: number
  /** Cumulus over the city, which cast into the air, too. */
  withClouds: boolean
  /** Height fog over the city, in which shafts fall, too. */
  withFog?: boolean
  quality: LightShaftsQuality
  withoutMs: number
  shaftsMs: number
}

/** A city, as it is drawn. */
type CityOptions = Pick<ShaftCost, 'path' | 'cascades' | 'withClouds' | 'withFog'> & {
  /** Quality of light shafts; null for none. */
  quality: LightShaftsQuality | null
}

/** Noise and table of light that all clouds here share. */
const shared = { noise: new CloudNoise(), light: new CloudLightTable() }

/** A city under a low sun in a `cascades` of shadow maps, drawn with or without shafts. */
function city(
  renderer: WebGPURenderer,
  size: readonly [number, number],
  { path, cascades, withClouds, withFog, quality }: CityOptions
): { draw: () => void; dispose: () => void } {
  renderer.shadowMap.enabled = true
  const atmosphere = new Atmosphere().setSunAngles(12, 20)
  if (withFog) atmosphere.add(heightFog({ density: 1e-3, falloff: 150 }))
  const scene = new Scene()
  const camera = new PerspectiveCamera(60, size[0] / size[1], 0.5, 20_000)
  camera.position.set(20, 2, 500)
  camera.updateMatrixWorld()
  const material = new MeshLambertMaterial()
  const box = new BoxGeometry(30, 1, 30)
  const add = (mesh: Mesh): void => {
    mesh.castShadow = mesh.receiveShadow = true
    scene.add(mesh)
  }
  for (let i = 0; i < TOWERS ** 2; i++) {
    const tower = new Mesh(box, material)
    const [x, z] = [i % TOWERS, Math.floor(i / TOWERS)]
    tower.scale.y = 40 + 37 * ((7 * i) % 5)
    tower.position.set((x - TOWERS / 2) * SPACING, tower.scale.y / 2, -z * SPACING)
    add(tower)
  }
  add(new Mesh(new PlaneGeometry(20_000, 20_000).rotateX(-Math.PI / 2), material))
  const light = new SunDirectionalLight(atmosphere, 3000)
  light.castShadow = true
  light.shadow.mapSize.setScalar(2048)
  Object.assign(light.shadow.camera, { left: -1500, right: 1500, bottom: -1500, top: 1500 })
  light.shadow.camera.far = 6000
  if (cascades > 1) {
    const shadowNode = new CSMShadowNode(light, { cascades, maxFar: 3000, lightMargin: 2000 })
    Object.assign(light.shadow, { shadowNode })
  }
  scene.add(light, light.target)
  const isForward = path === 'forward'
  const make = isForward ? forwardShafts : lightShafts
  const shafts = quality === null ? undefined : make(atmosphere, camera, light, { quality })
  const scenePass = pass(scene, camera, { samples: 0 })
  const pipeline = new RenderPipeline(renderer)
  if (isForward) {
    if (shafts) atmosphere.add(shafts)
    scene.backgroundNode = skyBackground(atmosphere)
    scene.fogNode = aerialPerspectiveFog(atmosphere)
  } else {
    const [color, depth] = [scenePass.getTextureNode(), scenePass.getTextureNode('depth')]
    const air = aerialPerspective(color, depth, camera, atmosphere, { shafts })
    const layers = cloudPreset('fairWeather')
    const cloudsNode = withClouds
      ? clouds(air, depth, camera, atmosphere, layers, { quality: 'medium', ...shared })
      : undefined
    if (cloudsNode) {
      // As clouds drift, maps of them are drawn anew in some frames and not in others.
      cloudsNode.time = 0
      shafts?.add(cloudAirShadow(cloudsNode))
    }
    pipeline.outputNode = cloudsNode ?? air
  }
  const target = new RenderTarget(size[0], size[1], { type: HalfFloatType })
  return {
    draw: () => {
      nextFrame()
      renderer.setRenderTarget(target)
      if (isForward) renderer.render(scene, camera)
      else pipeline.render()
      renderer.setRenderTarget(null)
    },
    dispose: () => {
      for (const owned of [scenePass, pipeline, target, light, atmosphere]) owned.dispose()
      shafts?.dispose()
    }
  }
}

async function timeCity(
  device: HeadlessDevice,
  size: readonly [number, number],
  frames: number,
  options: CityOptions
): Promise<number> {
  const renderer = await device.renderer(...size)
  const { draw, dispose } = city(renderer, size, options)
  const times: number[] = []
  const warmUp = options.withClouds ? CLOUDS_WARM_UP : WARM_UP
  for (let frame = 0; frame < warmUp + frames; frame++) {
    draw()
    const elapsed = await gpuMilliseconds(renderer)
    if (frame >= warmUp) times.push(elapsed)
  }
  dispose()
  release(renderer)
  return median(times)
}

const cases = [
  { path: 'post', cascades: 1, withClouds: false },
  { path: 'post', cascades: 4, withClouds: false },
  { path: 'post', cascades: 4, withClouds: true },
  { path: 'forward', cascades: 1, withClouds: false },
  { path: 'post', cascades: 4, withClouds: false, withFog: true },
  { path: 'forward', cascades: 4, withClouds: false },
  { path: 'forward', cascades: 4, withClouds: false, withFog: true }
] as const

/** Times light shafts of one shadow map and of four cascades, and under clouds. */
export async function timeShafts(
  device: HeadlessDevice,
  size: readonly [number, number],
  frames: number
): Promise<ShaftCost[]> {
  const costs: ShaftCost[] = []
  for (const what of cases) {
    const withoutMs = await timeCity(device, size, frames, { ...what, quality: null })
    for (const quality of ['low', 'medium', 'high'] as const) {
      const ms = await timeCity(device, size, frames, { ...what, quality })
      costs.push({ ...what, quality, withoutMs, shaftsMs: ms - withoutMs })
    }
  }
  return costs
}

/** A line of a report. */
export const shaftLine = (cost: ShaftCost): string => {
  const { path, cascades, withClouds, withFog, quality, withoutMs, shaftsMs } = cost
  const maps = cascades === 1 ? 'one map' : `${cascades} cascades`
  const casters = `${maps}${withClouds ? ', clouds' : ''}${withFog ? ', fog' : ''}`
  return (
    `${path.padEnd(8)} light shafts, ${casters}, ${quality.padEnd(7)}` +
    ` ${shaftsMs.toFixed(3)} ms   (without ${withoutMs.toFixed(3)} ms)`
  )
}

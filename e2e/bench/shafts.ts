import {
  aerialPerspective,
  aerialPerspectiveFog,
  Atmosphere,
  heightFog,
  forwardShafts,
  lightShafts,
  skyBackground,
  SunDirectionalLight,
  type LightShafts,
  type LightShaftsQuality
} from '@welkin/atmosphere'
import { cloudAirShadow, cloudPreset, clouds, type CloudsNode } from '@welkin/clouds'
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
import { PassTimes } from '../../stories/src/valley/PassTimes'
import { nextFrame, release, type HeadlessDevice } from '../headless/device'
import type { Path } from './scene'
import { median } from './statistics'

/** Frames of a picture before any are timed, and after each change of it. */
const WARM_UP = 40
const SETTLING = 3

/** Times that all qualities are gone through: the clock of a GPU is another one after a second. */
const ROUNDS = 4

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
  /** Passes by name and number, and what each takes more, in the order in which they are drawn [ms]. */
  passes: [name: string, ms: number][]
}

/** A city, as it is drawn. */
type CityOptions = Pick<ShaftCost, 'path' | 'cascades' | 'withClouds' | 'withFog'>

/** A picture of a city. */
interface City {
  readonly shafts: LightShafts | undefined
  draw(): void
  dispose(): void
}

/** A city under a low sun in a `cascades` of shadow maps, drawn with or without shafts; its clouds are made at once. */
async function city(
  renderer: WebGPURenderer,
  size: readonly [number, number],
  { path, cascades, withClouds, withFog }: CityOptions,
  hasShafts: boolean
): Promise<City> {
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
  const shafts = hasShafts ? make(atmosphere, camera, light) : undefined
  const scenePass = pass(scene, camera, { samples: 0 })
  const pipeline = new RenderPipeline(renderer)
  let cloudsNode: CloudsNode | undefined
  if (isForward) {
    if (shafts) atmosphere.add(shafts)
    scene.backgroundNode = skyBackground(atmosphere)
    scene.fogNode = aerialPerspectiveFog(atmosphere)
  } else {
    const [color, depth] = [scenePass.getTextureNode(), scenePass.getTextureNode('depth')]
    const air = aerialPerspective(color, depth, camera, atmosphere, { shafts })
    const layers = cloudPreset('fairWeather')
    if (withClouds) {
      cloudsNode = clouds(air, depth, camera, atmosphere, layers, { quality: 'medium' })
      await cloudsNode.bake(renderer)
      // As clouds drift, maps of them are drawn anew in some frames and not in others.
      cloudsNode.time = 0
      shafts?.add(cloudAirShadow(cloudsNode))
    }
    pipeline.outputNode = cloudsNode ?? air
  }
  const target = new RenderTarget(size[0], size[1], { type: HalfFloatType })
  return {
    shafts,
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
      cloudsNode?.dispose()
    }
  }
}

/** Times of the passes of a frame, numbered among those of their name [ms]. */
async function passesOf(renderer: WebGPURenderer, times: PassTimes): Promise<Map<string, number>> {
  const counts = new Map<string, number>()
  const { passes } = await times.read(renderer)
  return new Map(
    passes.map(([title, ms]) => {
      // three's shadow maps have the numbers of their lights.
      const name = title.replace(/ \[.*\]/, '')
      const count = (counts.get(name) ?? 0) + 1
      counts.set(name, count)
      return [`${name} ${count}`, ms]
    })
  )
}

const qualities = ['low', 'medium', 'high'] as const

/** Times a city without shafts and with those of each quality, in turn. */
async function timeCity(
  device: HeadlessDevice,
  size: readonly [number, number],
  frames: number,
  options: CityOptions
): Promise<ShaftCost[]> {
  const renderer = await device.renderer(...size)
  renderer.shadowMap.enabled = true
  const times = new PassTimes()
  renderer.inspector = times
  const without = await city(renderer, size, options, false)
  const lit = await city(renderer, size, options, true)
  const variants = [without, ...qualities.map(() => lit)].map((drawn, i) => ({
    drawn,
    quality: qualities[i - 1],
    totals: [] as number[],
    passes: new Map<string, number[]>()
  }))
  for (let round = 0; round < ROUNDS; round++) {
    for (const { drawn, quality, totals, passes } of variants) {
      drawn.shafts?.set({ quality })
      const warmUp = round === 0 ? WARM_UP : SETTLING
      for (let frame = 0; frame < warmUp + frames / ROUNDS; frame++) {
        drawn.draw()
        const each = await passesOf(renderer, times)
        if (frame < warmUp) continue
        totals.push([...each.values()].reduce((sum, ms) => sum + ms, 0))
        for (const [name, ms] of each) passes.set(name, [...(passes.get(name) ?? []), ms])
      }
    }
  }
  for (const each of [without, lit]) each.dispose()
  release(renderer)
  const [bare, ...others] = variants.map(({ totals, passes }) => ({
    ms: median(totals),
    passes: new Map([...passes].map(([name, values]) => [name, median(values)]))
  }))
  const costs: ShaftCost[] = []
  for (const [i, { ms, passes }] of others.entries()) {
    costs.push({
      ...options,
      quality: qualities[i],
      withoutMs: bare.ms,
      shaftsMs: ms - bare.ms,
      passes: [...passes].map(([name, each]) => [name, each - (bare.passes.get(name) ?? 0)])
    })
  }
  return costs
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

/** Times light shafts of one shadow map and of four cascades, and under clouds; or those cases alone that are wanted. */
export async function timeShafts(
  device: HeadlessDevice,
  size: readonly [number, number],
  frames: number,
  isWanted: (what: CityOptions) => boolean = () => true
): Promise<ShaftCost[]> {
  const costs: ShaftCost[] = []
  for (const what of cases.filter(isWanted)) {
    costs.push(...(await timeCity(device, size, frames, what)))
  }
  return costs
}

/** Least difference of a pass that a line tells [ms]. */
const LEAST_MS = 0.004

/** A line of a report. */
export const shaftLine = (cost: ShaftCost): string => {
  const { path, cascades, withClouds, withFog, quality, withoutMs, shaftsMs, passes } = cost
  const maps = cascades === 1 ? 'one map' : `${cascades} cascades`
  const casters = `${maps}${withClouds ? ', clouds' : ''}${withFog ? ', fog' : ''}`
  const more = passes
    .filter(([, ms]) => Math.abs(ms) > LEAST_MS)
    .map(([name, ms]) => `${name.replace('Welkin.', '')} ${ms.toFixed(3)}`)
  return (
    `${path.padEnd(8)} light shafts, ${casters}, ${quality.padEnd(7)}` +
    ` ${shaftsMs.toFixed(3)} ms   (without ${withoutMs.toFixed(3)} ms; ${more.join(', ')})`
  )
}

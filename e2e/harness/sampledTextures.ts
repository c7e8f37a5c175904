import {
  Atmosphere,
  SkyLightProbe,
  SunDirectionalLight,
  aerialPerspective,
  aerialPerspectiveFog
} from '@welkin/atmosphere'
import type { SkyLayer } from '@welkin/atmosphere'
import { cloudPreset, clouds, cloudWorldMap } from '@welkin/clouds'
import type { CloudsNode } from '@welkin/clouds'
import {
  DataTexture,
  Mesh,
  MeshStandardMaterial,
  PerspectiveCamera,
  PlaneGeometry,
  RepeatWrapping,
  Scene
} from 'three'
import { pass } from 'three/tsl'
import { RenderPipeline, type Node, type WebGPURenderer } from 'three/webgpu'
import { readFileSync } from 'node:fs'
import { recordingRenderer } from '../headless/recordingContext'
import { traceShaders, type BuiltPipeline } from '../headless/traceShaders'

// What three asks of a browser.
Object.assign(globalThis, {
  self: globalThis,
  requestAnimationFrame: () => 0,
  cancelAnimationFrame: () => undefined
})

/** Frames until a lit material and a pass have all that they sample. */
const FRAMES = 4
/** Name of the lit material. */
export const LIT = 'lit'

/** A picture of one texel, other than all others. */
export function picture(): DataTexture {
  const made = new DataTexture(new Uint8Array(4), 1, 1)
  made.wrapS = RepeatWrapping
  return made
}

/** A lit plane under the sun. */
export class World {
  readonly atmosphere = new Atmosphere().setSunAngles(40, 120)
  readonly camera = new PerspectiveCamera(50, 16 / 9, 1, 1e5)
  readonly scene = new Scene()
  readonly material = new MeshStandardMaterial({ name: LIT })
  readonly sun = new SunDirectionalLight(this.atmosphere, 50)
  readonly sky = new SkyLightProbe(this.atmosphere)
  readonly #pass = pass(this.scene, this.camera, { samples: 0 })
  readonly color = this.#pass.getTextureNode()
  readonly depth = this.#pass.getTextureNode('depth')
  readonly air = aerialPerspective(this.color, this.depth, this.camera, this.atmosphere)

  constructor() {
    const ground = new Mesh(new PlaneGeometry(1, 1), this.material)
    ground.receiveShadow = ground.castShadow = true
    ground.frustumCulled = false
    this.scene.add(ground, this.sun, this.sky)
  }

  clouds(cover: DataTexture | null = null): CloudsNode {
    const worldMap = cover && cloudWorldMap(cover)
    const { air, depth, camera, atmosphere } = this
    return clouds(air, depth, camera, atmosphere, cloudPreset('mixed'), { worldMap })
  }
}

/** Pipelines of some names that are made while something is drawn. */
export async function pipelinesIn(
  names: readonly string[],
  draw: (renderer: WebGPURenderer) => () => void
): Promise<BuiltPipeline[]> {
  const renderer = await recordingRenderer(16, 9)
  renderer.shadowMap.enabled = true
  const built = traceShaders(renderer)
  const frame = draw(renderer)
  for (let i = 0; i < FRAMES; i++) frame()
  await renderer.dispose()
  return built.filter(each => names.includes(each.name))
}

/** Most textures that shaders of pipelines sample. */
export const mostTextures = (built: readonly BuiltPipeline[]): number =>
  Math.max(...built.map(({ fragment }) => fragment.textures))

/** Most textures that shaders of a name sample while something is drawn. */
export async function texturesOf(
  name: string,
  draw: (renderer: WebGPURenderer) => () => void
): Promise<number> {
  return mostTextures(await pipelinesIn([name], draw))
}

/** Most textures of passes of a post effect made of the world, by their names. */
export async function inPasses(
  names: readonly string[],
  effect: (world: World) => Node
): Promise<number[]> {
  const built = await pipelinesIn(names, renderer => {
    const pipeline = new RenderPipeline(renderer)
    pipeline.outputNode = effect(new World())
    return () => pipeline.render()
  })
  return names.map(name => mostTextures(built.filter(each => each.name === name)))
}

/** Textures of the lit material, with something added. */
export const inLit = (add: (world: World) => void): Promise<number> =>
  texturesOf(LIT, renderer => {
    const world = new World()
    add(world)
    return () => renderer.render(world.scene, world.camera)
  })

/** Textures of a pass, by default the last, of a post effect made of the world. */
export const inPass = async (
  effect: (world: World) => Node,
  name = 'RenderPipeline'
): Promise<number> => (await inPasses([name], effect))[0]

/** Textures of the last pass and of the lit material, with layers in the sky. */
export const withLayers = async (layers: () => SkyLayer[]): Promise<[number, number]> => [
  await inPass(({ atmosphere, air }) => {
    atmosphere.add(...layers())
    return air
  }),
  await inLit(({ atmosphere, scene }) => {
    atmosphere.add(...layers())
    scene.fogNode = aerialPerspectiveFog(atmosphere)
  })
]

/** First and second number of a README's row on a feature. */
export function stated(name: string, feature: string): [string, string] {
  const url = new URL(`../../packages/${name}/README.md`, import.meta.url)
  const section = readFileSync(url, 'utf8').split('\n## Textures\n')[1].split('\n## ')[0]
  const row = section.split('\n').find(line => line.startsWith(`| ${feature}`))
  if (row === undefined) throw new Error(`no row begins with: ${feature}`)
  const [, , sky, lit] = row.split('|').map(cell => cell.trim())
  return [sky, lit]
}

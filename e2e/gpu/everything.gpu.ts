import {
  Atmosphere,
  MoonDirectionalLight,
  NightLightProbe,
  SkyLightProbe,
  Stars,
  SunDirectionalLight,
  aerialPerspective,
  aerialPerspectiveFog,
  airglow,
  autoExposure,
  distanceFog,
  droplets,
  heightFog,
  iceCrystals,
  forwardShafts,
  milkyWay,
  moon,
  planetGround,
  raindrops,
  proceduralStars,
  skyBackground,
  skyEnvironment,
  skyVelocity,
  starsOverlay,
  sunFlare
} from '@welkin/atmosphere'
import type { AutoExposureNode, ForwardShafts } from '@welkin/atmosphere'
import {
  DropletLightTable,
  precipitationShafts,
  cloudAirShadow,
  cloudEnvironment,
  cloudPreset,
  clouds,
  cloudShadow,
  cloudSkyLight,
  cloudVelocity,
  cloudWorldMap
} from '@welkin/clouds'
import {
  BoxGeometry,
  DataTexture,
  LinearFilter,
  LinearMipmapLinearFilter,
  Mesh,
  MeshStandardMaterial,
  PerspectiveCamera,
  PlaneGeometry,
  RepeatWrapping,
  Scene
} from 'three'
import type { DirectionalLight, Light, Texture } from 'three'
import { CSMShadowNode } from 'three/addons/csm/CSMShadowNode.js'
import { bloom } from 'three/addons/tsl/display/BloomNode.js'
import { ao } from 'three/addons/tsl/display/GTAONode.js'
import { traa } from 'three/addons/tsl/display/TRAANode.js'
import {
  builtinAOContext,
  convertToTexture,
  mrt,
  normalView,
  output,
  pass,
  screenUV,
  shadow,
  vec4,
  velocity
} from 'three/tsl'
import { NodeMaterial, RenderPipeline, type Node, type WebGPURenderer } from 'three/webgpu'
import { drawForward, drawToFloat, expectLight, random } from './harness/atmosphere'
import type { GpuContext } from './harness/context'
import { expectTrue } from './harness/expect'
import { gpuTest } from './harness/gpu-test'
import { nextFrame } from './harness/graphics'
import { watchFragmentShaders, type FragmentShader } from './harness/shaders'
import { worldMap } from './harness/cloud-scene'
import { coarse } from './harness/cloud-view'

const size = { width: 32, height: 18 }

/** Textures that a stage may sample on WebGPU's default limits and on WebGL2. */
const LIMIT = 16
/** Name of the material that lights and shadows fall on. */
const LIT = 'lit'

/** A small picture, other than all others. */
function picture(seed: number): DataTexture {
  const next = random(seed)
  const bytes = Uint8Array.from({ length: 4 * 16 * 8 }, () => 255 * next())
  const made = new DataTexture(bytes, 16, 8)
  made.wrapS = RepeatWrapping
  made.minFilter = LinearMipmapLinearFilter
  made.magFilter = LinearFilter
  made.generateMipmaps = true
  made.needsUpdate = true
  return made
}

/** Scene with all features at once. */
class World {
  readonly atmosphere = new Atmosphere().place({ longitude: 8, latitude: 46 })
  readonly scene = new Scene()
  readonly camera = new PerspectiveCamera(70, size.width / size.height, 1, 1e7)
  readonly luna = moon({ mapSize: 64 })
  readonly pictures: readonly Texture[] = Array.from({ length: 9 }, (_, i) => picture(i))
  readonly cloudMap = worldMap()
  readonly #pass = pass(this.scene, this.camera, { samples: 0 })
  readonly #pipeline: RenderPipeline
  readonly #sun: SunDirectionalLight
  readonly #lit = new MeshStandardMaterial({ name: LIT, emissive: 0x010101 })
  readonly shafts: ForwardShafts
  readonly exposure: AutoExposureNode
  readonly #clouds
  readonly #cloudEnvironment
  readonly #environment
  readonly #owned: { dispose(): void }[] = []

  /** @param isMapped - True if clouds have a map of the world; else the lit material has six of its own. */
  constructor(
    readonly renderer: WebGPURenderer,
    isMapped: boolean
  ) {
    const { atmosphere, camera, luna, pictures } = this
    renderer.shadowMap.enabled = true
    const [surface, water, nightLights] = pictures
    const catalogue = proceduralStars({ count: 50 })
    atmosphere.luminanceScale = 1e-4
    atmosphere.add(
      sunFlare(),
      milkyWay(),
      new Stars({ catalogue }),
      new Stars({ catalogue, overlay: true }),
      luna,
      airglow(),
      planetGround({ surface, water, nightLights })
    )
    // A moon has a source of light once it is in an atmosphere.
    atmosphere.add(
      heightFog({
        density: 1e-4,
        sources: [luna.source],
        droplets: isMapped ? droplets() : null
      }),
      distanceFog({ density: 1e-5 })
    )
    const depth = this.#pass.getTextureNode('depth')
    const light = (this.#sun = new SunDirectionalLight(atmosphere, 200))
    const shafts = (this.shafts = forwardShafts(atmosphere, camera, light, { quality: 'low' }))
    const drawn = this.#pass.getTextureNode()
    const air = aerialPerspective(drawn, depth, camera, atmosphere, { shafts })
    const layers = cloudPreset('mixed', 4)
    layers.at(3).set({ baseAltitude: 6000, topAltitude: 6500, coverage: 0.3 })
    layers.at(0).set({ precipitation: { rate: 5, hail: 0.2, virgaDepth: 2000 } })
    this.#clouds = clouds(air, depth, camera, atmosphere, layers, {
      quality: coarse,
      worldMap: isMapped ? cloudWorldMap(this.cloudMap) : null,
      light: new DropletLightTable({ crystals: iceCrystals() }),
      precipitation: precipitationShafts({ drops: raindrops() })
    })
    this.#clouds.time = 0
    shafts.add(cloudAirShadow(this.#clouds))
    this.#cloudEnvironment = cloudEnvironment(this.#clouds, { size: 16, quality: coarse })
    this.#environment = skyEnvironment(atmosphere, { overlay: this.#cloudEnvironment, size: 256 })
    this.scene.environmentNode = this.#environment
    this.#addLights()
    this.#addThings(isMapped ? [] : this.pictures.slice(3))
    this.#pipeline = new RenderPipeline(renderer)
    this.#pipeline.outputColorTransform = false
    const { transmittance } = this.#clouds
    const starry = starsOverlay(this.#clouds, depth, camera, atmosphere, { transmittance })
    const finished = isMapped ? this.#finish(starry) : starry
    this.#pipeline.outputNode = this.exposure = autoExposure(finished, atmosphere)
  }

  /** Three's post effects: GTAO dims the light of the sky on things, TRAA smooths the picture, and what is bright glows. */
  #finish(picture: Node): Node {
    const { camera, scene } = this
    const before = pass(scene, camera, { samples: 0 })
    // Only normals are read, and light takes seconds to compile.
    const normals = new NodeMaterial()
    normals.fragmentNode = vec4(normalView, 1)
    before.overrideMaterial = normals
    const occlusion = ao(before.getTextureNode('depth'), before.getTextureNode(), camera)
    this.#pass.contextNode = builtinAOContext(occlusion.getTextureNode().sample(screenUV).r)
    this.#pass.setMRT(mrt({ output, velocity }))
    const depth = this.#pass.getTextureNode('depth')
    const sky = skyVelocity(this.#pass.getTextureNode('velocity'), depth, camera)
    const motion = cloudVelocity(sky, this.#clouds)
    const smooth = traa(convertToTexture(picture), depth, convertToTexture(motion), camera)
    const halo = bloom(smooth, 0.1, 0.5, 2)
    this.#owned.push(before, normals, occlusion, motion, smooth, halo)
    return smooth.add(halo)
  }

  #addLights(): void {
    const { atmosphere, luna } = this
    const sun = this.#sun
    const moonlight = new MoonDirectionalLight(atmosphere, luna, 200)
    for (const light of [sun, moonlight] as DirectionalLight[]) {
      light.castShadow = true
      light.shadow.mapSize.setScalar(64)
    }
    const cascades = new CSMShadowNode(sun, { cascades: 4, maxFar: 400 })
    Object.assign(sun.shadow, { shadowNode: cloudShadow(this.#clouds, cascades) })
    Object.assign(moonlight.shadow, {
      shadowNode: cloudShadow(this.#clouds, shadow(moonlight), luna.source)
    })
    const probes = [new SkyLightProbe(atmosphere), new SkyLightProbe(atmosphere, luna.source)]
    const night = new NightLightProbe(atmosphere)
    for (const probe of [...probes, night]) cloudSkyLight(probe, this.#clouds)
    const lights: Light[] = [sun, moonlight, ...probes, night]
    this.scene.add(...lights)
    this.#owned.push(sun, moonlight, this.shafts)
  }

  #addThings(maps: readonly Texture[]): void {
    const material = this.#lit
    const names = ['map', 'normalMap', 'roughnessMap', 'metalnessMap', 'aoMap', 'emissiveMap']
    maps.forEach((map, i) => Object.assign(material, { [names[i]]: map }))
    const box = new Mesh(new BoxGeometry(20, 20, 20), material)
    box.position.set(0, 8, -60)
    box.castShadow = true
    const floor = new Mesh(new PlaneGeometry(400, 400), material)
    floor.rotation.x = -Math.PI / 2
    for (const mesh of [box, floor]) mesh.receiveShadow = true
    this.scene.add(box, floor)
    this.#owned.push(material, box.geometry, floor.geometry)
  }

  /** Looks at the horizon from an altitude, or down a little [m]. */
  look(altitude: number): void {
    this.camera.position.set(0, altitude, 40)
    this.camera.lookAt(0, altitude > 1e5 ? -2e6 : altitude, -1e7)
    this.camera.updateMatrixWorld()
  }

  /** Sun and moon by their elevations [°]; without the moon's, it is in front of the sun. */
  setLights(sun: number, moonAt: number | null): void {
    const { atmosphere, luna } = this
    atmosphere.setSunAngles(moonAt ?? 0, 20)
    luna.direction = atmosphere.sunDirection
    atmosphere.setSunAngles(sun, 190)
    if (moonAt === null) luna.direction = atmosphere.sunDirection
  }

  /** Draws some frames by the pipeline, of which the last is read back. */
  async draw(frames: number) {
    for (let i = 1; i < frames; i++) {
      await nextFrame()
      this.#pipeline.render()
    }
    await nextFrame()
    return drawToFloat(this.renderer, () => this.#pipeline.render())
  }

  /** Draws the noise of the clouds, so that they are there from the first frame on. */
  async prepare(): Promise<void> {
    await this.#clouds.bake(this.renderer)
  }

  dispose(): void {
    this.#environment.dispose()
    this.#cloudEnvironment.dispose()
    this.#clouds.dispose()
    this.exposure.dispose()
    this.#pipeline.dispose()
    this.#pass.dispose()
    for (const each of [...this.#owned, ...this.pictures, this.cloudMap]) each.dispose()
    this.atmosphere.dispose()
  }
}

/** Fails if a fragment shader samples more textures than may be; says which sample the most. */
function checkTextures(t: GpuContext, shaders: readonly FragmentShader[]): void {
  const counted = shaders.map(({ name, textures, lines }) => ({
    label: `${name || 'unnamed'}: ${textures} textures, ${lines} lines`,
    textures
  }))
  const most = counted.toSorted((a, b) => b.textures - a.textures)
  t.note(
    `most textures: ${most
      .slice(0, 6)
      .map(({ label }) => label)
      .join('; ')}`
  )
  const over = counted.filter(({ textures }) => textures > LIMIT)
  expectTrue(over.length === 0, `too many: ${over.map(({ label }) => label).join('; ')}`)
}

const situations = [
  { name: 'by day on the ground', sun: 35, moon: 20, altitude: 2 },
  { name: 'at dusk at 10 km', sun: -4, moon: 20, altitude: 10_000 },
  { name: 'at night on the ground', sun: -30, moon: 40, altitude: 2 },
  { name: 'in an eclipse on the ground', sun: 35, moon: null, altitude: 2 },
  { name: 'by day in orbit', sun: 35, moon: 20, altitude: 400_000 },
  { name: 'at night in orbit', sun: -60, moon: 60, altitude: 400_000 }
] as const

gpuTest(
  'all that there is draws light at once, under GTAO, TRAA and bloom, and no pass samples more than 16 textures',
  async t => {
    const renderer = await t.createRenderer(size)
    const shaders = watchFragmentShaders(renderer)
    const world = new World(renderer, true)
    await world.prepare()
    for (const { name, sun, moon: moonAt, altitude } of situations) {
      world.setLights(sun, moonAt)
      world.look(altitude)
      const drawn = await world.draw(2)
      expectLight(drawn, name)
      const lit = drawn.data.filter((value, i) => i % 4 < 3 && value > 0).length
      expectTrue(lit > 0.5 * size.width * size.height, `${name}: light in ${lit} numbers only`)
      await world.exposure.settle()
      const { luminance } = world.exposure
      expectTrue(luminance !== null && luminance > 0, `${name}: ${luminance} cd/m² are metered`)
      // Scenes of this size may have no light that half floats hold at another one's exposure.
      world.atmosphere.luminanceScale = 1e-4
    }
    checkTextures(t, shaders)
    world.dispose()
  },
  { timeoutSeconds: 300 }
)

gpuTest(
  'a material with six maps takes environment, four cascades, shadows of moon and clouds, probes and light shafts, under the post chain or in its own haze',
  async t => {
    const renderer = await t.createRenderer(size)
    const shaders = watchFragmentShaders(renderer)
    const world = new World(renderer, false)
    world.setLights(35, 20)
    world.look(20)
    expectLight(await world.draw(1), 'six maps, with air, shafts and clouds as post effects')
    world.scene.backgroundNode = skyBackground(world.atmosphere)
    world.scene.fogNode = aerialPerspectiveFog(world.atmosphere)
    const draw = () => drawForward(renderer, world.scene, world.camera, world.atmosphere)
    expectLight(await draw(), 'six maps')
    world.atmosphere.add(world.shafts)
    await nextFrame()
    const drawn = await draw()
    expectLight(drawn, 'light shafts')
    const [red, green, blue] = drawn.at(size.width >> 1, size.height - 2)
    expectTrue(red > 0 && green > 0 && blue > 0, `the ground is ${red}, ${green}, ${blue}`)
    checkTextures(t, shaders)
    world.dispose()
  },
  { timeoutSeconds: 300 }
)

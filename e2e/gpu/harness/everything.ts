import {
  Atmosphere,
  MoonDirectionalLight,
  NightLightProbe,
  SkyLightProbe,
  Stars,
  SunDirectionalLight,
  SurfaceWater,
  aerialPerspective,
  airStyle,
  airglow,
  autoExposure,
  cascadedShadow,
  distanceFog,
  droplets,
  exposureFor,
  forwardShafts,
  heightFog,
  iceCrystals,
  milkyWay,
  moon,
  planetGround,
  precipitationOverlay,
  proceduralStars,
  raindrops,
  rainfall,
  skyEnvironment,
  skyVelocity,
  snowfall,
  starsOverlay,
  sunFlare,
  surfaceLighting,
  wetSurface
} from '@welkin/atmosphere'
import type { AutoExposureNode, ForwardShafts, Precipitation } from '@welkin/atmosphere'
import {
  DropletLightTable,
  cloudAirShadow,
  cloudEnvironment,
  cloudFogLight,
  cloudPreset,
  clouds,
  cloudShadow,
  cloudSkyLight,
  cloudVelocity,
  cloudWorldMap,
  lightning,
  precipitationShafts
} from '@welkin/clouds'
import type { CloudLayers, CloudsNode, Lightning } from '@welkin/clouds'
import {
  BoxGeometry,
  DataTexture,
  LinearFilter,
  LinearMipmapLinearFilter,
  Mesh,
  PerspectiveCamera,
  PlaneGeometry,
  RepeatWrapping,
  Scene,
  Vector3
} from 'three'
import type { DirectionalLight, Light, Texture } from 'three'
import { CSMShadowNode } from 'three/addons/csm/CSMShadowNode.js'
import { bloom } from 'three/addons/tsl/display/BloomNode.js'
import { ao } from 'three/addons/tsl/display/GTAONode.js'
import { traa } from 'three/addons/tsl/display/TRAANode.js'
import {
  builtinAOContext,
  convertToTexture,
  float,
  materialNormal,
  mrt,
  normalView,
  output,
  pass,
  screenUV,
  shadow,
  vec4,
  velocity
} from 'three/tsl'
import {
  MeshBasicNodeMaterial,
  MeshStandardNodeMaterial,
  NodeMaterial,
  RenderPipeline,
  type Node,
  type WebGPURenderer
} from 'three/webgpu'
import { drawToFloat, random } from './atmosphere'
import { worldMap } from './cloud-scene'
import { coarse } from './cloud-view'
import { filterLeast } from './filter-samples'
import { nextFrame } from './graphics'
import { readPicture, type Picture } from './picture'
import { setShadowSize } from './shadow-size'

export const worldSize = { width: 32, height: 18 }

/** Name of the material that lights and shadows fall on. */
export const LIT = 'lit'

/** Altitude below which a view ray that goes past the planet has air that is as good as opaque: two scale heights higher it has a tenth of its light [m]. */
const AIR = 20_000

/** A small picture, other than all others. */
function picture(seed: number): DataTexture {
  const next = random(seed)
  const bytes = Uint8Array.from({ length: 4 * 16 * 8 }, () => 40 + 215 * next())
  const made = new DataTexture(bytes, 16, 8)
  made.wrapS = RepeatWrapping
  made.minFilter = LinearMipmapLinearFilter
  made.magFilter = LinearFilter
  made.generateMipmaps = true
  made.needsUpdate = true
  return made
}

/** Layers with rain, hail and virga, and with ice, for halos. */
function manyLayers(): CloudLayers {
  const layers = cloudPreset('mixed', 4)
  layers.at(0).set({ precipitation: { rate: 5, hail: 0.2, virgaDepth: 2000 } })
  layers.at(3).set({ baseAltitude: 9000, topAltitude: 9500, coverage: 0.3 })
  return layers
}

/** A node that reads a picture from a texture of its own. */
type Drawn = Node & { readonly renderTarget: Parameters<typeof readPicture>[1] }

/** Scene with all features at once. */
export class World {
  readonly atmosphere = new Atmosphere().place({ longitude: 8, latitude: 46 })
  readonly scene = new Scene()
  readonly camera = new PerspectiveCamera(70, worldSize.width / worldSize.height, 1, 1e7)
  readonly luna = moon({ mapSize: 64 })
  readonly pictures: readonly Texture[] = Array.from({ length: 9 }, (_, i) => picture(i))
  readonly cloudMap = worldMap()
  readonly shafts: ForwardShafts
  readonly exposure: AutoExposureNode
  readonly storm: Lightning
  readonly water = new SurfaceWater()
  readonly #pass = pass(this.scene, this.camera, { samples: 0 })
  readonly #pipeline: RenderPipeline
  readonly #lights
  readonly #lit = new MeshStandardNodeMaterial({ name: LIT, emissive: 0x010101 })
  readonly #clouds: CloudsNode
  readonly #cloudEnvironment
  readonly #environment
  /** Rain and snow before the camera. */
  readonly #falling: readonly Precipitation[]
  /** Picture before the post effects; null without them. */
  #before: Drawn | null = null
  readonly #owned: { dispose(): void }[] = []

  /**
   * @param isMapped - True if clouds have a map of the world and all else that they can have; else they are fair weather's, and the
   *   lit material has six maps of its own.
   */
  constructor(
    readonly renderer: WebGPURenderer,
    isMapped: boolean
  ) {
    const { atmosphere, camera } = this
    setShadowSize('least')
    filterLeast()
    renderer.shadowMap.enabled = true
    const fogs = this.#addLayers(isMapped)
    this.#lights = this.#makeLights()
    const { sun, sky } = this.#lights
    const shafts = (this.shafts = forwardShafts(atmosphere, camera, sun, { quality: 'low' }))
    const depth = this.#pass.getTextureNode('depth')
    const lit = isMapped ? this.#lightUnlit(depth) : this.#pass.getTextureNode()
    // A pass of their own for ground, sky and air: clouds and lightning need room for textures.
    const air = convertToTexture(aerialPerspective(lit, depth, camera, atmosphere, { shafts }))
    const layers = isMapped ? manyLayers() : cloudPreset('fairWeather')
    // Deep enough for lightning.
    layers.at(0).set({ topAltitude: 5000 })
    this.#clouds = clouds(air, depth, camera, atmosphere, layers, {
      quality: coarse,
      ...(isMapped ? this.#wholeClouds() : {})
    })
    this.#clouds.time = 0
    this.storm = lightning(this.#clouds, { limit: null, exposure: 0.5, time: 0 })
    shafts.add(cloudAirShadow(this.#clouds))
    for (const fog of fogs) cloudFogLight(fog, this.#clouds)
    this.#cloudEnvironment = cloudEnvironment(this.#clouds, { size: 16, quality: coarse })
    this.#environment = skyEnvironment(atmosphere, { overlay: this.#cloudEnvironment, size: 256 })
    this.scene.environmentNode = this.#environment
    this.#addLights(isMapped)
    this.#addThings(isMapped)
    const weather = { lights: [sun, sky], depth, depthCamera: camera, maxParticles: 500, time: 10 }
    this.#falling = [
      rainfall(atmosphere, { rate: 12, ...weather }),
      snowfall(atmosphere, { rate: 1, ...weather })
    ]
    this.#pipeline = new RenderPipeline(renderer)
    this.#pipeline.outputColorTransform = false
    const { transmittance } = this.#clouds
    const starry = starsOverlay(convertToTexture(this.#clouds), depth, camera, atmosphere, {
      transmittance
    })
    const finished = isMapped ? this.#finish(starry) : starry
    this.#pipeline.outputNode = this.exposure = autoExposure(finished, atmosphere)
  }

  /** All that clouds can have, which takes long to compile. */
  #wholeClouds() {
    return {
      worldMap: cloudWorldMap(this.cloudMap),
      light: new DropletLightTable({ crystals: iceCrystals() }),
      precipitation: precipitationShafts({ drops: raindrops() })
    }
  }

  #addLayers(isMapped: boolean) {
    const { atmosphere, luna, pictures } = this
    const [surface, water, nightLights] = pictures
    const catalogue = proceduralStars({ count: 50 })
    const style = airStyle()
    Object.assign(style, { haze: 1.2, twilightSaturation: 1.3 })
    atmosphere.add(
      sunFlare(),
      milkyWay(),
      new Stars({ catalogue }),
      new Stars({ catalogue, overlay: true }),
      luna,
      airglow(),
      planetGround({ surface, water, nightLights }),
      style
    )
    // A moon has a source of light once it is in an atmosphere.
    const fogs = [
      heightFog({
        density: 1e-4,
        sources: [luna.source],
        droplets: isMapped ? droplets() : null
      }),
      distanceFog({ density: 1e-5 })
    ]
    atmosphere.add(...fogs)
    return fogs
  }

  #makeLights() {
    const { atmosphere, luna } = this
    return {
      sun: new SunDirectionalLight(atmosphere, 200),
      moonlight: new MoonDirectionalLight(atmosphere, luna, 200),
      sky: new SkyLightProbe(atmosphere),
      moonlitSky: new SkyLightProbe(atmosphere, luna.source),
      night: new NightLightProbe(atmosphere)
    }
  }

  #addLights(isMapped: boolean): void {
    const { luna } = this
    const { sun, moonlight, sky, moonlitSky, night } = this.#lights
    for (const light of [sun, moonlight] as DirectionalLight[]) {
      light.castShadow = true
      light.shadow.mapSize.setScalar(64)
    }
    // Six maps leave no room for three's cascades.
    const options = { cascades: 4, maxFar: 400 }
    const cascades = isMapped ? new CSMShadowNode(sun, options) : cascadedShadow(sun, options)
    Object.assign(sun.shadow, { shadowNode: cloudShadow(this.#clouds, cascades) })
    Object.assign(moonlight.shadow, {
      shadowNode: cloudShadow(this.#clouds, shadow(moonlight), luna.source)
    })
    for (const probe of [sky, moonlitSky, night]) cloudSkyLight(probe, this.#clouds)
    const lights: Light[] = [sun, moonlight, sky, moonlitSky, night, this.storm.light]
    this.scene.add(...lights)
    this.#owned.push(sun, moonlight, this.shafts)
  }

  /** Wet ground and a wet box, and one that is lit as photographed tiles are. */
  #addThings(isMapped: boolean): void {
    const material = this.#lit
    const names = ['map', 'normalMap', 'roughnessMap', 'metalnessMap', 'aoMap', 'emissiveMap']
    if (!isMapped)
      names.forEach((name, i) => Object.assign(material, { [name]: this.pictures[3 + i] }))
    this.water.water = 2
    Object.assign(material, wetSurface(this.water, { normal: materialNormal, time: float(0) }))
    const box = new Mesh(new BoxGeometry(20, 20, 20), material)
    box.position.set(0, 8, -60)
    const floor = new Mesh(new PlaneGeometry(400, 400).rotateX(-Math.PI / 2), material)
    const photographed = new MeshBasicNodeMaterial({ color: 0x999999 })
    photographed.mrtNode = mrt({ unlit: vec4(1) })
    const tile = new Mesh(new BoxGeometry(15, 15, 15), photographed)
    tile.position.set(30, 6, -50)
    for (const mesh of [box, floor]) mesh.receiveShadow = true
    for (const mesh of [box, tile]) mesh.castShadow = true
    this.scene.add(box, floor)
    if (isMapped) this.scene.add(tile)
    const geometries = [box, floor, tile].map(({ geometry }) => geometry)
    this.#owned.push(material, photographed, ...geometries)
  }

  /** The picture with light on what is not lit by its material. */
  #lightUnlit(depth: Node): Node {
    this.#pass.setMRT(mrt({ output, velocity, unlit: vec4(0) }))
    const { sun, moonlight, sky, moonlitSky, night } = this.#lights
    const lights = [sun, moonlight, sky, moonlitSky, night]
    const mask = this.#pass.getTextureNode('unlit').r
    const lit = surfaceLighting(this.#pass.getTextureNode(), depth, this.camera, lights, { mask })
    this.#owned.push(lit)
    return lit
  }

  /**
   * Three's post effects: GTAO dims the light of the sky on things, TRAA smooths the picture, in which rain and snow fall before
   * the camera, and what is bright glows.
   */
  #finish(drawn: Node): Node {
    const { camera, scene } = this
    const before = pass(scene, camera, { samples: 0 })
    // Only normals are read, and light takes seconds to compile.
    const normals = new NodeMaterial()
    normals.fragmentNode = vec4(normalView, 1)
    before.overrideMaterial = normals
    const occlusion = ao(before.getTextureNode('depth'), before.getTextureNode(), camera)
    this.#pass.contextNode = builtinAOContext(occlusion.getTextureNode().sample(screenUV).r)
    const depth = this.#pass.getTextureNode('depth')
    const sky = skyVelocity(this.#pass.getTextureNode('velocity'), depth, camera)
    const motion = cloudVelocity(sky, this.#clouds)
    const rainy = convertToTexture(precipitationOverlay(drawn, camera, this.#falling))
    this.#before = rainy as unknown as Drawn
    const smooth = traa(rainy, depth, convertToTexture(motion), camera)
    const halo = bloom(smooth, 0.1, 0.5, 2)
    this.#owned.push(before, normals, occlusion, motion, smooth, halo)
    return smooth.add(halo)
  }

  /** Looks at the horizon from an altitude, or down a little [m]. */
  look(altitude: number): void {
    this.camera.position.set(0, altitude, 40)
    this.camera.lookAt(0, altitude > 1e5 ? -2e6 : altitude, -1e7)
    this.camera.updateMatrixWorld()
  }

  /** True for pixels that ground or air fills, wherever TRAA's jitter has them: by the ray a pixel above. */
  readonly isAir = (x: number, y: number): boolean => {
    const { camera, atmosphere } = this
    const { width, height } = worldSize
    const place = new Vector3((2 * (x + 0.5)) / width - 1, 1 - (2 * (y - 0.5)) / height, 0.5)
    const direction = place.unproject(camera).sub(camera.position).normalize()
    const radius = atmosphere.parameters.bottomRadius
    const [from, cosView] = [radius + camera.position.y, direction.y]
    const lowest = cosView < 0 ? from * Math.sqrt(1 - cosView * cosView) : from
    return lowest - radius < AIR
  }

  /** Sun and moon by their elevations [°]; without the moon's, it is in front of the sun. */
  setLights(sun: number, moonAt: number | null): void {
    const { atmosphere, luna } = this
    atmosphere.setSunAngles(moonAt ?? 0, 20)
    luna.direction = atmosphere.sunDirection
    atmosphere.setSunAngles(sun, 190)
    if (moonAt === null) luna.direction = atmosphere.sunDirection
  }

  /** Scales luminance for the light at the camera, so that half floats hold it, and has the environment drawn at once. */
  expose(): void {
    const { atmosphere, camera, luna } = this
    this.#environment.needsRedraw = true
    const options = { sources: [luna.source] }
    atmosphere.luminanceScale = 1e-4 * exposureFor(atmosphere, camera, options)
  }

  /** Draws a frame by the pipeline, and reads it back. */
  async draw(): Promise<Picture> {
    await nextFrame()
    return drawToFloat(this.renderer, () => this.#pipeline.render())
  }

  /** The last frame before the post effects, and before it is exposed. */
  async beforeEffects(): Promise<Picture> {
    return readPicture(this.renderer, this.#before!.renderTarget)
  }

  /** Draws the noise of the clouds, so that they are there from the first frame on, and the tables of the air. */
  async prepare(): Promise<void> {
    await this.#clouds.bake(this.renderer)
    await this.atmosphere.bake(this.renderer)
  }

  dispose(): void {
    for (const each of this.#falling) each.dispose()
    this.storm.dispose()
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

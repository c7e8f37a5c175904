import {
  aerialPerspective,
  airglow,
  airStyle,
  Atmosphere,
  distanceFog,
  heightFog,
  lightShafts,
  milkyWay,
  moon,
  MoonDirectionalLight,
  NightLightProbe,
  planetGround,
  precipitationOverlay,
  proceduralStars,
  rainfall,
  SkyLightProbe,
  snowfall,
  Stars,
  starsOverlay,
  SunDirectionalLight,
  sunFlare,
  surfaceLighting
} from '@welkin/atmosphere'
import type { Moon, SkyLayer, SurfaceLightingNode } from '@welkin/atmosphere'
import { CloudLayers, clouds, lightning, precipitationShafts } from '@welkin/clouds'
import type { CloudQuality } from '@welkin/clouds'
import { Terrain } from '@welkin/terrain'
import {
  BoxGeometry,
  FloatType,
  Mesh,
  MeshStandardMaterial,
  NearestFilter,
  PerspectiveCamera,
  PlaneGeometry,
  Scene,
  Vector3
} from 'three'
import type { Light } from 'three'
import { ao } from 'three/addons/tsl/display/GTAONode.js'
import {
  builtinAOContext,
  mix,
  mrt,
  normalView,
  output,
  pass,
  rtt,
  screenUV,
  uniform,
  vec4
} from 'three/tsl'
import {
  MeshBasicNodeMaterial,
  NodeMaterial,
  RenderPipeline,
  type Node,
  type WebGPURenderer
} from 'three/webgpu'
import { drawToFloat } from './atmosphere'
import { coarse, fog, SparseNoise } from './cloud-view'
import { nextFrame } from './graphics'
import { hills } from './ground'
import type { Picture } from './picture'
import { featureNames, hours, type FeatureName, type Hour } from './predict'

export const featureSize = { width: 32, height: 18 }

/** Longitude and latitude of the stage [°]. */
const PLACE = [8, 46] as const
/** Time over which light of a flash is gathered [s]. */
const EXPOSURE = 0.5

/** Hills of a terrain: their wavelength, and half of the height between valleys and summits [m]. */
const HILLS = [8192, 400] as const

/** Options of a texture whose pixels are read as they are: bilinear look-ups of software mix in 1/256 of a bright neighbour. */
const exactly = { type: FloatType, minFilter: NearestFilter, magFilter: NearestFilter }

/** Steps so short that their random offsets, others in each frame, do not show. */
const fine: CloudQuality = {
  ...coarse,
  steps: 320,
  stepGrowth: 0.004,
  shortestStep: 4,
  depthStep: 0.05,
  layerSteps: 48,
  block: 1
}

/**
 * White light in all directions, behind all media of the sky and bright beside what is there by night: how much of it passes tells what media
 * let through.
 */
class Whiteness implements SkyLayer {
  readonly strength = uniform(0)
  readonly isAdditive = true

  below(): ReturnType<NonNullable<SkyLayer['below']>> {
    return { isSeen: this.strength.greaterThan(0), light: () => vec4(this.strength) }
  }
}

/** Radiance of white surfaces, and of a white sky over the sun's irradiance: some thousands by night, and skies end at 60,000. */
const WHITE = { surface: 1000, sky: 5e-4 }

/** Layers of the sky, far before near, and media last. */
function skyLayers(luna: Moon) {
  return {
    stars: new Stars({ catalogue: proceduralStars({ count: 3000 }) }),
    starsOverlay: new Stars({ catalogue: proceduralStars({ count: 3000 }), overlay: true }),
    milkyWay: milkyWay(),
    airglow: airglow(),
    sunFlare: sunFlare(),
    moon: luna,
    ground: planetGround(),
    haze: airStyle(),
    heightFog: heightFog(),
    distanceFog: distanceFog()
  }
}

/** A box on a floor before the sky, with any of the features. */
export class FeatureStage {
  readonly atmosphere = new Atmosphere().place({ longitude: PLACE[0], latitude: PLACE[1] })
  readonly #scene = new Scene()
  readonly #camera = new PerspectiveCamera(70, featureSize.width / featureSize.height, 1, 1e5)
  readonly #pass = pass(this.#scene, this.#camera, { samples: 0, type: FloatType })
  readonly #pipeline: RenderPipeline
  /** The moon that is seen, and that of moonlight: one may be there without the other. */
  readonly #moons = [moon({ mapSize: 32 }), moon({ mapSize: 32 })] as const
  readonly #layers = skyLayers(this.#moons[0])
  readonly #lights
  readonly #sky = new SkyLightProbe(this.atmosphere)
  readonly #shafts
  readonly #terrain
  readonly #tiles
  /** Rain and snow before the camera. */
  readonly #drops
  readonly #storm
  /** Strength of the ambient occlusion. */
  readonly #occlusion = uniform(0)
  readonly #air: { plain: Node; shafts: Node }
  readonly #whiteness = new Whiteness()
  /** Materials of what is in the scene but the terrain, and what has them shine white. */
  readonly #glowing: ((light: number) => void)[] = []
  readonly #cloudLayers = new CloudLayers([{ ...fog, baseAltitude: 300, density: 1e-3 }])
  readonly #clouds
  readonly #depth
  readonly #owned: { dispose(): void }[] = []
  #names: readonly FeatureName[] = []
  #compiled = ''

  constructor(readonly renderer: WebGPURenderer) {
    const { atmosphere } = this
    const [scene, camera] = [this.#scene, this.#camera]
    for (const each of this.#moons) each.attach(atmosphere)
    renderer.shadowMap.enabled = true
    const sun = new SunDirectionalLight(atmosphere, 400)
    sun.castShadow = true
    sun.shadow.mapSize.setScalar(64)
    const { camera: box } = sun.shadow
    box.left = box.bottom = -300
    box.right = box.top = 300
    const moonlight = new MoonDirectionalLight(atmosphere, this.#moons[1], 400)
    const nightLight = new NightLightProbe(atmosphere)
    this.#lights = { moonlight, nightLight }
    scene.add(sun, this.#sky, moonlight, nightLight)
    const material = new MeshStandardMaterial({ name: 'lit', roughness: 1 })
    material.emissive.set(0xffffff)
    material.emissiveIntensity = 0
    this.#glowing.push(light => (material.emissiveIntensity = light))
    const tower = new Mesh(new BoxGeometry(60, 120, 60), material)
    tower.position.set(-60, 60, -250)
    tower.castShadow = true
    const floor = new Mesh(new PlaneGeometry(1200, 1200).rotateX(-Math.PI / 2), material)
    for (const mesh of [tower, floor]) mesh.receiveShadow = true
    scene.add(tower, floor)
    camera.position.set(0, 40, 0)
    camera.updateMatrixWorld()

    const depth = (this.#depth = this.#pass.getTextureNode('depth'))
    const sky = this.#sky
    const drawn = (this.#tiles = this.#lightTiles(depth, [sun, sky]))
    this.#occlude()
    this.#terrain = this.#addTerrain()
    const shafts = (this.#shafts = lightShafts(atmosphere, camera, sun))
    this.#air = {
      plain: aerialPerspective(drawn, depth, camera, atmosphere),
      shafts: aerialPerspective(drawn, depth, camera, atmosphere, { shafts })
    }
    const noise = new SparseNoise()
    const precipitation = precipitationShafts()
    const options = { quality: fine, noise, time: 0, accumulates: false, precipitation }
    this.#clouds = clouds(this.#air.shafts, depth, camera, atmosphere, this.#cloudLayers, options)
    const storm = lightning(this.#clouds, { limit: null, exposure: EXPOSURE, time: 0, seed: 9 })
    this.#storm = storm
    // From then on the flash stays as it is.
    storm.addEventListener('strike', () => (storm.time = EXPOSURE))
    storm.strike({ kind: 'ground', at: new Vector3(300, 0, -3000) })
    const weather = { lights: [sun, sky], depth, depthCamera: camera, maxParticles: 4000, time: 10 }
    this.#drops = [rainfall, snowfall].map(falls => falls(atmosphere, { rate: 0, ...weather }))
    this.#pipeline = new RenderPipeline(renderer)
    this.#pipeline.outputColorTransform = false
    this.#owned.push(sun, moonlight, nightLight, shafts, noise, material)
    this.#owned.push(tower.geometry, floor.geometry, storm, ...this.#drops)
  }

  /** A box that is not lit by its material, as a photographed one, and the light on it. */
  #lightTiles(depth: Node, lights: Light[]): SurfaceLightingNode {
    const photographed = new MeshBasicNodeMaterial({ color: 0x888888 })
    photographed.mrtNode = mrt({ unlit: vec4(1) })
    const color = photographed.color.clone()
    this.#glowing.push(light => photographed.color.copy(color).addScalar(light))
    const tile = new Mesh(new BoxGeometry(60, 60, 60), photographed)
    tile.position.set(90, 30, -250)
    this.#scene.add(tile)
    this.#pass.setMRT(mrt({ output, unlit: vec4(0) }))
    const mask = this.#pass.getTextureNode('unlit').r
    this.#owned.push(photographed, tile.geometry)
    const drawn = this.#pass.getTextureNode()
    return surfaceLighting(drawn, depth, this.#camera, lights, { mask, strength: 0 })
  }

  /** Three's ambient occlusion, as the README has it. */
  #occlude(): void {
    const before = pass(this.#scene, this.#camera, { samples: 0 })
    const normals = new NodeMaterial()
    normals.fragmentNode = vec4(normalView, 1)
    before.overrideMaterial = normals
    const [depth, normal] = [before.getTextureNode('depth'), before.getTextureNode()]
    const occlusion = ao(depth, normal, this.#camera)
    occlusion.radius.value = 40
    const { r } = occlusion.getTextureNode().sample(screenUV)
    this.#pass.contextNode = builtinAOContext(mix(1, r, this.#occlusion))
    this.#owned.push(before, normals, occlusion)
  }

  #addTerrain(): Terrain {
    const [longitude, latitude] = PLACE
    const height = new Terrain(this.atmosphere, hills(...HILLS)).heightAt(longitude, latitude)
    const options = { pageMemory: 20, seaLevel: -Infinity }
    const terrain = new Terrain(this.atmosphere, hills(...HILLS, height + 10), options)
    this.#scene.add(terrain)
    this.#owned.push(terrain)
    return terrain
  }

  /** Makes the ground and the tables of the air. */
  async prepare(): Promise<void> {
    const { renderer } = this
    await renderer.init()
    await this.atmosphere.bake(renderer)
    this.#terrain.update(renderer, this.#camera, Infinity)
    // A flash has light from the frame after its first on.
    this.show(['lightning'])
    for (let i = 0; i < 8 && !this.#storm.isFlashing; i++) await this.draw(hours[2], 0)
  }

  /**
   * Shows some features, and no others.
   *
   * @param others - Others are there but off, or absent. If they are there shaders stay as they are. The ground has no
   *   switch.
   */
  show(names: readonly FeatureName[], others: 'off' | 'absent' = 'off'): void {
    const on = (name: FeatureName): number => (names.includes(name) ? 1 : 0)
    this.#names = names
    const { stars, milkyWay: galaxy, airglow: glow, sunFlare: flare } = this.#layers
    stars.intensity = 30 * on('stars')
    this.#layers.starsOverlay.intensity = 30 * on('starsOverlay')
    galaxy.intensity = on('milkyWay')
    glow.intensity = on('airglow')
    flare.set({ innerStrength: 0.006 * on('sunFlare'), outerStrength: 0.004 * on('sunFlare') })
    this.#layers.haze.haze = 1 + on('haze')
    this.#layers.heightFog.density = 2e-3 * on('heightFog')
    this.#layers.distanceFog.density = 1e-3 * on('distanceFog')
    this.#lights.moonlight.intensity = on('moonlight')
    this.#lights.nightLight.intensity = on('nightLight')
    this.#shafts.enabled = on('shafts') === 1
    // They rain.
    const falling = on('clouds') === 1 ? { rate: 3 } : null
    this.#cloudLayers.at(0).set({ coverage: on('clouds'), precipitation: falling })
    this.#occlusion.value = on('occlusion')
    this.#tiles.strength = on('surfaceLighting')
    this.#terrain.visible = on('terrain') === 1
    this.#storm.enabled = on('lightning') === 1
    for (const [i, rate] of [25, 1].entries()) this.#drops[i].rate = rate * on('drops')
    const isThere = (name: FeatureName): boolean =>
      names.includes(name) || (others === 'off' && name !== 'ground')
    this.#compile(featureNames.filter(isThere))
  }

  /** Has shaders know some features. */
  #compile(names: readonly FeatureName[]): void {
    if (names.join(' ') === this.#compiled) return
    this.#compiled = names.join(' ')
    const { atmosphere } = this
    atmosphere.remove(...atmosphere.layers)
    atmosphere.add(this.#whiteness)
    for (const name of names) {
      const layer = (this.#layers as Partial<Record<FeatureName, SkyLayer>>)[name]
      if (layer !== undefined) atmosphere.add(layer)
    }
    for (const [name, light] of Object.entries(this.#lights)) {
      light.removeFromParent()
      if (names.includes(name as FeatureName)) this.#scene.add(light)
    }
    const air = names.includes('shafts') ? this.#air.shafts : this.#air.plain
    this.#clouds.colorNode = air
    const hasClouds = names.includes('clouds') || names.includes('lightning')
    const picture = hasClouds ? this.#clouds : air
    const dimming = hasClouds ? { transmittance: this.#clouds.transmittance } : {}
    const starry = names.includes('starsOverlay')
      ? starsOverlay(picture, this.#depth, this.#camera, atmosphere, dimming)
      : picture
    this.#pipeline.outputNode = names.includes('drops')
      ? precipitationOverlay(rtt(starry, null, null, exactly), this.#camera, this.#drops)
      : starry
    this.#pipeline.needsUpdate = true
  }

  /** Has all that media may be in front of shine white, or as it is. */
  set isWhite(value: boolean) {
    this.#whiteness.strength.value = value ? WHITE.sky : 0
    for (const glow of this.#glowing) glow(value ? WHITE.surface : 0)
  }

  /** @param warmUp - Frames before: three's shadows are those of two frames before, in a pass. */
  async draw(hour: Hour, warmUp: number): Promise<Picture> {
    const { atmosphere } = this
    atmosphere.setSunAngles(hour.moon, -20)
    const above = atmosphere.sunDirection.clone()
    const [seen, shining] = this.#moons
    shining.direction = above
    // Under the ground there is none to be seen.
    seen.direction = this.#names.includes('moon') ? above : new Vector3(0, -1, 0)
    atmosphere.setSunAngles(hour.sun, 25)
    atmosphere.luminanceScale = hour.scale
    this.#clouds.quality = { ...coarse, block: 1 }
    for (let i = 0; i < warmUp; i++) {
      await nextFrame()
      this.#pipeline.render()
    }
    this.#clouds.quality = fine
    await nextFrame()
    return drawToFloat(this.renderer, () => this.#pipeline.render())
  }

  dispose(): void {
    this.#clouds.dispose()
    this.#pipeline.dispose()
    this.#pass.dispose()
    for (const each of this.#owned) each.dispose()
    for (const layer of Object.values<SkyLayer>(this.#layers)) layer.dispose?.()
    this.atmosphere.dispose()
  }
}

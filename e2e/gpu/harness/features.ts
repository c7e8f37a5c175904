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
  proceduralStars,
  SkyLightProbe,
  Stars,
  starsOverlay,
  SunDirectionalLight,
  sunFlare
} from '@welkin/atmosphere'
import type { Moon, SkyLayer } from '@welkin/atmosphere'
import { CloudLayers, clouds } from '@welkin/clouds'
import type { CloudQuality } from '@welkin/clouds'
import {
  BoxGeometry,
  FloatType,
  Mesh,
  MeshStandardMaterial,
  PerspectiveCamera,
  PlaneGeometry,
  Scene,
  Vector3
} from 'three'
import { pass } from 'three/tsl'
import { RenderPipeline, type Node, type WebGPURenderer } from 'three/webgpu'
import { drawToFloat } from './atmosphere'
import { coarse, fog, SparseNoise } from './cloud-view'
import { nextFrame } from './graphics'
import type { Picture } from './picture'

export const featureSize = { width: 32, height: 18 }

/**
 * Action of a feature on what the others draw: adds its light to theirs; dims it and adds its own; changes it where it changes
 * the picture; bends it everywhere, so that nothing is known of pixels that others change.
 */
export type Action = 'adds' | 'dims' | 'changes' | 'bends'

/** Features that may be on together, and how each acts. */
export const features = {
  stars: 'adds',
  starsOverlay: 'adds',
  milkyWay: 'adds',
  airglow: 'adds',
  sunFlare: 'adds',
  nightLight: 'adds',
  moonlight: 'adds',
  moon: 'changes',
  ground: 'changes',
  haze: 'bends',
  shafts: 'changes',
  heightFog: 'dims',
  distanceFog: 'dims',
  clouds: 'dims'
} as const satisfies Record<string, Action>

export type FeatureName = keyof typeof features

/** Far before near, and media last. */
export const featureNames = Object.keys(features) as FeatureName[]

/** Hours that features are drawn at, by the elevations of sun and moon [°]. */
export const hours = [
  { name: 'by day', sun: 25, moon: 40, scale: 1e-4 },
  { name: 'at dusk', sun: -4, moon: 20, scale: 1e-1 },
  { name: 'at night', sun: -30, moon: 30, scale: 1e2 }
] as const

export type Hour = (typeof hours)[number]

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
  readonly atmosphere = new Atmosphere().place({ longitude: 8, latitude: 46 })
  readonly #scene = new Scene()
  readonly #camera = new PerspectiveCamera(70, featureSize.width / featureSize.height, 1, 1e5)
  readonly #pass = pass(this.#scene, this.#camera, { samples: 0, type: FloatType })
  readonly #pipeline: RenderPipeline
  /** The moon that is seen, and that of moonlight: one may be there without the other. */
  readonly #moons = [moon({ mapSize: 32 }), moon({ mapSize: 32 })] as const
  readonly #layers = skyLayers(this.#moons[0])
  readonly #lights
  readonly #shafts
  readonly #air: { plain: Node; shafts: Node }
  readonly #cloudLayers = new CloudLayers([{ ...fog, baseAltitude: 300, density: 1e-3 }])
  readonly #clouds
  readonly #depth
  readonly #owned: { dispose(): void }[]
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
    scene.add(sun, new SkyLightProbe(atmosphere), moonlight, nightLight)
    const material = new MeshStandardMaterial({ name: 'lit', roughness: 1 })
    const tower = new Mesh(new BoxGeometry(60, 120, 60), material)
    tower.position.set(-60, 60, -250)
    tower.castShadow = true
    const floor = new Mesh(new PlaneGeometry(1200, 1200).rotateX(-Math.PI / 2), material)
    for (const mesh of [tower, floor]) mesh.receiveShadow = true
    scene.add(tower, floor)
    camera.position.set(0, 40, 0)
    camera.updateMatrixWorld()

    const depth = (this.#depth = this.#pass.getTextureNode('depth'))
    const drawn = this.#pass.getTextureNode()
    const shafts = (this.#shafts = lightShafts(atmosphere, camera, sun))
    this.#air = {
      plain: aerialPerspective(drawn, depth, camera, atmosphere),
      shafts: aerialPerspective(drawn, depth, camera, atmosphere, { shafts })
    }
    const noise = new SparseNoise()
    const options = { quality: fine, noise, time: 0, accumulates: false }
    this.#clouds = clouds(this.#air.shafts, depth, camera, atmosphere, this.#cloudLayers, options)
    this.#pipeline = new RenderPipeline(renderer)
    this.#pipeline.outputColorTransform = false
    this.#owned = [sun, moonlight, nightLight, shafts, noise, material]
    this.#owned.push(tower.geometry, floor.geometry)
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
    this.#cloudLayers.at(0).set({ coverage: on('clouds') })
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
    const hasClouds = names.includes('clouds')
    const picture = hasClouds ? this.#clouds : air
    const dimming = hasClouds ? { transmittance: this.#clouds.transmittance } : {}
    this.#pipeline.outputNode = names.includes('starsOverlay')
      ? starsOverlay(picture, this.#depth, this.#camera, atmosphere, dimming)
      : picture
    this.#pipeline.needsUpdate = true
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

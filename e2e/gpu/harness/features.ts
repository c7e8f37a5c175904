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
  SunDirectionalLight,
  sunFlare
} from '@welkin/atmosphere'
import type { SkyLayer } from '@welkin/atmosphere'
import { CloudLayers, clouds } from '@welkin/clouds'
import {
  BoxGeometry,
  FloatType,
  Mesh,
  MeshStandardMaterial,
  type Object3D,
  PerspectiveCamera,
  PlaneGeometry,
  Scene
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

/** A box on a floor before the sky, with any of the features. */
export class FeatureStage {
  readonly atmosphere = new Atmosphere().place({ longitude: 8, latitude: 46 })
  readonly #scene = new Scene()
  readonly #camera = new PerspectiveCamera(70, featureSize.width / featureSize.height, 1, 1e5)
  readonly #pass = pass(this.#scene, this.#camera, { samples: 0, type: FloatType })
  readonly #pipeline: RenderPipeline
  readonly #moon = moon({ mapSize: 32 })
  readonly #layers: Partial<Record<FeatureName, SkyLayer>>
  readonly #objects: Partial<Record<FeatureName, Object3D>>
  readonly #air: { plain: Node; shafts: Node }
  readonly #clouds
  readonly #owned: { dispose(): void }[]

  constructor(readonly renderer: WebGPURenderer) {
    const { atmosphere } = this
    const [scene, camera, luna] = [this.#scene, this.#camera, this.#moon.attach(atmosphere)]
    renderer.shadowMap.enabled = true
    this.#layers = {
      stars: new Stars({ catalogue: proceduralStars({ count: 3000 }), intensity: 30 }),
      milkyWay: milkyWay(),
      airglow: airglow(),
      sunFlare: sunFlare(),
      moon: luna,
      ground: planetGround(),
      haze: airStyle({ haze: 2 }),
      heightFog: heightFog({ density: 2e-3 }),
      distanceFog: distanceFog({ density: 1e-3 })
    }
    const sun = new SunDirectionalLight(atmosphere, 400)
    sun.castShadow = true
    sun.shadow.mapSize.setScalar(64)
    const { camera: box } = sun.shadow
    box.left = box.bottom = -300
    box.right = box.top = 300
    const moonlight = new MoonDirectionalLight(atmosphere, luna, 400)
    const nightLight = new NightLightProbe(atmosphere)
    this.#objects = { moonlight, nightLight }
    scene.add(sun, new SkyLightProbe(atmosphere))
    const material = new MeshStandardMaterial({ name: 'lit', roughness: 1 })
    const tower = new Mesh(new BoxGeometry(60, 120, 60), material)
    tower.position.set(-60, 60, -250)
    tower.castShadow = true
    const floor = new Mesh(new PlaneGeometry(1200, 1200).rotateX(-Math.PI / 2), material)
    for (const mesh of [tower, floor]) mesh.receiveShadow = true
    scene.add(tower, floor)
    camera.position.set(0, 40, 0)
    camera.updateMatrixWorld()

    const depth = this.#pass.getTextureNode('depth')
    const drawn = this.#pass.getTextureNode()
    const shafts = lightShafts(atmosphere, camera, sun)
    this.#air = {
      plain: aerialPerspective(drawn, depth, camera, atmosphere),
      shafts: aerialPerspective(drawn, depth, camera, atmosphere, { shafts })
    }
    const layers = new CloudLayers([{ ...fog, baseAltitude: 300, density: 1e-3 }])
    const noise = new SparseNoise()
    const options = { quality: coarse, noise, time: 0, accumulates: false }
    this.#clouds = clouds(this.#air.plain, depth, camera, atmosphere, layers, options)
    this.#pipeline = new RenderPipeline(renderer)
    this.#pipeline.outputColorTransform = false
    this.#owned = [sun, moonlight, shafts, noise, material, tower.geometry, floor.geometry]
  }

  /** Shows some features, and no others. */
  show(names: readonly FeatureName[]): void {
    const { atmosphere } = this
    const isOn = (name: FeatureName): boolean => names.includes(name)
    atmosphere.remove(...atmosphere.layers)
    for (const name of featureNames) {
      const [layer, object] = [this.#layers[name], this.#objects[name]]
      if (layer !== undefined && isOn(name)) atmosphere.add(layer)
      if (object !== undefined) object.removeFromParent()
      if (object !== undefined && isOn(name)) this.#scene.add(object)
    }
    const air = isOn('shafts') ? this.#air.shafts : this.#air.plain
    this.#clouds.colorNode = air
    this.#pipeline.outputNode = isOn('clouds') ? this.#clouds : air
    this.#pipeline.needsUpdate = true
  }

  async draw({ sun, moon: moonAt, scale }: (typeof hours)[number]): Promise<Picture> {
    const { atmosphere } = this
    atmosphere.setSunAngles(moonAt, -20)
    this.#moon.direction = atmosphere.sunDirection
    atmosphere.setSunAngles(sun, 25)
    atmosphere.luminanceScale = scale
    // three's shadows are those of two frames before, in a pass.
    for (let i = 0; i < 2; i++) {
      await nextFrame()
      this.#pipeline.render()
    }
    await nextFrame()
    return drawToFloat(this.renderer, () => this.#pipeline.render())
  }

  dispose(): void {
    this.#clouds.dispose()
    this.#pipeline.dispose()
    this.#pass.dispose()
    for (const each of this.#owned) each.dispose()
    for (const layer of Object.values(this.#layers)) layer.dispose?.()
    this.atmosphere.dispose()
  }
}

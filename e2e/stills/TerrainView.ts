import {
  aerialPerspectiveFog,
  Atmosphere,
  autoExposure,
  cascadedShadow,
  skyBackground,
  SkyLightProbe,
  SunDirectionalLight,
  type AutoExposureNode
} from '@welkin/atmosphere'
import { Lake, MountainHeights, Terrain, type GroundMaps } from '@welkin/terrain'
import { MathUtils, PerspectiveCamera, RenderTarget, Scene } from 'three'
import { pass } from 'three/tsl'
import { RenderPipeline, type WebGPURenderer } from 'three/webgpu'
import { LAKES } from '../../stories/src/terrain/lakes'
import { Vegetation } from '../../stories/src/terrain/vegetation/Vegetation'
import { cobbles } from './cobbles'
import type { TerrainStill } from './terrains'
import { readPicture } from './readPicture'

/** Half width of the shadow map about the camera, distance to which trees cast shadows, and distance of the light [m]. */
const SHADOW_EXTENT = 150
const SHADOW_REACH = 900
const LIGHT_DISTANCE = 2000

/** The procedural planet, as the terrain's quick start draws it. The renderer has a reversed depth buffer and high precision. */
export class TerrainView {
  readonly #target: RenderTarget
  readonly #atmosphere: Atmosphere
  readonly #sun: SunDirectionalLight
  readonly #terrain: Terrain
  readonly #maps: GroundMaps | null = null
  readonly #plants: Vegetation | null = null
  readonly #lakes: Lake[]
  readonly #camera: PerspectiveCamera
  readonly #pipeline: RenderPipeline
  readonly #exposure: AutoExposureNode

  constructor(
    readonly renderer: WebGPURenderer,
    { terrain: view }: TerrainStill,
    [width, height]: readonly [number, number]
  ) {
    this.#target = new RenderTarget(width, height)
    const atmosphere = (this.#atmosphere = new Atmosphere())
    const { longitude, latitude } = view
    atmosphere.place({ longitude, latitude })
    atmosphere.setSunAngles(view.sun.elevation, view.sun.azimuth)
    const terrain = (this.#terrain = new Terrain(atmosphere, new MountainHeights({ seed: 513 }), {
      maps: view.cobbles ? (this.#maps = cobbles()) : null
    }))
    terrain.castShadow = terrain.receiveShadow = true
    const camera = (this.#camera = new PerspectiveCamera(55, width / height, 0.1, 1e8))
    camera.near = Math.max(view.height / 20, 0.05)
    camera.position.y = terrain.heightAt(longitude, latitude) + view.height
    camera.rotation.set(MathUtils.degToRad(view.pitch), -MathUtils.degToRad(view.heading), 0, 'YXZ')
    camera.updateProjectionMatrix()
    camera.updateMatrixWorld()

    const scene = new Scene()
    const sun = (this.#sun = this.#sunAt(camera, view.plants === true))
    scene.add(sun, sun.target, new SkyLightProbe(atmosphere), terrain)
    scene.add(...(this.#lakes = LAKES.map(lake => new Lake(terrain, lake))))
    if (view.plants) scene.add((this.#plants = new Vegetation(renderer, terrain)))
    scene.backgroundNode = skyBackground(atmosphere)
    scene.fogNode = aerialPerspectiveFog(atmosphere)
    this.#exposure = autoExposure(pass(scene, camera, { samples: 4 }), atmosphere)
    this.#pipeline = new RenderPipeline(renderer)
    this.#pipeline.outputNode = this.#exposure
  }

  #sunAt(camera: PerspectiveCamera, hasTrees: boolean): SunDirectionalLight {
    const sun = new SunDirectionalLight(this.#atmosphere, LIGHT_DISTANCE)
    sun.castShadow = true
    sun.shadow.mapSize.setScalar(hasTrees ? 2048 : 4096)
    const extent = SHADOW_EXTENT
    Object.assign(sun.shadow.camera, { left: -extent, right: extent, top: extent, bottom: -extent })
    Object.assign(sun.shadow.camera, { near: 1, far: 2 * LIGHT_DISTANCE })
    sun.shadow.normalBias = 0.1
    const cascades = { cascades: 4, maxFar: SHADOW_REACH }
    if (hasTrees) Object.assign(sun.shadow, { shadowNode: cascadedShadow(sun, cascades) })
    sun.target.position.copy(camera.position)
    return sun
  }

  /** Luminance that it is exposed for [cd/m²]. */
  get luminance(): number {
    return this.#exposure.luminance ?? NaN
  }

  /** Exposes the next picture as the last one asks for. */
  async expose(): Promise<void> {
    await this.#exposure.settle()
  }

  /** Draws all pages: the first picture is full. */
  bake(): void {
    this.#terrain.update(this.renderer, this.#camera, Infinity)
    this.#plants?.update(this.#camera, 0, Infinity)
  }

  draw(): void {
    this.renderer.setRenderTarget(this.#target)
    this.#pipeline.render()
    this.renderer.setRenderTarget(null)
  }

  /** Picture of the canvas as a viewer sees it, RGBA, rows top-down. */
  picture(): Promise<Uint8Array> {
    return readPicture(this.renderer, this.#target)
  }

  dispose(): void {
    this.#pipeline.dispose()
    this.#exposure.dispose()
    this.#terrain.dispose()
    for (const lake of this.#lakes) lake.dispose()
    this.#maps?.dispose()
    this.#plants?.dispose()
    this.#sun.dispose()
    this.#atmosphere.dispose()
    this.#target.dispose()
  }
}

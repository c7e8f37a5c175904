import {
  aerialPerspective,
  airglow,
  Atmosphere,
  autoExposure,
  milkyWay,
  moon,
  MoonDirectionalLight,
  NightLightProbe,
  planetGround,
  SkyLightProbe,
  standardEarthParameters,
  stars,
  SunDirectionalLight,
  sunFlare,
  type AutoExposureNode
} from '@welkin/atmosphere'
import {
  ConeGeometry,
  Group,
  MathUtils,
  Mesh,
  MeshStandardMaterial,
  PerspectiveCamera,
  PlaneGeometry,
  Scene
} from 'three'
import { pass } from 'three/tsl'
import { RenderPipeline, type WebGPURenderer } from 'three/webgpu'
import { nextFrame } from './graphics'

/** A scene that exposure is judged by. */
export interface ExposureScene {
  name: string
  /** Elevation of the sun in the north [°]; or a date, which sets moon and stars too. */
  sun: number | Date
  /** Camera above the ellipsoid [m]; its azimuth, clockwise from north, and pitch [°]. */
  altitude: number
  azimuth: number
  pitch: number
  /** Albedo of plain and hills; none from orbit. */
  albedo?: number
}

/** A moonless and a moonlit night in Tokyo. */
const newMoon = new Date('2026-06-14T14:00:00Z')
const nearFullMoon = new Date('2026-06-28T14:00:00Z')

const low = { altitude: 2, azimuth: 0, pitch: 3 }

export const days: readonly ExposureScene[] = [
  { name: 'sun 2° up, faced', sun: 2, albedo: 0.2, ...low },
  { name: 'dusk', sun: -4, albedo: 0.2, ...low },
  { name: 'snow at noon', sun: 60, albedo: 0.85, ...low, azimuth: 120, pitch: -5 },
  { name: 'orbit over the terminator', sun: -4, altitude: 400_000, azimuth: 0, pitch: -22 }
]

export const nights: readonly ExposureScene[] = [
  { name: 'moonlit valley', sun: nearFullMoon, albedo: 0.2, ...low, azimuth: 60 },
  { name: 'starry night', sun: newMoon, albedo: 0.2, ...low, azimuth: 150, pitch: 18 }
]

/** A plain and hills on it, of one material. */
function plainAndHills(material: MeshStandardMaterial): Group {
  // Some software clips two large triangles away.
  const plain = new Mesh(new PlaneGeometry(60_000, 60_000, 64, 64).rotateX(-Math.PI / 2), material)
  const hills = Array.from({ length: 24 }, (_, i) => {
    const hill = new Mesh(new ConeGeometry(1500, 300 + 40 * (i % 5), 24), material)
    hill.position.setFromSphericalCoords(5000 + 900 * (i % 3), Math.PI / 2, (i * Math.PI) / 12)
    return hill
  })
  return new Group().add(plain, ...hills)
}

/** Scenes as an application draws them, with an exposure that meters them: days, or nights, share their shaders. */
export class ExposureStage {
  readonly atmosphere = new Atmosphere({ parameters: standardEarthParameters() })
  readonly exposure: AutoExposureNode
  readonly #renderer: WebGPURenderer
  readonly #pipeline: RenderPipeline
  readonly #camera: PerspectiveCamera
  readonly #material = new MeshStandardMaterial({ roughness: 1 })
  readonly #land = plainAndHills(this.#material)

  /** @param hasNight - True for a sky with moon and stars, false for one with the sun's flare. */
  constructor(renderer: WebGPURenderer, hasNight: boolean) {
    const { atmosphere } = this
    this.#renderer = renderer
    const { width, height } = renderer.domElement
    this.#camera = new PerspectiveCamera(55, width / height)
    atmosphere.place({ longitude: 139.77, latitude: 35.68 })
    atmosphere.add(planetGround())
    const scene = new Scene()
    scene.add(new SunDirectionalLight(atmosphere), new SkyLightProbe(atmosphere), this.#land)
    if (hasNight) {
      const luna = moon({ mapSize: 64 })
      atmosphere.add(milkyWay(), stars(), luna, airglow())
      scene.add(new MoonDirectionalLight(atmosphere, luna), new NightLightProbe(atmosphere))
      scene.add(new SkyLightProbe(atmosphere, luna.source))
    } else {
      atmosphere.add(sunFlare())
    }
    const scenePass = pass(scene, this.#camera, { samples: 0 })
    const depth = scenePass.getTextureNode('depth')
    const color = aerialPerspective(scenePass.getTextureNode(), depth, this.#camera, atmosphere)
    this.exposure = autoExposure(color, atmosphere)
    this.#pipeline = new RenderPipeline(renderer)
    this.#pipeline.outputNode = this.exposure
  }

  /** Has a scene drawn from now on: nothing is compiled anew. */
  show({ sun, altitude, azimuth, pitch, albedo }: ExposureScene): void {
    const { atmosphere } = this
    const camera = this.#camera
    camera.far = albedo === undefined ? 2e7 : 1e5
    camera.near = camera.far / 1e5
    camera.updateProjectionMatrix()
    camera.position.y = altitude
    camera.rotation.order = 'YXZ'
    camera.rotation.x = MathUtils.degToRad(pitch)
    camera.rotation.y = -MathUtils.degToRad(azimuth)
    camera.updateMatrixWorld()
    if (sun instanceof Date) atmosphere.date = sun
    else atmosphere.setSunAngles(sun, 0)
    this.#land.visible = albedo !== undefined
    this.#material.color.setScalar(albedo ?? 0)
  }

  /** Draws frames, and adapts to each at once. */
  async settle(frames: number): Promise<void> {
    for (let i = 0; i < frames; i++) {
      await nextFrame()
      this.draw()
      await this.exposure.settle()
    }
  }

  draw(): void {
    this.#pipeline.render()
  }

  /** Has a change of the renderer's tone mapping compiled. */
  refresh(): void {
    this.#pipeline.needsUpdate = true
  }

  dispose(): void {
    this.#renderer.setRenderTarget(null)
    this.exposure.dispose()
    this.#pipeline.dispose()
    this.atmosphere.dispose()
  }
}

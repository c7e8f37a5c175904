import {
  airglow,
  Atmosphere,
  exposureFor,
  milkyWay,
  NightLightProbe,
  skyBackground,
  stars
} from '@welkin/atmosphere'
import { eciToECEF } from '@welkin/geo'
import {
  BoxGeometry,
  BufferGeometry,
  CircleGeometry,
  Float32BufferAttribute,
  LineBasicMaterial,
  LineSegments,
  Matrix4,
  Mesh,
  MeshStandardMaterial,
  PerspectiveCamera,
  Scene,
  Vector3
} from 'three'
import { CONSTELLATIONS } from './night/constellations'
import type { Constellation, ConstellationName } from './night/constellations'
import { Explorer } from './moving/Explorer'
import { travel, TURN_SECONDS } from './moving/travel'
import { changeOf, createRenderer, exposureOf, frameClock } from './scene'
import type { RendererArgs, SceneHandle } from './scene'
import { storyHandle } from './storyHandle'

export interface NightArgs extends RendererArgs {
  constellation: ConstellationName
  /** Vertical [degrees]. */
  fieldOfView: number
  /** Draw the lines of a star chart, from its own places of the stars. */
  chart: boolean
  /** [stops], 0 as `exposureFor` says. */
  exposure: number
}

/** Gap between a constellation's lines and its stars [rad]. */
const GAP = 0.012

const CHART_RADIUS = 500

/** Stars over a dark plain, with an atlas's lines to compare them with. */
export async function createNight(
  canvas: HTMLCanvasElement,
  args: NightArgs
): Promise<SceneHandle<NightArgs>> {
  const renderer = await createRenderer(canvas, args.forceWebGL)
  const scene = new Scene()
  const camera = new PerspectiveCamera(args.fieldOfView, 1, 0.1, 20_000)
  camera.position.set(0, 2, 0)
  const explorer = args.frame ? undefined : new Explorer(camera, canvas)
  const elapsed = frameClock(args.frame)
  const current = { ...args }

  const ground = new Mesh(
    new CircleGeometry(10_000, 96).rotateX(-Math.PI / 2),
    new MeshStandardMaterial({ color: '#7d7a6d', roughness: 1 })
  )
  const house = new Mesh(
    new BoxGeometry(6, 4, 6),
    new MeshStandardMaterial({ color: '#b8b4a8', roughness: 1 })
  )
  const lines = new LineSegments(new BufferGeometry(), new LineBasicMaterial({ fog: false }))
  lines.frustumCulled = false
  scene.add(ground, house, lines)

  // #region night
  const atmosphere = new Atmosphere()
  atmosphere.add(milkyWay(), stars(), airglow()) // far before near
  const night = new NightLightProbe(atmosphere) // nights are dark, not black
  scene.add(night)
  scene.backgroundNode = skyBackground(atmosphere)
  // #endregion

  const toWorld = new Matrix4()
  const direction = (ascension: number, declination: number): Vector3 => {
    const [a, d] = [(ascension * Math.PI) / 12, (declination * Math.PI) / 180]
    const level = Math.cos(d)
    const v = new Vector3(level * Math.cos(a), level * Math.sin(a), Math.sin(d))
    return v.transformDirection(toWorld)
  }

  const drawChart = (chart: Constellation): Vector3 => {
    const places = chart.stars.map(([, ascension, declination]) =>
      direction(ascension, declination)
    )
    const ends = chart.lines.flatMap(([from, to]) => {
      const [a, b] = [places[from], places[to]]
      const part = GAP / a.angleTo(b)
      return [a.clone().lerp(b, part), b.clone().lerp(a, part)].flatMap(v =>
        v.normalize().multiplyScalar(CHART_RADIUS).toArray()
      )
    })
    lines.geometry.dispose()
    lines.geometry = new BufferGeometry()
    lines.geometry.setAttribute('position', new Float32BufferAttribute(ends, 3))
    return places.reduce((sum, v) => sum.add(v), new Vector3()).normalize()
  }

  const isAimedAnew = changeOf()
  /** Undefined before the first constellation, which is in sight at once. */
  let mover: Explorer | undefined
  const apply = (): void => {
    const chart = CONSTELLATIONS[current.constellation]
    atmosphere.place(chart.place)
    atmosphere.date = new Date(chart.date)
    toWorld.copy(atmosphere.worldToECEF).invert().multiply(eciToECEF(atmosphere.date))
    if (isAimedAnew([current.constellation])) {
      const middle = drawChart(chart)
      const turn = (moved: PerspectiveCamera): void =>
        moved.lookAt(middle.clone().add(moved.position))
      travel(mover, camera, turn, TURN_SECONDS)
      house.position.set(middle.x, 0, middle.z).setLength(25).setY(2)
      house.position.x += 9
    }
    camera.fov = current.fieldOfView
    camera.updateProjectionMatrix()
    lines.visible = current.chart
    lines.material.color.set('#3d6f96')
  }
  apply()
  mover = explorer

  const draw = (): void => {
    explorer?.update(elapsed())
    camera.updateMatrixWorld()
    lines.position.copy(camera.position)
    // #region night exposure
    atmosphere.luminanceScale = 1e-4 * exposureFor(atmosphere, camera) // as the camera moves
    // #endregion
    atmosphere.luminanceScale *= exposureOf(current.exposure)
    renderer.render(scene, camera)
  }

  return storyHandle({
    renderer,
    scene,
    camera,
    explorer,
    current,
    apply,
    draw,
    dispose() {
      atmosphere.dispose()
      night.dispose()
      for (const { geometry, material } of [ground, house, lines]) {
        geometry.dispose()
        material.dispose()
      }
    }
  })
}

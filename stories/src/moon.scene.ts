import { moon, MoonDirectionalLight, SkyLightProbe, sunFlare } from '@welkin/atmosphere'
import {
  BoxGeometry,
  CircleGeometry,
  ConeGeometry,
  Mesh,
  MeshStandardMaterial,
  PerspectiveCamera,
  Scene,
  SphereGeometry,
  Vector3
} from 'three'
import { renderGroup, uniform } from 'three/tsl'
import { Air } from './air'
import { Explorer } from './moving/Explorer'
import { travel, TURN_SECONDS } from './moving/travel'
import { randomSequence } from './random'
import { changeOf, createRenderer, dateOf, disposeMeshes, exposureOf, frameClock } from './scene'
import type { RendererArgs, SceneHandle } from './scene'
import { storyHandle } from './storyHandle'

export interface MoonArgs extends RendererArgs {
  /** [degrees] */
  longitude: number
  /** [degrees] */
  latitude: number
  /** A moment of the day [ms since 1970]. */
  day: number
  /** Hour of that day, UTC [h]. */
  hour: number
  /** Takes `phase` instead of the date's phase. */
  setPhase: boolean
  /** 0 new, 0.5 full, 1 new. */
  phase: number
  /** Target of the camera. */
  target: 'moon' | 'sun'
  /** Angle from the target down to the middle of the picture [degrees]. */
  lower: number
  /** Vertical field of view [degrees]. */
  fieldOfView: number
  /** [stops], 0 for daylight. */
  exposure: number
  /** Lights on the land; none draws the sky alone. Takes effect when the scene is made. */
  lights: 'sun' | 'moon' | 'both' | 'none'
  /** Width of the map of the moon's ground [texels]. */
  mapSize: number
}

/** Key of what takes a new scene. */
export const sceneKey = ({ lights, mapSize }: MoonArgs): string => `${lights} ${mapSize}`

const GROUND_RADIUS = 15_000

/** Suffices for a small picture, and takes a sixteenth of the time [texels]. */
const FRAME_MAP_SIZE = 256

/** Light that eyes are adapted to, as it shows in the picture. */
const MIDDLE_GREY = 0.17

/** Distance from shadow casters to the light [m]. */
const SHADOW_DISTANCE = 150

/** A meadow with trees and a hut. */
function populate(scene: Scene): Mesh[] {
  const ground = new Mesh(
    new CircleGeometry(GROUND_RADIUS, 96).rotateX(-Math.PI / 2),
    new MeshStandardMaterial({ color: '#6c7058', roughness: 0.95 })
  )
  const meshes: Mesh[] = [ground]
  const next = randomSequence(7)
  const needles = new MeshStandardMaterial({ color: '#3d4a33', roughness: 1 })
  const cone = new ConeGeometry(1, 3, 9)
  for (let i = 0; i < 90; i++) {
    const tree = new Mesh(cone, needles)
    const size = 2 + 3 * next()
    const [angle, distance] = [2 * Math.PI * next(), 40 + 260 * next() ** 1.5]
    tree.position.set(distance * Math.sin(angle), size * 1.5, distance * Math.cos(angle))
    tree.scale.setScalar(size)
    meshes.push(tree)
  }
  const wall = new MeshStandardMaterial({ color: '#d8d4c8', roughness: 0.9 })
  const hut = new Mesh(new BoxGeometry(7, 4, 5), wall)
  hut.position.set(14, 2, 22)
  const ball = new Mesh(new SphereGeometry(1.5, 48, 32), wall)
  ball.position.set(-8, 1.5, 16)
  meshes.push(hut, ball)
  for (const mesh of meshes) mesh.castShadow = mesh.receiveShadow = true
  ground.castShadow = false
  scene.add(...meshes)
  return meshes
}

export async function createMoon(
  canvas: HTMLCanvasElement,
  args: MoonArgs
): Promise<SceneHandle<MoonArgs>> {
  const sight = { luminanceScale: uniform(1), adaptation: uniform(1), strength: uniform(1) }
  for (const each of Object.values(sight)) each.setGroup(renderGroup) // for all materials
  const renderer = await createRenderer(canvas, args.forceWebGL, false, false, sight)
  const scene = new Scene()
  const camera = new PerspectiveCamera(40, 1, 0.5, 2 * GROUND_RADIUS)
  camera.position.set(0, 1.8, 0)
  const explorer = args.frame ? undefined : new Explorer(camera, canvas)
  const elapsed = frameClock(args.frame)
  const meshes = args.lights === 'none' ? [] : populate(scene)
  const current = { ...args }
  const air = new Air(renderer, scene, camera, args.path)
  const { atmosphere } = air
  const mapSize = args.frame ? Math.min(args.mapSize, FRAME_MAP_SIZE) : args.mapSize
  // #region moon
  // #shown const luna = moon() // where the date has it, in its phase
  const luna = moon({ mapSize }) // #hidden
  atmosphere.add(sunFlare(), luna) // far before near

  const moonlight = new MoonDirectionalLight(atmosphere, luna, 150) // 150 m from its target
  const moonlitSky = new SkyLightProbe(atmosphere, luna.source)
  moonlight.castShadow = true
  scene.add(moonlight, moonlight.target, moonlitSky)
  // #endregion
  air.sun.visible = air.sky.visible = args.lights === 'sun' || args.lights === 'both'
  moonlight.visible = moonlitSky.visible = args.lights === 'moon' || args.lights === 'both'
  for (const light of [air.sun, moonlight]) {
    const { shadow } = light
    light.distance = SHADOW_DISTANCE
    shadow.mapSize.setScalar(1024)
    shadow.camera.left = shadow.camera.bottom = -60
    shadow.camera.right = shadow.camera.top = 60
    shadow.camera.far = 2 * SHADOW_DISTANCE
    shadow.normalBias = 0.1
  }

  const aim = new Vector3()
  const isAimedAnew = changeOf()
  const isMoved = changeOf()
  const lookAtTarget = (moved: PerspectiveCamera): void => {
    const { direction } = luna.seenFrom(moved.position)
    aim.copy(current.target === 'moon' ? direction : atmosphere.sunDirection)
    const level = Math.hypot(aim.x, aim.z)
    const elevation = Math.atan2(aim.y, level) - (current.lower * Math.PI) / 180
    const [east, south] = [aim.x / level, aim.z / level]
    const across = Math.cos(elevation)
    aim.set(east * across, Math.sin(elevation), south * across)
    moved.lookAt(aim.add(moved.position))
  }
  const apply = (): void => {
    const { longitude, latitude, day, hour, target, lower } = current
    atmosphere.place(current)
    atmosphere.date = dateOf(day, hour)
    luna.phase = current.setPhase ? current.phase : null
    // What else changes leaves the view as one has turned it.
    const isAimedElsewhere = isAimedAnew([target, lower])
    // Through a telescope one follows what moves on.
    if (isMoved([longitude, latitude, day, hour])) travel(explorer, camera, lookAtTarget, 0)
    else if (isAimedElsewhere) travel(explorer, camera, lookAtTarget, TURN_SECONDS)
    camera.fov = current.fieldOfView
    camera.updateProjectionMatrix()
    // Not in the tone mapping: half floats hold neither a night's light nor the sun's disc.
    atmosphere.luminanceScale = 1e-4 * exposureOf(current.exposure)
    sight.luminanceScale.value = atmosphere.luminanceScale
    sight.adaptation.value = MIDDLE_GREY / atmosphere.luminanceScale
  }
  apply()

  const draw = (): void => {
    explorer?.update(elapsed())
    air.render()
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
      moonlight.dispose()
      moonlitSky.dispose()
      air.dispose()
      disposeMeshes(meshes)
    }
  })
}

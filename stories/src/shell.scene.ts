import {
  airlessParameters,
  AtmosphereParameters,
  AtmosphereShell,
  marsParameters,
  titanParameters
} from '@welkin/atmosphere'
import {
  BoxGeometry,
  Color,
  DirectionalLight,
  Group,
  Mesh,
  MeshStandardMaterial,
  PerspectiveCamera,
  Scene,
  SphereGeometry,
  Vector3
} from 'three'
import type { Texture } from 'three'
import { earthPictures } from './globe/earthPictures'
import { Explorer } from './moving/Explorer'
import { Descent } from './shell/Descent'
import { boardCockpit, coarseGlobe, isAboard, landingGround, toZenith } from './shell/descentPath'
import { landingMaterial } from './shell/landingMaterial'
import { changeOf, createRenderer, disposeMeshes, exposureOf, frameClock } from './scene'
import type { RendererArgs, SceneHandle } from './scene'
import { storyHandle } from './storyHandle'

export interface ShellArgs extends RendererArgs {
  /** A map of a few bodies, the view out of a cockpit, or the way from one to the other and down to the ground. */
  view: 'map' | 'cockpit' | 'descent'
  model: 'tables' | 'single-scattering'
  /** Elevation of the sun above the cockpit's horizon, or its azimuth around the map [degrees]. */
  sun: number
  /** Height of the cockpit above the ground [m]. */
  height: number
  /** Part of the descent at which it begins, in [0, 1]. */
  descent: number
  /** [stops], 0 for daylight. */
  exposure: number
}

/** Sunlight on a plane that faces it [lx], as bright as the sky's tables have it at scale 1e-4. */
const SUNLIGHT = 13

/** Rotation of the bodies that turns Africa to the map's camera [rad]. */
const LONGITUDE = -1.6

/** A kilometre in the cockpit's world [world units]. */
const KILOMETER = 1

/** Radius of the cockpit's Earth [world units]. */
const EARTH_RADIUS = 6378.137 * KILOMETER

/** Moves over the cockpit's Earth, or among the map's bodies, whose unit is an Earth's radius. */
function explore(
  view: ShellArgs['view'],
  camera: PerspectiveCamera,
  canvas: HTMLCanvasElement,
  bodies: readonly Mesh[]
): Explorer {
  const metersPerUnit = view === 'map' ? 6378_137 : 1000 / KILOMETER
  const heightAbove = ({ position, scale }: Mesh, place: Vector3): number =>
    (place.distanceTo(position) - scale.x) * metersPerUnit
  if (view === 'map') {
    // There is no ground to come down to among them, and up is up.
    const heightAt = (place: Vector3): number =>
      Math.min(...bodies.map(body => heightAbove(body, place)))
    return new Explorer(camera, canvas, { metersPerUnit, heightAt, groundAt: () => NaN })
  }
  const [earth] = bodies
  return new Explorer(camera, canvas, {
    metersPerUnit,
    upAt: (place, target) => target.copy(place).sub(earth.position).normalize(),
    heightAt: place => heightAbove(earth, place)
  })
}

/** Bodies of the map: air, radius, place and colour; the Earth's radius is 1, and its picture has its colours. */
const BODIES = [
  [() => new AtmosphereParameters(), 1, [-1.3, 0, 0], '#ffffff'],
  [marsParameters, 0.53, [0.75, 0.3, 0.4], '#8a4a26'],
  [titanParameters, 0.4, [2.1, -0.5, -0.3], '#6b4a20'],
  [airlessParameters, 0.27, [0.4, -0.75, 1], '#77736c']
] as const

/** A sphere of radius 1; or what can be seen of it from 400 km over its pole, in faces that are flat to metres. */
function globeGeometry(view: ShellArgs['view']): SphereGeometry {
  return view === 'cockpit'
    ? new SphereGeometry(1, 512, 256, 0, 2 * Math.PI, 0, 0.4)
    : new SphereGeometry(1, 256, 128)
}

/** Bodies with shells of air, and no sky, no background, no post pass. */
export async function createShell(
  canvas: HTMLCanvasElement,
  args: ShellArgs
): Promise<SceneHandle<ShellArgs>> {
  const renderer = await createRenderer(canvas, args.forceWebGL)
  const scene = new Scene()
  scene.background = new Color(0x000000)
  const camera = new PerspectiveCamera(45, 1, 0.001, 1e5)
  const light = new DirectionalLight(0xffffff, SUNLIGHT)
  scene.add(light, light.target)
  const { model } = args
  const earth = args.view === 'cockpit' ? null : await earthPictures()
  const meshes: Mesh[] = []
  const shells: AtmosphereShell[] = []

  const add = (
    parameters: AtmosphereParameters,
    radius: number,
    position: Vector3,
    color: string,
    map: Texture | null = null
  ): void => {
    const ball = new Mesh(
      globeGeometry(args.view),
      new MeshStandardMaterial({ color, map, roughness: 1 })
    )
    ball.scale.setScalar(radius)
    ball.position.copy(position)
    ball.rotation.y = LONGITUDE
    meshes.push(ball)
    scene.add(ball)
    // #region shell
    // #shown const light = new DirectionalLight()
    // #shown const ball = new Mesh(new SphereGeometry(1, 256, 128), new MeshStandardMaterial())
    // #shown scene.add(light, light.target, ball)
    // #shown const parameters = new AtmosphereParameters()
    // #shown const model = 'tables' // or 'single-scattering', which needs none
    const shell = new AtmosphereShell(parameters, 1, { sun: light, model })
    ball.add(shell) // a mesh whose geometry has radius 1, of any scale
    // #endregion
    shells.push(shell)
  }

  /** Turns the Earth, and lays ground about the place of the landing. */
  const land = (ball: Mesh): void => {
    ball.quaternion.copy(toZenith())
    ball.geometry.dispose()
    ball.geometry = coarseGlobe()
    const { map } = ball.material as MeshStandardMaterial
    const ground = new Mesh(landingGround(EARTH_RADIUS), landingMaterial(map!))
    meshes.push(ground)
    scene.add(ground)
  }

  const cockpit = new Group()
  const build = (): void => {
    if (args.view !== 'cockpit') {
      // On the way down the Earth is where the cockpit's is, and the others about it.
      const unit = args.view === 'map' ? 1 : EARTH_RADIUS
      const shift = args.view === 'map' ? new Vector3() : new Vector3(1.3, -1, 0)
      for (const [parameters, radius, [x, y, z], color] of BODIES) {
        const place = new Vector3(x, y, z).add(shift).multiplyScalar(unit)
        add(parameters(), radius * unit, place, color, radius === 1 ? earth?.surface : null)
      }
    } else {
      add(new AtmosphereParameters(), EARTH_RADIUS, new Vector3(0, -EARTH_RADIUS, 0), '#2b4a2a')
    }
    if (args.view === 'map') return
    if (args.view === 'descent') land(meshes[0])
    const frame = new MeshStandardMaterial({ color: '#1b1d20', roughness: 0.6 })
    for (const [x, y, z, width, height, turn] of [
      [0, -0.5, -0.9, 2.6, 0.35, 0],
      [-0.62, 0.1, -0.91, 0.06, 1.3, 0.35],
      [0.62, 0.1, -0.91, 0.06, 1.3, -0.35]
    ]) {
      const part = new Mesh(new BoxGeometry(width, height, 0.05), frame)
      part.position.set(x, y, z)
      part.rotation.z = turn
      meshes.push(part)
      cockpit.add(part)
    }
    // Metres in a world of kilometres.
    cockpit.scale.setScalar(1e-3 * KILOMETER)
    scene.add(cockpit)
  }
  build()

  const explorer = args.frame ? undefined : explore(args.view, camera, canvas, meshes)
  const elapsed = frameClock(args.frame)
  const current = { ...args }
  const isMoved = changeOf()
  const descent =
    args.view === 'descent' ? new Descent(meshes[0].position, EARTH_RADIUS, explorer) : undefined
  const apply = (): void => {
    const angle = (current.sun * Math.PI) / 180
    if (args.view === 'map') light.position.set(Math.sin(angle), 0.3, Math.cos(angle))
    else if (args.view === 'descent') {
      light.position.set(0.9 * Math.cos(angle), Math.sin(angle), 0.4 * Math.cos(angle))
    } else light.position.set(0.4 * Math.cos(angle), Math.sin(angle), -Math.cos(angle))
    if (args.view !== 'map') {
      camera.near = 2e-4
      light.position.multiplyScalar(1e4)
    }
    if (args.view === 'cockpit' && isMoved([current.height])) {
      camera.position.set(0, 1e-3 * current.height * KILOMETER, 0)
    }
    if (descent !== undefined && isMoved([current.descent])) descent.start(current.descent)
    renderer.toneMappingExposure = exposureOf(current.exposure)
    camera.updateProjectionMatrix()
    camera.updateMatrixWorld()
  }
  if (args.view === 'map') {
    camera.position.set(0, 0.8, 4.2)
    camera.lookAt(0, 0, 0)
  } else if (args.view === 'cockpit') camera.rotation.x = -0.04
  apply()

  const up = new Vector3()
  const draw = (): void => {
    const seconds = elapsed()
    descent?.update(camera, seconds)
    explorer?.update(seconds)
    cockpit.position.copy(camera.position)
    up.copy(camera.position).sub(meshes[0].position).normalize()
    cockpit.quaternion.setFromUnitVectors(cockpit.up, up) // level, as far as one flies
    if (descent?.runs) boardCockpit(cockpit, camera, descent.part)
    // Who takes over before it is there flies without it.
    cockpit.visible = descent === undefined || descent.runs || isAboard(descent.part)
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
      for (const shell of shells) shell.dispose()
      disposeMeshes(meshes)
      for (const picture of Object.values(earth ?? {})) picture.dispose()
      light.dispose()
    }
  })
}

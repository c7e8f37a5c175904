import {
  airglow,
  Atmosphere,
  exposureFor,
  milkyWay,
  planetGround,
  skyBackground,
  stars
} from '@welkin/atmosphere'
import { Ellipsoid } from '@welkin/geo'
import { PerspectiveCamera, Scene, Vector3 } from 'three'
import { earthPictures } from './globe/earthPictures'
import { Explorer } from './moving/Explorer'
import { TURN_SECONDS, travel } from './moving/travel'
import { changeOf, createRenderer, exposureOf, frameClock, WARM_UP_FRAMES } from './scene'
import type { RendererArgs, SceneHandle } from './scene'
import { storyHandle } from './storyHandle'

export interface OrbitArgs extends RendererArgs {
  /** Altitude above the ellipsoid [km]. */
  altitude: number
  /** Along the orbit from where the sun is at the nadir's zenith [degrees]. */
  angle: number
  /** Vertical [degrees]. */
  fieldOfView: number
  /** [stops], 0 as `exposureFor` says. */
  exposure: number
}

/** Out of a space station's window, around the Earth: night side, airglow, stars, sunrise. */
export async function createOrbit(
  canvas: HTMLCanvasElement,
  args: OrbitArgs
): Promise<SceneHandle<OrbitArgs>> {
  const renderer = await createRenderer(canvas, args.forceWebGL)
  const scene = new Scene()
  const camera = new PerspectiveCamera(args.fieldOfView, 1, 10, 1e8)
  const current = { ...args }
  const pictures = await earthPictures()
  // #region orbit
  // #shown const pictures = {} // or textures: surface, water, nightLights
  const atmosphere = new Atmosphere()
  atmosphere.frame = 'ecef' // the world's axes are the Earth's, its origin the Earth's centre
  atmosphere.date = new Date('2026-06-20T23:00:00Z')
  const ground = planetGround({ ...pictures, nightLuminance: 0.02 })
  atmosphere.add(milkyWay(), stars(), ground, airglow()) // far before near
  scene.backgroundNode = skyBackground(atmosphere)
  // #endregion

  const explorer = args.frame
    ? undefined
    : new Explorer(camera, canvas, {
        upAt: (position, target) => Ellipsoid.WGS84.surfaceNormal(position, target),
        heightAt: position => Ellipsoid.WGS84.heightAt(position),
        pole: new Vector3(0, 0, 1)
      })
  const elapsed = frameClock(args.frame)

  const placeCamera = (moved: PerspectiveCamera): void => {
    const angle = (current.angle * Math.PI) / 180
    // A circle through the point under the sun, 35° from the equator's direction.
    const start = atmosphere.sunDirection
    const side = new Vector3(0.57, 0, 0.82).cross(start).normalize()
    const ahead = side.clone().cross(start).normalize()
    const up = start.clone().multiplyScalar(Math.cos(angle)).addScaledVector(ahead, Math.sin(angle))
    const forward = ahead.multiplyScalar(Math.cos(angle)).addScaledVector(start, -Math.sin(angle))
    const height = current.altitude * 1000
    moved.position.copy(up).multiplyScalar(Ellipsoid.WGS84.radii.x + height)
    moved.up.copy(up)
    // At the limb.
    const dip = Math.acos(Ellipsoid.WGS84.radii.x / (Ellipsoid.WGS84.radii.x + height))
    const target = forward.multiplyScalar(Math.cos(dip)).addScaledVector(up, -Math.sin(dip))
    moved.lookAt(moved.position.clone().addScaledVector(target, 1e6))
  }
  const isMoved = changeOf()
  /** Undefined before the first view, which is there at once. */
  let mover: Explorer | undefined
  const apply = (): void => {
    const { altitude, angle, fieldOfView } = current
    if (isMoved([altitude, angle])) travel(mover, camera, placeCamera, TURN_SECONDS)
    camera.fov = fieldOfView
    camera.updateProjectionMatrix()
  }
  apply()
  mover = explorer

  const draw = (): void => {
    explorer?.update(elapsed())
    camera.updateMatrixWorld()
    // #region orbit exposure
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
    async warmUp() {
      await atmosphere.bake(renderer)
      for (let i = 0; current.frame && i < WARM_UP_FRAMES; i++) draw()
    },
    dispose() {
      atmosphere.dispose()
      for (const picture of Object.values(pictures)) picture.dispose()
    }
  })
}

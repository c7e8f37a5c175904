import {
  airlessParameters,
  Atmosphere,
  AtmosphereParameters,
  marsParameters,
  planetGround,
  titanParameters,
  venusParameters
} from '@welkin/atmosphere'
import { Matrix4, PerspectiveCamera, Scene, Vector3 } from 'three'
import { Air } from './air'
import { earthPictures } from './globe/earthPictures'
import { Explorer } from './moving/Explorer'
import { TURN_SECONDS, travel } from './moving/travel'
import { changeOf, createRenderer, exposureOf, frameClock, WARM_UP_FRAMES } from './scene'
import type { RendererArgs, SceneHandle } from './scene'

export type PlanetName = 'earth' | 'made-up' | 'mars' | 'titan' | 'venus' | 'moon'

export interface PlanetsArgs extends RendererArgs {
  planet: PlanetName
  /** Height of the camera above the ground [m]. */
  height: number
  /** [degrees] */
  longitude: number
  /** [degrees] */
  latitude: number
  /** Elevation of the sun [degrees]. */
  sunElevation: number
  /** Azimuth of the sun from the direction of view, clockwise [degrees]. */
  sunAzimuth: number
  /** Direction of view above the horizontal [degrees]. */
  pitch: number
  /** Vertical field of view [degrees]. */
  fieldOfView: number
  /** [stops], 0 for daylight. */
  exposure: number
  /** Optical depth of Mars's dust. */
  dust: number
}

/** Light of the sun there, over that on the Earth, is evened out: like a photographer's exposure. */
function daylight(parameters: AtmosphereParameters): number {
  return new AtmosphereParameters().solarIrradiance[1] / parameters.solarIrradiance[1]
}

/** A planet's sky and ground from 2 m to orbit, with nothing else in the scene. */
export async function createPlanets(
  canvas: HTMLCanvasElement,
  args: PlanetsArgs
): Promise<SceneHandle<PlanetsArgs>> {
  const renderer = await createRenderer(canvas, args.forceWebGL)
  const scene = new Scene()
  const camera = new PerspectiveCamera(60, 1, 1, 1e9)
  const pictures = await earthPictures()
  const current = { ...args }
  let aspect = 1
  let shown: { air: Air; atmosphere: Atmosphere; key: string } | undefined
  let ready: Promise<void> = Promise.resolve()

  const toWorld = new Matrix4()
  const place = new Vector3()
  /** A position in the planet's own axes [m]. */
  const onPlanet = (position: Vector3): Vector3 => {
    const { atmosphere } = shown ?? {}
    return place.copy(position).applyMatrix4(atmosphere?.worldToECEF ?? toWorld.identity())
  }
  const explorer = args.frame
    ? undefined
    : new Explorer(camera, canvas, {
        upAt(position, target) {
          if (shown === undefined) return target.set(0, 1, 0)
          const { ellipsoid, worldToECEF } = shown.atmosphere
          ellipsoid.surfaceNormal(onPlanet(position), target)
          return target.transformDirection(toWorld.copy(worldToECEF).invert())
        },
        heightAt(position) {
          return shown?.atmosphere.ellipsoid.heightAt(onPlanet(position)) ?? position.y
        }
      })
  const elapsed = frameClock(args.frame)

  const show = async (): Promise<void> => {
    const { planet, dust } = current
    // #region planets
    // #shown const [planet, dust] = ['made-up', 0.5] as const
    const parameters = {
      earth: new AtmosphereParameters(),
      'made-up': new AtmosphereParameters(),
      mars: marsParameters({ dust }), // its optical depth
      titan: titanParameters(),
      venus: venusParameters(), // above its clouds
      moon: airlessParameters()
    }[planet]
    const atmosphere = new Atmosphere({ parameters })
    // #endregion
    if (planet === 'earth' || planet === 'made-up') {
      const options = planet === 'earth' ? pictures : { seed: 3 }
      // #region planet's ground
      // #shown const options = { seed: 3 }
      const ground = planetGround(options) // pictures: { surface, water, nightLights }; none are needed
      atmosphere.add(ground)
      parameters.set({ groundAlbedo: await ground.meanAlbedo(renderer, parameters) })
      // #endregion
    }
    shown?.air.dispose()
    const air = new Air(renderer, scene, camera, args.path, atmosphere)
    shown = { air, atmosphere, key: keyOf(current) }
    apply()
  }

  const keyOf = ({ planet, dust }: PlanetsArgs): string => `${planet} ${dust}`

  const isMoved = changeOf()
  const placeCamera = (moved: PerspectiveCamera): void => {
    moved.position.set(0, current.height, 0)
    moved.rotation.set((current.pitch * Math.PI) / 180, 0, 0)
  }
  const moveCamera = (mover?: Explorer): void => {
    const { height, pitch, longitude, latitude } = current
    if (!isMoved([height, pitch, longitude, latitude])) return
    travel(mover, camera, placeCamera, TURN_SECONDS)
  }
  // Before a link has its say.
  moveCamera()

  const apply = (): void => {
    if (shown === undefined) return
    const { atmosphere } = shown
    moveCamera(explorer)
    atmosphere.place({ longitude: current.longitude, latitude: current.latitude })
    atmosphere.setSunAngles(current.sunElevation, current.sunAzimuth)
    camera.fov = current.fieldOfView
    camera.aspect = aspect
    camera.updateProjectionMatrix()
    camera.updateMatrixWorld()
    renderer.toneMappingExposure = exposureOf(current.exposure) * daylight(atmosphere.parameters)
  }

  const draw = (): void => {
    explorer?.update(elapsed())
    shown?.air.render()
  }

  const load = (): void => {
    ready = (shown?.key === keyOf(current) ? Promise.resolve() : show()).then(() => {
      apply()
      for (let i = 0; current.frame && i < WARM_UP_FRAMES; i++) draw()
    })
    // A failure is reported to whoever awaits `ready`.
    ready.catch(() => {})
  }

  return {
    renderer,
    scene,
    camera,
    explorer,
    get ready() {
      return ready
    },
    progress: 1,
    render: draw,
    resize(width, height, pixelRatio) {
      renderer.setPixelRatio(pixelRatio)
      renderer.setSize(width, height, false)
      aspect = width / height
      load()
    },
    update(changes) {
      Object.assign(current, changes)
      load()
    },
    dispose() {
      explorer?.dispose()
      shown?.air.dispose()
      for (const picture of Object.values(pictures)) picture.dispose()
      void renderer.dispose()
    }
  }
}

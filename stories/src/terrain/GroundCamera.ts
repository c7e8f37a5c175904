import type { SunDirectionalLight } from '@welkin/atmosphere'
import { Walker, type Terrain } from '@welkin/terrain'
import { Matrix4, PerspectiveCamera, Vector3 } from 'three'
import type { WebGPURenderer } from 'three/webgpu'
import { moveCamera } from '../globe/places'
import { aimShadow } from '../globe/sunShadow'
import { Explorer } from '../moving/Explorer'
import { frameClock, WARM_UP_FRAMES } from '../scene'
import { viewAlong, type GroundView } from './viewAlong'

/** A way that is gone along. */
interface Tour {
  readonly views: readonly GroundView[]
  /** Time of one way, and time since its start [s]. */
  readonly seconds: number
  time: number
}

/** Camera above a terrain: it flies and walks, near enough to the ground, with the sun's shadows about it. */
export class GroundCamera {
  /** Undefined in a still. */
  readonly explorer: Explorer | undefined
  readonly #camera: PerspectiveCamera
  readonly #terrain: Terrain
  readonly #elapsed: () => number
  readonly #ecefToWorld = new Matrix4()
  readonly #position = new Vector3()
  readonly #up = new Vector3()
  #tour: Tour | null = null

  constructor(
    camera: PerspectiveCamera,
    canvas: HTMLCanvasElement,
    terrain: Terrain,
    isStill: boolean,
    roofAt: (place: Vector3) => number = () => -Infinity
  ) {
    this.#camera = camera
    this.#terrain = terrain
    this.#elapsed = frameClock(isStill)
    this.#ecefToWorld.copy(terrain.atmosphere.worldToECEF).invert()
    const groundAt = (place: Vector3): number => terrain.heightBelow(place)
    const upAt = (place: Vector3, target: Vector3): Vector3 => this.#upAt(place, target)
    const heightAt = (place: Vector3): number => this.heightAt(place)
    const walker = new Walker(terrain)
    const footingAt = (place: Vector3): number => Math.max(groundAt(place), roofAt(place))
    const options = { upAt, heightAt, groundAt, footingAt, walker }
    this.explorer = isStill ? undefined : new Explorer(camera, canvas, options)
  }

  /** Flies to a view, or jumps there where nobody watches. */
  goTo(view: GroundView): void {
    const aim = this.#place(view, new PerspectiveCamera())
    const camera = this.#camera
    if (this.explorer === undefined || camera.position.lengthSq() === 0) {
      camera.position.copy(aim.position)
      camera.quaternion.copy(aim.quaternion)
      return
    }
    aim.updateMatrixWorld()
    const direction = aim.getWorldDirection(new Vector3())
    const distance = camera.position.distanceTo(aim.position)
    void this.explorer.flyTo({ position: aim.position, direction }, 2 + Math.log10(1 + distance))
  }

  /**
   * Goes along a way through views, there and back, until told otherwise; a still stands in its middle.
   *
   * @param views - Views on it; null to end it.
   * @param seconds - Time of one way.
   */
  tour(views: readonly GroundView[] | null, seconds: number): void {
    if ((views === null) === (this.#tour === null)) return
    this.#tour = views === null ? null : { views, seconds, time: 0 }
  }

  /** Moves on along the tour. */
  #follow(tour: Tour, elapsed: number): void {
    tour.time += elapsed
    const legs = this.explorer === undefined ? 0.5 : tour.time / tour.seconds
    this.#place(viewAlong(tour.views, 1 - Math.abs((legs % 2) - 1)), this.#camera)
  }

  /** Puts a camera where a view is. */
  #place(view: GroundView, camera: PerspectiveCamera): PerspectiveCamera {
    const height = this.#terrain.heightAt(view.longitude, view.latitude) + view.height
    moveCamera(camera, { ...view, height })
    camera.applyMatrix4(this.#ecefToWorld)
    return camera
  }

  /** Moves on by a frame, and fits the near plane and a sun's shadows to the height above the ground. */
  update(sun: SunDirectionalLight): void {
    const elapsed = this.#elapsed()
    if (this.#tour === null) this.explorer?.update(elapsed)
    else this.#follow(this.#tour, elapsed)
    const camera = this.#camera
    camera.updateMatrixWorld()
    const { position } = camera
    const height = Math.max(this.heightAt(position) - this.#terrain.heightBelow(position), 2)
    camera.near = Math.min(height / 10, 1e4)
    camera.updateProjectionMatrix()
    aimShadow(sun, camera, height, this.#upAt(position, this.#up))
  }

  /** Draws the frames before a still, each with all of its ground. */
  async warmUp(renderer: WebGPURenderer, draw: () => void): Promise<void> {
    for (let i = 0; this.explorer === undefined && i < WARM_UP_FRAMES; i++) {
      this.#camera.updateMatrixWorld()
      this.#terrain.update(renderer, this.#camera, Infinity)
      draw()
      await new Promise(requestAnimationFrame)
    }
  }

  /** Height of a place of the world above the ellipsoid [m]. */
  heightAt(place: Vector3): number {
    return this.#terrain.atmosphere.ellipsoid.heightAt(this.#toECEF(place))
  }

  #toECEF(place: Vector3): Vector3 {
    return this.#position.copy(place).applyMatrix4(this.#terrain.atmosphere.worldToECEF)
  }

  #upAt(place: Vector3, target: Vector3): Vector3 {
    const { ellipsoid } = this.#terrain.atmosphere
    return ellipsoid
      .surfaceNormal(this.#toECEF(place), target)
      .transformDirection(this.#ecefToWorld)
  }
}

import type { MoonDirectionalLight } from '@welkin/atmosphere'
import { Vector3, type PerspectiveCamera } from 'three'

/** Half the width of the map, about a place that far ahead of the camera [m]. */
const HALF_WIDTH = 1600
const AHEAD = 1100

/** Pixels along a side of the map. */
const MAP_SIZE = 2048

/** Distance by which receivers are moved along their normals [texels]. */
const NORMAL_BIAS = 1.2

/** Way of the place [m], and turn of the moon [rad], after which the map is drawn anew. */
const WAY = 60
const TURN = 3e-3

/** Frames at the start in which it is drawn: stills have few. */
const WHOLE_FRAMES = 10

/** Sine of the moon's elevation below which it lights nothing. */
const SET = -0.02

const _place = new Vector3()
const _direction = new Vector3()

/** Shadow map of the moon about what the camera sees, drawn where the moon or the camera has moved: by day it costs nothing. */
export class MoonShadow {
  readonly #light: MoonDirectionalLight
  readonly #drawn = { place: new Vector3(Infinity, 0, 0), moon: new Vector3() }
  #frame = 0
  #isWhole = true

  constructor(light: MoonDirectionalLight) {
    this.#light = light
    const { shadow } = light
    const { camera } = shadow
    camera.left = camera.bottom = -HALF_WIDTH
    camera.right = camera.top = HALF_WIDTH
    camera.far = 16_000
    shadow.mapSize.setScalar(MAP_SIZE)
    shadow.normalBias = (NORMAL_BIAS * 2 * HALF_WIDTH) / MAP_SIZE
    shadow.autoUpdate = false
  }

  /** Has it drawn with the next frame: other things cast shadows now. */
  reset(): void {
    this.#isWhole = true
  }

  /**
   * Chooses whether the next frame draws it.
   *
   * @param isNight - False while the sun outshines the moon.
   * @returns True if the moon lights the scene.
   */
  update(camera: PerspectiveCamera, isNight: boolean): boolean {
    const light = this.#light
    light.update()
    _direction.copy(light.position).sub(light.target.position).normalize()
    if (!isNight || _direction.y < SET) return false
    camera.getWorldDirection(_place).setY(0).normalize().multiplyScalar(AHEAD)
    _place.add(camera.position)
    const { place, moon } = this.#drawn
    const isMoved = place.distanceTo(_place) > WAY || moon.distanceTo(_direction) > TURN
    const isDrawn = isMoved || this.#isWhole || this.#frame < WHOLE_FRAMES
    this.#isWhole = false
    this.#frame++
    if (!isDrawn) return true
    place.copy(_place)
    moon.copy(_direction)
    light.target.position.copy(_place)
    light.target.updateMatrixWorld()
    light.shadow.needsUpdate = true
    return true
  }
}

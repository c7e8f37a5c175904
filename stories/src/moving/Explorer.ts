import { Quaternion, Vector2, Vector3 } from 'three'
import type { PerspectiveCamera } from 'three'
import { ExplorerInput } from './ExplorerInput'
import type { ExplorerOptions } from './ExplorerOptions'
import type { ExplorerState } from './ExplorerState'
import { Flight } from './Flight'
import { LocalAxes } from './LocalAxes'
import type { ViewAngles } from './LocalAxes'
import { EYE_HEIGHT, footing, HIGH, isDeep, wading, Walk } from './Walk'

export type { ExplorerOptions, ExplorerState }

/** Longest time between two frames that counts; a hidden page has none [s]. */
const LONGEST_FRAME = 0.1
const SLOWEST = 3 // speed of flight at the ground [m/s], and its growth with height [1/s]
const SPEED_PER_HEIGHT = 0.5
/** Speed of walking [m/s]. */
const WALKING_SPEED = 3
const FAST = 4
/** Turns by which one slips along a wall [rad]. */
const SLIPS = [0, 0.5, -0.5, 1, -1, 1.45, -1.45]
/** Time in which speed comes and goes [s]. */
const EASE = 0.1
/** Time in which a view that others left tilted comes level while one looks around [s]. */
const LEVELLING = 0.4
/** Least height of flight above the ground [m]. */
const CLEARANCE = 0.5
/** Turn of a drag across the canvas, over the field of view. */
const TURN = 1.5
const MOST_PITCH = (89.5 * Math.PI) / 180
const DEGREES = 180 / Math.PI

const wish = new Vector3()
const turn = new Vector2()
const axis = new Vector3()
const before = new Vector3()
const after = new Vector3()
const quaternion = new Quaternion()
const LEVEL = new Quaternion()

/**
 * Moves a camera by keys, mouse and touch: flight, and walks on the ground.
 *
 * A drag looks, WASD and QE fly at a speed that grows with height, Shift is faster, the wheel sets the speed, F walks, Space
 * jumps. One finger looks, two move. The camera has no parent but the scene; others may move it between updates.
 */
export class Explorer {
  /** Line on how else the camera is moved, by other controls; undefined if it is not. */
  readonly others: string | undefined

  private readonly camera: PerspectiveCamera
  private readonly input: ExplorerInput
  private readonly groundAt: (position: Vector3) => number
  private readonly footingAt: (position: Vector3) => number
  private readonly waterAt: (position: Vector3) => number
  private readonly upAt: (position: Vector3, target: Vector3) => Vector3
  private readonly heightAt: (position: Vector3) => number
  private readonly pole: Vector3
  private readonly metersPerUnit: number
  private readonly axes = new LocalAxes()
  private readonly velocity = new Vector3()
  private flight?: Flight
  private walk?: Walk
  private readonly walker: ExplorerOptions['walker']
  /** Eyes of the walker, as it left them. */
  private readonly eye = new Vector3()
  private isViewSet = false

  constructor(camera: PerspectiveCamera, canvas: HTMLElement, options: ExplorerOptions = {}) {
    this.camera = camera
    this.input = new ExplorerInput(canvas)
    this.groundAt = options.groundAt ?? (() => 0)
    this.footingAt = options.footingAt ?? this.groundAt
    this.waterAt = options.waterAt ?? (() => -Infinity)
    this.upAt = options.upAt ?? ((_, target) => target.set(0, 1, 0))
    this.metersPerUnit = options.metersPerUnit ?? 1
    this.heightAt = options.heightAt ?? (position => position.y * this.metersPerUnit)
    this.pole = options.pole ?? new Vector3(0, 0, -1)
    this.others = options.others
    this.walker = options.walker
  }

  /** True on the way of {@link flyTo}. */
  get isFlying(): boolean {
    return this.flight !== undefined
  }

  get isWalking(): boolean {
    return this.walk !== undefined
  }

  set isWalking(value: boolean) {
    if (value !== this.isWalking) {
      this.stop()
      this.walk = value ? new Walk() : undefined
    }
  }

  /** Position [m], direction and way of moving, of which a link is made. Set, it ends a flight. */
  get state(): ExplorerState {
    const { heading, pitch } = this.angles()
    const { x, y, z } = after.copy(this.camera.position).multiplyScalar(this.metersPerUnit)
    const walking = Number(this.isWalking)
    return { x, y, z, heading: heading * DEGREES, pitch: pitch * DEGREES, walking }
  }

  set state({ x, y, z, heading, pitch, walking }: ExplorerState) {
    this.stop()
    this.camera.position.set(x, y, z).divideScalar(this.metersPerUnit)
    this.turnTo({ heading: heading / DEGREES, pitch: pitch / DEGREES })
    this.isWalking = walking !== 0
    this.isViewSet = true
    this.camera.updateMatrixWorld()
  }

  /**
   * True if any key was pressed, the pointer pressed, the wheel turned or {@link state} set since it was last asked for: who
   * moves the camera leaves it to the explorer then.
   */
  takeUse(): boolean {
    const used = this.input.takeUse() || this.isViewSet
    this.isViewSet = false
    return used
  }

  /** Holds a key down that moves, such as `KeyW`, as if it were pressed. */
  press(code: string): void {
    this.input.hold(code)
  }

  /** Lets a key go that {@link press} holds. */
  release(code: string): void {
    this.input.letGo(code)
  }

  /** Called once per frame. */
  update(deltaSeconds: number): void {
    const seconds = Math.min(Math.max(deltaSeconds, 0), LONGEST_FRAME)
    const { input } = this
    if (input.takeToggle()) this.isWalking = !this.isWalking
    input.move(wish)
    input.takeTurn(turn)
    if (this.flight !== undefined) {
      const isTaken = wish.lengthSq() + turn.lengthSq() > 0 || input.isJumping
      if (!isTaken) {
        this.follow(this.flight, seconds)
        return
      }
      this.stop()
    }
    if (turn.lengthSq() > 0) this.look(seconds)
    if (this.walk === undefined) this.fly(seconds)
    else this.step(this.walk, seconds)
  }

  /**
   * Flies smoothly to a view, above what ground lies between. Moving or looking breaks it off.
   *
   * @param view - Position, and unit vector of the direction.
   * @returns Promise that settles on arrival, or when the flight is broken off.
   */
  async flyTo(view: { position: Vector3; direction: Vector3 }, seconds: number): Promise<void> {
    this.isWalking = false
    this.stop()
    const { heading } = this.angles()
    const from = this.endOf(this.camera.position, this.camera.quaternion)
    this.axesAt(view.position)
    const angles = this.axes.anglesOfDirection(view.direction, heading)
    const to = this.endOf(view.position, this.axes.rotation(angles, quaternion))
    await new Promise<void>(resolve => {
      this.flight = new Flight(from, to, seconds, resolve)
    })
  }

  dispose(): void {
    this.stop()
    this.input.dispose()
  }

  private stop(): void {
    this.velocity.set(0, 0, 0)
    this.flight?.end()
    this.flight = undefined
  }

  private endOf(position: Vector3, rotation: Quaternion) {
    const height = this.heightAt(position)
    const up = this.upAt(position, new Vector3())
    return { position: position.clone(), rotation: rotation.clone(), up, height }
  }

  private axesAt(position: Vector3): LocalAxes {
    return this.axes.set(this.upAt(position, axis), this.pole)
  }

  private angles(): ViewAngles {
    return this.axesAt(this.camera.position).anglesOf(this.camera.quaternion)
  }

  private turnTo(angles: ViewAngles): void {
    this.axesAt(this.camera.position).rotation(angles, this.camera.quaternion)
  }

  private look(seconds: number): void {
    const { heading, pitch } = this.angles()
    const share = (TURN * this.camera.fov) / DEGREES
    const raised = Math.min(Math.max(pitch + turn.y * share, -MOST_PITCH), MOST_PITCH)
    const tilt = this.axes.rotation({ heading, pitch }, quaternion).invert()
    tilt.multiply(this.camera.quaternion).slerp(LEVEL, 1 - Math.exp(-seconds / LEVELLING))
    this.turnTo({ heading: heading + turn.x * share, pitch: raised })
    this.camera.quaternion.multiply(tilt)
  }

  private follow(flight: Flight, seconds: number): void {
    const { position, quaternion } = this.camera
    const height = flight.advance(seconds, position, quaternion)
    const ground = flight.isOver ? NaN : this.groundAt(position)
    this.setHeight(Number.isFinite(ground) ? Math.max(height, ground + CLEARANCE) : height)
    if (flight.isOver) this.stop()
  }

  /** Eases the velocity to the wished one. */
  private accelerate(target: Vector3, seconds: number): void {
    const rest = Math.exp(-seconds / EASE)
    this.velocity.sub(target).multiplyScalar(rest).add(target)
    if (target.lengthSq() === 0 && this.velocity.length() < 0.01) this.velocity.set(0, 0, 0)
  }

  private get factor(): number {
    return this.input.speed * (this.input.isFast ? FAST : 1)
  }

  private fly(seconds: number): void {
    if (wish.lengthSq() + this.velocity.lengthSq() === 0) return
    const { position, quaternion } = this.camera
    const ground = this.groundAt(position)
    const height = this.heightAt(position) - (Number.isFinite(ground) ? ground : 0)
    const speed = (SLOWEST + SPEED_PER_HEIGHT * Math.max(height, 0)) * this.factor
    const { up } = this.axesAt(position)
    const along = after.set(wish.x, 0, -wish.z).applyQuaternion(quaternion)
    along.addScaledVector(up, wish.y).clampLength(0, 1)
    this.accelerate(along.multiplyScalar(speed), seconds)
    this.moveBy(seconds)
    const floor = this.groundAt(position) + CLEARANCE
    if (this.heightAt(position) < floor) this.setHeight(floor)
  }

  private step(walk: Walk, seconds: number): void {
    const { position } = this.camera
    const { heading } = this.angles()
    const level = this.axes.ahead(heading, after).multiplyScalar(wish.z)
    level.addScaledVector(this.axes.ahead(heading + Math.PI / 2, axis), wish.x)
    if (this.onFoot(level, seconds)) return
    const eye = this.heightAt(position)
    const [feet, water] = [eye - EYE_HEIGHT, this.waterAt(position)]
    const speed = WALKING_SPEED * this.factor * wading(feet, water)
    this.accelerate(level.multiplyScalar(speed), seconds)
    this.slip(walk, eye, seconds)
    const ground = footing(this.footingAt(position), this.waterAt(position))
    const isJumping = this.input.isJumping && !isDeep(feet, water)
    this.setHeight(walk.advance(eye, ground, isJumping, seconds))
  }

  /** Moves along the velocity, or along a wall that is in the way. */
  private slip(walk: Walk, eye: number, seconds: number): void {
    if (this.velocity.lengthSq() === 0) return
    const { position } = this.camera
    const [start, rotation] = [position.clone(), this.camera.quaternion.clone()]
    const velocity = this.velocity.clone()
    const { up } = this.axesAt(position)
    const vertical = up.clone()
    for (const angle of SLIPS) {
      this.velocity.copy(velocity).applyAxisAngle(vertical, angle).multiplyScalar(Math.cos(angle))
      this.moveBy(seconds)
      const distance = position.distanceTo(start) * this.metersPerUnit
      if (!walk.isBlocked(eye, this.footingAt(position), distance)) return
      position.copy(start)
      this.camera.quaternion.copy(rotation)
    }
    this.velocity.set(0, 0, 0)
  }

  /** Has the walker walk along a level vector, if there is one and the ground is near; false if not. */
  private onFoot(level: Vector3, seconds: number): boolean {
    const { walker, camera } = this
    const { position } = camera
    const height = this.heightAt(position) - EYE_HEIGHT - this.groundAt(position)
    if (walker === undefined || !(height <= HIGH)) return false
    // Whoever was moved by others goes on from there.
    if (!position.equals(this.eye)) walker.moveTo(position)
    walker.speed = WALKING_SPEED * this.factor
    const up = this.upAt(position, before)
    const start = position.clone()
    walker.update(level, this.input.isJumping, seconds)
    walker.eyePosition(position)
    // Walls are no part of the walker's ground; out of one in which one has come down, one may walk.
    if (this.isInWall(position) && !this.isInWall(start)) {
      position.copy(start)
      walker.moveTo(start)
    }
    this.eye.copy(position)
    quaternion.setFromUnitVectors(up, this.upAt(position, axis))
    camera.quaternion.premultiply(quaternion)
    return true
  }

  /** True where something that is no ground is higher than one's feet. */
  private isInWall(eye: Vector3): boolean {
    const footing = this.footingAt(eye)
    return footing > this.groundAt(eye) && footing > this.heightAt(eye) - EYE_HEIGHT
  }

  /** Moves along the velocity; the view turns with up. */
  private moveBy(seconds: number): void {
    const { position, quaternion: rotation } = this.camera
    const up = this.upAt(position, after)
    position.addScaledVector(this.velocity, seconds / this.metersPerUnit)
    quaternion.setFromUnitVectors(up, this.upAt(position, axis))
    rotation.premultiply(quaternion)
    this.velocity.applyQuaternion(quaternion)
  }

  /** Puts the camera at a height above the datum [m]; what is far below it takes a second try. */
  private setHeight(height: number): void {
    const { position } = this.camera
    for (let i = 0; i < 2; i++) {
      this.upAt(position, axis)
      position.addScaledVector(axis, (height - this.heightAt(position)) / this.metersPerUnit)
    }
  }
}

import { Matrix4, type Quaternion, Vector3 } from 'three'

/** Sine of the pitch from which a direction has no heading of its own. */
const VERTICAL = 1 - 1e-8

const forward = new Vector3()
const right = new Vector3()
const back = new Vector3()
const top = new Vector3()
const basis = new Matrix4()

/** Angles of a direction of view. */
export interface ViewAngles {
  /** Clockwise from north, in [0, 2π) [rad]. */
  heading: number
  /** Angle above the horizontal [rad]. */
  pitch: number
}

/** Axes at a place: up, and north and east level with it. */
export class LocalAxes {
  readonly up = new Vector3(0, 1, 0)
  readonly north = new Vector3(0, 0, -1)
  readonly east = new Vector3(1, 0, 0)

  /**
   * @param up - Unit vector.
   * @param pole - Direction that north leans to, unit vector.
   */
  set(up: Vector3, pole: Vector3): this {
    this.up.copy(up)
    this.east.crossVectors(pole, up)
    // At the pole itself any direction is north.
    if (this.east.lengthSq() < 1e-12) this.east.set(pole.y, pole.z, pole.x).cross(up)
    this.east.normalize()
    this.north.crossVectors(up, this.east)
    return this
  }

  /** Level unit vector of a heading [rad]. */
  ahead(heading: number, target: Vector3): Vector3 {
    return target
      .copy(this.north)
      .multiplyScalar(Math.cos(heading))
      .addScaledVector(this.east, Math.sin(heading))
  }

  /** Rotation of a camera that looks along the angles, level. */
  rotation({ heading, pitch }: ViewAngles, target: Quaternion): Quaternion {
    this.ahead(heading, forward).multiplyScalar(Math.cos(pitch))
    forward.addScaledVector(this.up, Math.sin(pitch))
    this.ahead(heading + Math.PI / 2, right)
    back.copy(forward).negate()
    top.crossVectors(back, right)
    return target.setFromRotationMatrix(basis.makeBasis(right, top, back))
  }

  /** Angles of a camera's direction; seen straight down or up, the top of the picture has the heading. */
  anglesOf(rotation: Quaternion): ViewAngles {
    forward.set(0, 0, -1).applyQuaternion(rotation)
    const sinPitch = Math.min(Math.max(forward.dot(this.up), -1), 1)
    if (Math.abs(sinPitch) > VERTICAL) {
      forward.set(0, -Math.sign(sinPitch), 0).applyQuaternion(rotation)
    }
    return { heading: this.headingOf(forward), pitch: Math.asin(sinPitch) }
  }

  /**
   * Angles of a direction.
   *
   * @param direction - Unit vector.
   * @param heading - Heading of a vertical direction, which has none itself [rad].
   */
  anglesOfDirection(direction: Vector3, heading: number): ViewAngles {
    const sinPitch = Math.min(Math.max(direction.dot(this.up), -1), 1)
    const isVertical = Math.abs(sinPitch) > VERTICAL
    return {
      heading: isVertical ? heading : this.headingOf(direction),
      pitch: Math.asin(sinPitch)
    }
  }

  private headingOf(direction: Vector3): number {
    const heading = Math.atan2(direction.dot(this.east), direction.dot(this.north))
    return heading < 0 ? heading + 2 * Math.PI : heading
  }
}

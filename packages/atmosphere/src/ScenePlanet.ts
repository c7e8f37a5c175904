import { EventDispatcher, MathUtils, Matrix4, Vector3 } from 'three'
import {
  checkBoolean,
  checkChoice,
  checkDate,
  checkDirection,
  checkFinite,
  checkPlace,
  checkPositive,
  fail,
  Geodetic,
  sunDirectionECEF
} from '@welkin/geo'
import type { Ellipsoid, GeodeticLike } from '@welkin/geo'
import { checkRange } from './check'

/** Frame of the scene's world space: that of a place on the planet, or ECEF. */
export type AtmosphereFrame = 'local' | 'ecef'

const _position = new Vector3()
const _rotation = new Matrix4()

/** Planet of a scene: position and rotation of world space on it, and direction of its sun. */
export class ScenePlanet extends EventDispatcher<{ dispose: object }> {
  /** The planet's figure. */
  readonly ellipsoid: Ellipsoid
  /**
   * World units to metres in ECEF. {@link place} and {@link frame} set it; set it yourself for any
   * other frame, such as the inverse of a tile set's `group.matrixWorld`. It must keep angles.
   */
  readonly worldToECEF = new Matrix4()
  #flat = false
  #metersPerUnit = 1
  #frame: AtmosphereFrame = 'local'
  readonly #place = new Geodetic()
  #date: Date | null = null
  readonly #sunECEF = new Vector3()
  readonly #sunWorld = new Vector3(1, Math.SQRT2, 1).normalize()

  /** @param ellipsoid - The planet's figure. */
  constructor(ellipsoid: Ellipsoid) {
    super()
    this.ellipsoid = ellipsoid
    this.#updateFrame()
  }

  /**
   * Flat world: up is +Y wherever the camera goes, and height is y. For scenes with no
   * planet, however far they reach.
   *
   * It looks just as it does at the origin of a round world, the horizon's dip and the reddening of a
   * low sun included. What the camera sees is hazed and lit as if the ground fell away from it with the
   * planet's curve: over 10 km by 8 m and 0.1° of the sun's height.
   */
  get flat(): boolean {
    return this.#flat
  }

  set flat(value: boolean) {
    checkBoolean('Atmosphere', 'flat', value)
    if (value && this.#frame === 'ecef') {
      fail('Atmosphere', "flat must be false in the frame 'ecef'", value)
    }
    this.#flat = value
  }

  /**
   * Puts the world's origin at a place, Y up, X east, Z south.
   *
   * @param geodetic - Longitude, latitude [°], height above the ellipsoid [m], default 0.
   * @throws If a coordinate is missing, not finite or out of range.
   */
  place(geodetic: GeodeticLike): this {
    checkPlace('Atmosphere.place', 'geodetic', geodetic)
    this.#place.copy(geodetic)
    this.#frame = 'local'
    this.#updateFrame()
    return this
  }

  /** `'local'`: as {@link place} says. `'ecef'`: world axes are ECEF's. */
  get frame(): AtmosphereFrame {
    return this.#frame
  }

  set frame(value: AtmosphereFrame) {
    checkChoice('Atmosphere', 'frame', value, ['local', 'ecef'])
    if (value === 'ecef' && this.flat) {
      fail('Atmosphere', "frame must be 'local' in a flat world", value)
    }
    this.#frame = value
    this.#updateFrame()
  }

  /** Metres in a world unit, > 0. Setting it resets {@link worldToECEF} to the frame's. */
  get metersPerUnit(): number {
    return this.#metersPerUnit
  }

  set metersPerUnit(value: number) {
    checkPositive('Atmosphere', 'metersPerUnit', value)
    this.#metersPerUnit = value
    this.#updateFrame()
  }

  #updateFrame(): void {
    const unit = this.#metersPerUnit
    if (this.#frame === 'ecef') {
      this.worldToECEF.makeScale(unit, unit, unit)
      return
    }
    this.ellipsoid.geodeticToECEF(this.#place, _position)
    this.ellipsoid.localYUpFrame(_position, this.worldToECEF)
    this.worldToECEF.scale(_position.setScalar(unit))
  }

  /** Date that sun, moon and stars follow; a copy. Null if the sun's direction was set by hand. */
  get date(): Date | null {
    return this.#date && new Date(this.#date)
  }

  set date(value: Date | null) {
    if (value === null) this.#sunWorld.copy(this.sunDirection)
    else {
      checkDate('Atmosphere', value)
      sunDirectionECEF(value, this.#sunECEF)
    }
    this.#date = value && new Date(value)
  }

  /**
   * Direction to the sun in world space, unit length; a copy. Setting it stops following the date.
   */
  get sunDirection(): Vector3 {
    if (this.#date === null) return this.#sunWorld.clone()
    _rotation.copy(this.worldToECEF).invert()
    return this.#sunECEF.clone().transformDirection(_rotation)
  }

  set sunDirection(world: Vector3) {
    checkDirection('Atmosphere', 'sunDirection', world)
    this.#sunWorld.copy(world).normalize()
    this.#date = null
  }

  /**
   * Points the sun by angles, for scenes without a date: from where {@link worldToECEF} puts the
   * world's origin or, if that is deep inside the planet as in ECEF, from the {@link place}.
   *
   * @param elevation - Above the horizon, in [−90, 90] [°].
   * @param azimuth - Angle from north, clockwise [°]. North is −Z of a local frame.
   */
  setSunAngles(elevation: number, azimuth: number): this {
    checkRange('Atmosphere.setSunAngles', 'elevation', elevation, -90, 90)
    checkFinite('Atmosphere.setSunAngles', 'azimuth', azimuth)
    const origin = _position.setFromMatrixPosition(this.worldToECEF)
    if (origin.length() < this.ellipsoid.radii.x / 2) {
      this.ellipsoid.geodeticToECEF(this.#place, origin)
    }
    this.ellipsoid.localYUpFrame(origin, _rotation)
    const north = MathUtils.degToRad(180 - azimuth)
    const fromZenith = MathUtils.degToRad(90 - elevation)
    this.sunDirection = new Vector3()
      .setFromSphericalCoords(1, fromZenith, north)
      .transformDirection(_rotation)
      .transformDirection(_rotation.copy(this.worldToECEF).invert())
    return this
  }
}

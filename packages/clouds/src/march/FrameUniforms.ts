import { Matrix4, Vector3, Vector4 } from 'three'
import type { PerspectiveCamera } from 'three'
import type { AtmosphereView } from '@welkin/atmosphere'
import { viewpointMapped, type CloudField } from '../density/CloudField'
import { CloudLayers } from '../layers/CloudLayers'
import { nightGain } from '../light/NightLight'
import { vec4Array } from '../tsl-types'
import { cloudForms, cloudInputs, formChange } from './cloudChange'
import { FAR_AWAY } from './tsl/layerBoundaries'
import { matrix3, matrix4, number, vector2 } from '../uniforms'

/**
 * Strides through the pixels of a block, row by row, in the order in which they are marched, by the block's edge: neighbours in time are far
 * apart, and the first few are spread over the block.
 */
const STRIDES = [0, 1, 3, 4, 9, 7, 17]

/** Pixels of a block. */
const pixelsOf = (block: number): number => block ** 2

/** Index of the pixel of a block that a frame marches. */
export const pixelAt = (block: number, frame: number): number =>
  (frame * STRIDES[block]) % pixelsOf(block)

/** Step of the additive recurrence whose consecutive numbers lie farthest apart in the mean. */
export const GOLDEN_RATIO = (Math.sqrt(5) - 1) / 2

/**
 * History's length while the view or the clouds move [frames], and at least [samples of a pixel]. Longer:
 * less noise, and clouds that change their form trail behind (*Cumulus* with "Time lapse").
 */
const MOVING_FRAMES = 48
const MOVING_SAMPLES = 8

/**
 * Samples of a pixel for which history stays short after a change of light or clouds: 3 % of what was before
 * is left. Fewer: the old light stays in a picture that stands still again (*Cumulus*, after a change of "Hour").
 */
const FORGETTING_SAMPLES = 12

/** History's length in a picture that stands still [samples of a pixel]. Shorter: its grain moves (*Cumulus*). */
const STILL_SAMPLES = 256

/**
 * Half width of the variance clip [standard deviations], moving and standing still. Wider: less flicker at
 * edges, and ghosts behind clouds that move (*Cumulus* with "Time lapse").
 */
const MOVING_CLIP = 1.25
const STILL_CLIP = 8

/**
 * Move of the camera within a frame after which history is rejected: in its heights, and at least [m]. Greater:
 * clouds of the place before shine through after a jump; smaller: grain while one flies fast (*World clouds*).
 */
const CUT_HEIGHTS = 0.3
const CUT_METRES = 300

/**
 * Move of the clouds within a frame after which history is rejected [m]: a clock was set. Greater: ghosts
 * (*Cumulus*, "Hour").
 */
const CLOUD_CUT = 500

/**
 * Change of the clouds' form within a frame after which history is rejected, and in a round of frames the one from which
 * history has no tolerance: see `formChange`. Greater: clouds of the weather before shine through for seconds (*Presets*); smaller:
 * flicker while weather changes slowly (*Cumulus*, while "Coverage" is dragged).
 */
const FORM_CUT = 0.1

/**
 * Change of the gain within a frame after which history is rejected, as a factor. Greater: ghosts of the day
 * by night (*Cumulus*, "Hour").
 */
const LIGHT_CUT = 4

/** `luminanceScale` by day, up to which light is raised by night [1/(cd/m²)]. */
const DAYLIGHT_SCALE = 1e-4

/**
 * Frames in which each tile of rays is marched whole once; coprime to the frames that a block takes.
 * Greater: faster, and clouds come out from behind others late (*Cumulus* with "Time lapse").
 */
export const ROUND = 13

/** Part of a block that clouds may move in a frame while rays still begin where those of the last frame found clouds. Greater: near edges lag (*Cockpit*). */
const BLOCK_PART = 0.5

/** Squared displacement below which the camera [m²] and the sun's direction count as still. */
const NO_MOVE = 1e-12

const isSame = (values: readonly number[], before: readonly number[]): boolean =>
  values.every((value, i) => Math.abs(value - before[i]) <= 1e-9 * Math.abs(value))

const _projection = new Matrix4()
const _toPrevious = new Matrix4()
const _delta = new Vector3()
const _position = new Vector3()
const _origin = new Vector4()

/** Projection of a camera, with the jitter that it may have. */
export const jitteredProjection = (camera: PerspectiveCamera, target: Matrix4): Matrix4 =>
  target.copy(camera.projectionMatrix)

/** Uniforms that change from frame to frame: sizes, jitter, and where the last frame's pixels were. */
export class FrameUniforms {
  /** Projection that clouds are drawn by: the camera's own; without TRAA's jitter while there is a `cloudVelocity`. */
  projectionOf = jitteredProjection
  /** Size of the picture [pixels]. */
  readonly size = vector2()
  /** Size of what is marched in a frame [pixels]. */
  readonly marchedSize = vector2()
  /** Edge of the blocks of which a frame marches one pixel [pixels]. */
  readonly block = number(1)
  /** Pixel of the block that this frame marches [pixels]. */
  readonly jitter = vector2()
  /** Marched pixels along an edge of those that share a ray through what falls, and the first that does so in this frame. */
  readonly fallBlock = number(1)
  readonly fallPixel = vector2()
  /** Shift of a pixel's noise from one of its samples to the next, in [0, 1), and one that is another for each frame of a round. */
  readonly roundShift = number()
  readonly noiseShift = number()
  readonly projectionInverse = matrix4()
  readonly near = number()
  readonly far = number()
  /** Normalized device coordinates (x, y, 1) of a pixel to a ray through it, in view space. */
  readonly rays = matrix3()
  /**
   * Normalized device coordinates (x, y, 1) to the clip space (x, y, w) of the last frame, into which the ray
   * led.
   */
  readonly raysBefore = matrix3()
  /**
   * Viewpoints of this frame in that space, one for each layer: shifted against the layer's drift, so that
   * its clouds appear to stand still.
   */
  readonly origins: Vector4[] = Array.from({ length: CloudLayers.maxLayers }, () => new Vector4())
  readonly originArray = vec4Array(this.origins)
  /** 0 where there is no last frame. */
  readonly hasHistory = number()
  /** Frames so far, in [0, `ROUND`): tiles of rays take turns by it. */
  readonly turn = number()
  /** Distance up to which clouds may have moved to another block since the last frame; `FAR_AWAY` where they have changed [m]. */
  readonly unsureUntil = number(FAR_AWAY)
  /** Most accumulated samples of a pixel. */
  readonly maxSamples = number(1)
  /** True where the clouds' form has changed so much since the last frame that nothing of before is of use. */
  hasNewWeather = false
  /** Share of history's tolerance that changes of the clouds' form leave, in [0, 1]. */
  readonly steadiness = number(1)
  /** Half width of the variance clip [standard deviations]. */
  readonly clipDeviations = number(1)
  /** Gain of stored light, that of light which is not exposed yet, and the former's ratio to the last frame's, by which history is multiplied. */
  readonly gain = number(1)
  readonly nightGain = number(1)
  readonly gainChange = number(1)
  /** Stored light per luminance of the last frame; 0 before the first. */
  #stored = 0
  #count = 0
  #camera: Vector3 | null = null
  readonly #sun = new Vector3()
  readonly #projection = new Matrix4()
  /** Displacements in the mapped space to view space of the last frame. */
  readonly #fromMapped = new Matrix4()
  /** The last frame's `cloudInputs`, and its view and projection matrices. */
  #inputs: readonly number[] = []
  #matrices: readonly number[] = []
  /** The last frame's `cloudForms`, and how they have changed of late. */
  #forms: readonly number[] = []
  #formChange = 0
  /** Relative motion of camera and clouds since the last frame [m]. */
  #speed = 0
  /** Frames until history has forgotten what was before the last change of light or clouds. */
  #forgetting = 0

  /** Forgets history: the next frame starts anew. */
  reset(): void {
    this.#camera = null
  }

  /**
   * Advances to the next frame. Field and view must be up to date.
   *
   * @param usesHistory - True if frames are accumulated.
   * @param lightVersion - Changes with the table of the light that clouds scatter.
   */
  next(
    camera: PerspectiveCamera,
    view: AtmosphereView,
    field: CloudField,
    block: number,
    usesHistory: boolean,
    lightVersion = 0
  ): void {
    if (this.block.value !== block) this.reset()
    this.#setJitter(block, usesHistory)
    const projection = this.projectionOf(camera, _projection)
    this.projectionInverse.value.copy(projection).invert()
    this.near.value = camera.near
    this.far.value = camera.far
    // An exposure that has adapted to the night raises light as well: both are too much for half floats.
    const { luminanceScale } = field.atmosphere
    const raised = Math.max(luminanceScale / DAYLIGHT_SCALE, 1)
    this.nightGain.value = nightGain(view, field.radius.value)
    const gain = Math.max(this.nightGain.value / raised, 1)
    const stored = gain * luminanceScale
    this.gainChange.value = stored / (this.#stored || stored)
    this.gain.value = gain
    this.#stored = stored

    viewpointMapped(view, _position)
    const frames = pixelsOf(block)
    const forms = cloudForms(field)
    const change = formChange(forms, this.#forms)
    this.#formChange = Math.min(this.#formChange * (1 - 1 / frames) + change, FORM_CUT)
    this.steadiness.value = 1 - this.#formChange / FORM_CUT
    this.hasNewWeather = change > FORM_CUT
    const isCut = !usesHistory || this.hasNewWeather || this.#isCut(view.height, field)
    if (isCut) this.#formChange = 0
    this.hasHistory.value = isCut ? 0 : 1
    const isAtRest = this.#setReprojection(view, field)
    const isKnown = !isCut && isSame(forms, this.#forms)
    const known = this.#speed / (BLOCK_PART * block * field.pixelAngle.value)
    this.unsureUntil.value = isKnown ? known : FAR_AWAY
    this.turn.value = this.#count % ROUND
    this.#forms = forms
    const inputs = cloudInputs(forms, field, lightVersion)
    this.#countForgetting(isCut, frames, view.lightDirection, inputs)
    const matrices = [...view.viewToMapped.elements, ...projection.elements]
    const isStill = !isCut && isAtRest && this.#forgetting <= 0 && isSame(matrices, this.#matrices)
    this.maxSamples.value = isStill
      ? STILL_SAMPLES
      : Math.max(MOVING_FRAMES / frames, MOVING_SAMPLES)
    this.clipDeviations.value = isStill ? STILL_CLIP : MOVING_CLIP

    this.#matrices = matrices
    this.#projection.copy(projection)
    this.#fromMapped.setFromMatrix3(view.viewToMapped).invert()
    this.#camera = (this.#camera ?? new Vector3()).copy(_position)
  }

  /** Chooses the pixel of each block that is marched, and the noise of its steps. */
  #setJitter(block: number, usesHistory: boolean): void {
    const frames = pixelsOf(block)
    const index = pixelAt(block, this.#count)
    this.jitter.value.set(index % block, Math.floor(index / block))
    this.block.value = block
    // Low-discrepancy in a pixel's samples, which are whole rounds apart.
    const round = Math.floor(this.#count / frames)
    const shift = usesHistory ? round * GOLDEN_RATIO : 0
    this.roundShift.value = shift % 1
    this.noiseShift.value = usesHistory ? (shift + index / frames) % 1 : 0
    const own = pixelAt(this.fallBlock.value, round)
    this.fallPixel.value.set(own & 1, own >> 1)
    this.#count++
  }

  /** True if camera, light or clouds have jumped, so that history is of no use. */
  #isCut(height: number, { drifts }: CloudField): boolean {
    const last = this.#camera
    const farthest = Math.max(CUT_HEIGHTS * Math.abs(height), CUT_METRES)
    return (
      !(last !== null && last.distanceTo(_position) < farthest) ||
      Math.abs(Math.log(this.gainChange.value)) > Math.log(LIGHT_CUT) ||
      drifts.some(drift => !(drift.length() < CLOUD_CUT))
    )
  }

  /**
   * Sets the matrices from pixels to rays, and to places in the last frame.
   *
   * @returns True if neither the camera's place nor the clouds have moved since then.
   */
  #setReprojection(view: AtmosphereView, field: CloudField): boolean {
    const { elements: e } = this.projectionInverse.value
    // Any depth between near and far gives the direction of a pixel's ray.
    const [x, y, z] = [0, 1, 2].map(row => 0.5 * e[8 + row] + e[12 + row])
    const rays = this.rays.value.set(e[0], e[4], x, e[1], e[5], y, e[2], e[6], z)
    let isAtRest = true
    if (this.#camera !== null) {
      _delta.copy(_position).sub(this.#camera)
      _toPrevious
        .makeTranslation(_delta)
        .premultiply(this.#fromMapped)
        .premultiply(this.#projection)
      const { elements: p } = _toPrevious
      this.raysBefore.value
        .set(p[0], p[4], p[8], p[1], p[5], p[9], p[3], p[7], p[11])
        .multiply(view.viewToMapped)
        .multiply(rays)
      isAtRest = _delta.lengthSq() < NO_MOVE
    }
    this.#speed = 0
    field.drifts.forEach((drift, i) => {
      this.#speed = Math.max(this.#speed, _delta.distanceTo(drift))
      const { x, y, z, w } = _origin.set(-drift.x, -drift.y, -drift.z, 1).applyMatrix4(_toPrevious)
      this.origins[i].set(x, y, w, z)
      isAtRest &&= drift.lengthSq() === 0
    })
    return isAtRest
  }

  /** Counts down the frames that history takes to forget the last change of light or clouds. */
  #countForgetting(isCut: boolean, frames: number, sun: Vector3, inputs: readonly number[]): void {
    const isSunStill = this.#sun.distanceToSquared(sun) < NO_MOVE
    if (isCut) this.#forgetting = 0
    else if (isSunStill && isSame(inputs, this.#inputs)) this.#forgetting--
    else this.#forgetting = FORGETTING_SAMPLES * frames
    this.#inputs = inputs
    this.#sun.copy(sun)
  }
}

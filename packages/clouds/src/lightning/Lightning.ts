import type { AtmosphereView } from '@welkin/atmosphere'
import { checkRange } from '@welkin/atmosphere'
import { checkBoolean, checkNonNegative, checkOptions, fail, setOptions } from '@welkin/geo'
import { Color, EventDispatcher, Matrix3, PointLight, Vector3 } from 'three'
import type { NodeFrame, Renderer } from 'three/webgpu'
import { checkClouds } from '../check'
import { viewpointMapped } from '../density/CloudField'
import type { CloudsNode } from '../march/CloudsNode'
import type { Float, Vec3 } from '../tsl-types'
import { CHANNEL_COLOR, fromCamera, lightningChannel } from './channel'
import { flashCurve, lightBetween } from './flashCurve'
import { seeded, type Random } from './random'
import { FlashLimit } from './FlashLimit'
import { eventOf, type Flash } from './Flash'
import type {
  LightningEvent,
  LightningEventMap,
  LightningOptions,
  StrikeOptions
} from './LightningOptions'
import { LightningPasses } from './LightningPasses'
import { StormColumns } from './StormColumns'

/** Thickness of the shallowest storm [m]. */
const SHALLOWEST = 3000
/** Time [s] and move of the camera [m] after which columns are looked for again. */
const STALE_TIME = 30
const STALE_MOVE = 4000
/** Distance from the channel to clouds whose brightness is limited [m]. */
const LIMITED_DISTANCE = 2000
/** Longest exposure of a frame [s]. */
const LONGEST_FRAME = 0.1

const SETTINGS = ['rate', 'groundShare', 'enabled', 'limit', 'exposure', 'time'] as const

const _viewpoint = new Vector3()
const _point = new Vector3()
const _toView = new Matrix3()

/**
 * Lightning in the storms of clouds: flashes in and under strong columns of the deepest layer, if that is at least 3 km thick.
 *
 * ```ts
 * const storm = lightning(cloudsNode, { rate: 4 }) // flashes a minute; before the first render
 * scene.add(storm.light)                           // lights the ground
 * storm.addEventListener('thunder', ({ distance }) => rumble(distance))
 * storm.strike()                                   // one more, now
 * ```
 *
 * Clouds glow from inside, brighter towards the channel and darker at the limbs of their heads, and light others from outside; the air glows as well,
 * and where no cloud hides it a branched channel is seen. Nothing is drawn between flashes.
 *
 * Flashes may harm people with photosensitive epilepsy: ask before you switch them on. `limit`, on by default, lets three a second through and caps
 * their brightness.
 *
 * Light in clouds is that which diffuses out of them, Q/(4π²) ⟨1/(r² + s²)⟩ over the channel, on thin sides more than through thick ones:
 * all of it gets out, where nothing absorbs. The light on the ground is a frame late.
 */
export class Lightning extends EventDispatcher<LightningEventMap> {
  /** Clouds that it lights; shared, not owned. */
  readonly clouds: CloudsNode
  /** Light of flashes on surfaces: add it to the scene. */
  readonly light = new PointLight(0xffffff, 0)
  #rate = 0
  #groundShare = 0.3
  #enabled = true
  #limit: number | null = 0.3
  #exposure: number | null = null
  #time: number | null = null
  readonly #random: Random
  readonly #passes: LightningPasses
  readonly #columns: StormColumns
  readonly #limiter = new FlashLimit()
  readonly #looked = { at: new Vector3(), time: -Infinity }
  readonly #asked: StrikeOptions[] = []
  #flash: Flash | null = null
  readonly #thunder: { time: number; event: LightningEvent }[] = []
  #now: number | null = null
  #next: number | null = null

  /** @throws If the clouds are missing, or an option is unknown or out of range. */
  constructor(clouds: CloudsNode, options: LightningOptions = {}) {
    super()
    checkClouds('Lightning', clouds)
    const { seed = 1, ...settings } = checkOptions('Lightning', options, 'seed', ...SETTINGS)
    if (!Number.isInteger(seed)) fail('Lightning', 'seed must be an integer', seed)
    this.clouds = clouds
    this.set(settings)
    this.#random = seeded(seed)
    this.#passes = new LightningPasses(clouds)
    this.#columns = new StormColumns(clouds.field)
    this.light.color = new Color(...CHANNEL_COLOR)
    clouds.screens.add(this)
    clouds.needsUpdate = true
  }

  /**
   * Changes some settings.
   *
   * @throws If one is unknown or out of range; then nothing has changed.
   */
  set(settings: Pick<LightningOptions, (typeof SETTINGS)[number]>): this {
    return setOptions('Lightning', this, settings, ...SETTINGS)
  }

  /** Mean rate of flashes within 20 km, at random times [1/min]. */
  get rate(): number {
    return this.#rate
  }

  /** @throws If it is negative or not finite. */
  set rate(rate: number) {
    checkNonNegative('Lightning', 'rate', rate)
    this.#rate = rate
    this.#next = null
  }

  /** Share of flashes that go to the ground, in [0, 1]: about a quarter (Boccippio et al. 2001, Mon. Weather Rev. 129, 108) to a third. */
  get groundShare(): number {
    return this.#groundShare
  }

  /** @throws If it is not in [0, 1]. */
  set groundShare(share: number) {
    checkRange('Lightning', 'groundShare', share, 0, 1)
    this.#groundShare = share
  }

  /** False: no flash begins, nor is any seen, and those asked for are forgotten; thunder under way still arrives. */
  get enabled(): boolean {
    return this.#enabled
  }

  /** @throws If it is no boolean. */
  set enabled(enabled: boolean) {
    checkBoolean('Lightning', 'enabled', enabled)
    this.#enabled = enabled
    if (!enabled) this.#asked.length = 0
  }

  /**
   * Limit for people whom flashes harm: the greatest radiance, times `luminanceScale`, of clouds 2 km from the channel, where 1 is about
   * white; light rises at most three times in a second, and falls slowly. Null: as in nature.
   */
  get limit(): number | null {
    return this.#limit
  }

  /** @throws If it is neither null nor positive and finite. */
  set limit(limit: number | null) {
    if (limit !== null && !(limit > 0 && limit < Infinity)) {
      fail('Lightning', 'limit must be positive and finite, or null', limit)
    }
    this.#limit = limit
  }

  /** Time over which a picture gathers a flash's light, up to now [s], in (0, 10]; null, the default: since the last frame. */
  get exposure(): number | null {
    return this.#exposure
  }

  /** @throws If it is out of range. */
  set exposure(seconds: number | null) {
    if (seconds !== null) checkRange('Lightning', 'exposure', seconds, 1e-4, 10)
    this.#exposure = seconds
  }

  /** Time [s]; null, the default, for that of the clouds, or else of the renderer. */
  get time(): number | null {
    return this.#time
  }

  /** @throws If it is not finite. */
  set time(seconds: number | null) {
    if (seconds !== null && !Number.isFinite(seconds)) {
      fail('Lightning', 'time must be a finite number or null', seconds)
    }
    this.#time = seconds
  }

  /** True while a flash is under way. */
  get isFlashing(): boolean {
    return this.#flash !== null
  }

  /**
   * Asks for a flash, as soon as none is under way and it is known where clouds are: some frames. Forgotten while `enabled` is false.
   *
   * @throws If an option is unknown or of the wrong kind.
   */
  strike(options: StrikeOptions = {}): void {
    const { kind, at } = checkOptions('Lightning.strike', options, 'kind', 'at')
    if (kind !== undefined && kind !== 'ground' && kind !== 'cloud') {
      fail('Lightning.strike', "kind must be 'ground' or 'cloud'", kind)
    }
    if (at !== undefined && !at?.isVector3) fail('Lightning.strike', 'at must be a Vector3', at)
    if (this.#enabled) this.#asked.push({ kind, at: at?.clone() })
  }

  /** Called by the clouds' node, before its picture is drawn. */
  prepare(renderer: Renderer, view: AtmosphereView, frame: NodeFrame): void {
    const now = this.#time ?? this.clouds.time ?? frame.time
    const elapsed = Math.min(Math.max(now - (this.#now ?? now), 0), LONGEST_FRAME)
    this.#now = now
    viewpointMapped(view, _viewpoint)
    this.#schedule(now)
    this.#begin(renderer, view, now)
    this.#soundThunder(now)
    this.#draw(renderer, view, now, elapsed)
  }

  /** Adds its light to a colour: called by the clouds' node. */
  dim(color: Vec3, transmittance: Float): Vec3 {
    return this.#passes.addTo(color, transmittance)
  }

  /** Frees its textures, and takes it from the clouds. */
  dispose(): void {
    this.clouds.screens.delete(this)
    this.clouds.needsUpdate = true
    this.#passes.dispose()
    this.#columns.dispose()
    this.light.dispose()
  }

  /** Asks for a flash when its time has come: times between them are exponentially distributed. */
  #schedule(now: number): void {
    if (this.#rate === 0) return
    const wait = (-60 / this.#rate) * Math.log(1 - this.#random())
    if (this.#next === null) this.#next = now + wait
    else if (now >= this.#next) {
      this.#next = now + wait
      this.strike()
    }
  }

  /** Begins the next flash that was asked for. */
  #begin(renderer: Renderer, view: AtmosphereView, now: number): void {
    if (this.#asked.length === 0 || this.#flash !== null) return
    const { layers, isReady } = this.clouds.field
    if (!isReady) return
    const storm = [...layers].reduce((a, b) => (thicknessOf(b) > thicknessOf(a) ? b : a))
    const [{ kind, at }] = this.#asked
    let place: Vector3 | undefined
    if (at !== undefined) place = view.atmosphere.space.position(at, new Vector3())
    else {
      if (thicknessOf(storm) < SHALLOWEST) {
        this.#asked.length = 0
        return
      }
      const { at: before, time } = this.#looked
      if (before.distanceTo(_viewpoint) > STALE_MOVE || Math.abs(now - time) > STALE_TIME) {
        before.copy(_viewpoint)
        this.#looked.time = now
        this.#columns.columns = null
        this.#columns.look(renderer, view, [...layers].indexOf(storm))
      }
      if (this.#columns.columns === null) return
      place = this.#columns.choose(this.#random)
    }
    this.#asked.shift()
    if (place === undefined) return
    const random = this.#random
    const chosen = kind ?? (random() < this.#groundShare ? 'ground' : 'cloud')
    const up = place.clone().normalize()
    const east = new Vector3(0, 0, 1).cross(up)
    if (east.lengthSq() < 1e-6) east.set(1, 0, 0)
    east.normalize()
    const { baseAltitude: base, topAltitude: top } = storm.parameters
    const channel = lightningChannel(chosen, { base, top }, random)
    const flash: Flash = {
      ...channel,
      kind: chosen,
      curve: flashCurve(chosen, random),
      start: now,
      place: up.clone().multiplyScalar(view.atmosphere.parameters.bottomRadius),
      axes: [east, up.clone().cross(east), up]
    }
    this.#flash = flash
    this.#passes.begin(renderer, _viewpoint, flash, { base, top })
    const event = eventOf(flash, _viewpoint)
    this.#thunder.push({ time: now + event.delay, event })
    this.dispatchEvent({ type: 'strike', ...event })
  }

  #soundThunder(now: number): void {
    for (let i = this.#thunder.length - 1; i >= 0; i--) {
      const { time, event } = this.#thunder[i]
      if (now < time) continue
      this.#thunder.splice(i, 1)
      this.dispatchEvent({ type: 'thunder', ...event })
    }
  }

  /** Draws what there is of a flash. */
  #draw(renderer: Renderer, view: AtmosphereView, now: number, elapsed: number): void {
    const flash = this.#flash
    const { luminanceScale } = this.clouds.atmosphere
    const exposure = this.#exposure ?? (elapsed || 1 / 60)
    let power = { all: 0, branches: 0 }
    if (flash !== null && this.#enabled) {
      const since = now - flash.start
      const { all, branches } = lightBetween(flash.curve, since - exposure, since)
      power = { all: all / exposure, branches: branches / exposure }
    }
    if (this.#limit !== null) {
      const cap = (this.#limit * 4 * Math.PI ** 2 * LIMITED_DISTANCE ** 2) / luminanceScale
      const limited = this.#limiter.step(power.all, cap, this.#enabled ? elapsed : Infinity)
      const branches = power.all > 0 ? power.branches / power.all : 0
      power = { all: limited, branches: limited * branches }
    }
    const isLit = flash !== null && power.all > 0
    if (flash !== null && !isLit && now - flash.start - exposure > flash.curve.duration)
      this.#flash = null
    this.#passes.power.value = 0
    this.light.intensity = 0
    if (!isLit) return
    const scaled = {
      all: power.all * luminanceScale,
      branches: power.branches * luminanceScale
    }
    this.#passes.render(renderer, view, _viewpoint, flash, scaled)
    this.#light(view, flash, scaled.all)
  }

  /** Places the light: at the channel's lower half where it is seen, else at the cloud's base, out of which its light comes. */
  #light({ viewToMapped, camera }: AtmosphereView, flash: Flash, power: number): void {
    const { stem, kind } = flash
    const low = kind === 'ground' ? stem[stem.length - 2] : stem[0]
    fromCamera(flash, _viewpoint, low, _point).applyMatrix3(_toView.copy(viewToMapped).invert())
    this.light.position.copy(_point).applyMatrix4(camera.matrixWorld)
    // World units may not be metres.
    const metres = Math.cbrt(Math.abs(viewToMapped.determinant()))
    this.light.intensity = power / (4 * Math.PI) / metres ** 2
  }
}

const thicknessOf = ({
  parameters
}: {
  parameters: { baseAltitude: number; topAltitude: number }
}): number => parameters.topAltitude - parameters.baseAltitude

/** Lightning in the storms of clouds: see {@link Lightning}. */
export const lightning = (clouds: CloudsNode, options?: LightningOptions): Lightning =>
  new Lightning(clouds, options)

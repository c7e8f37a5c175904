import { Fn, If, exp2, float, log2, mix, smoothstep, uv, vec2, vec4 } from 'three/tsl'
import type { CloudField } from '../CloudField'
import {
  twoOutputs,
  type Float,
  type LevelTexture,
  type Mat4,
  type TwoOutputs,
  type Vec2,
  type Vec3,
  type Vec4
} from '../tsl-types'
import { forLayers, layerAt } from './layer'
import { interleavedNoise } from './noisePattern'
import { sightAt, type SightNodes } from './sight'

/** Light and transmittance; and log₂ of the clouds' distance, of what was drawn, weight, steps. */
export interface CloudPictures {
  readonly light: LevelTexture<Vec2>
  readonly place: LevelTexture<Vec2>
}

/** log₂ of the greatest distance that is told apart [m]. */
const FARTHEST = 32

/** Sharpness of the kernel that spreads marched pixels, per marched pixels squared. */
const SPREADING = 7

/** Sharpness of the kernel that says how much a marched pixel counts, per pixels squared. */
const LOOKING = 5

/** What pixels that no marched one is near to count nevertheless. */
const LEAST_LOOK = 0.003

/** Looks of pixels that were marched themselves. */
const OWN_LOOK = 0.5

/** log₂ of distances that are taken as the same thing. */
const SAME = 0.1

/** Moves within a frame that are taken as none, so that nothing blurs [pixels]. */
const STANDING = 0.02

/** Transmittance above which there is no cloud. */
const CLEAR = 0.999

/** Moves within a frame after which history is no more than a stopgap, and what it counts then [pixels, looks]. */
const FAST = 10
const LEAST_MEMORY = 0.1

/**
 * What history may differ from its surroundings besides: what is smaller than a block is not seen in
 * every frame, and is kept while the picture hardly moves. Not what has been seen in too few looks: it may
 * be left over from a move.
 */
const SLACK = { standing: 1, moving: 0.01, young: 1.5, old: 4 }

/** Error of the reprojection at which history is forgotten [pixels]. */
const PARALLAX = 4

/** Distance as it is stored. */
export const encodeDistance = (distance: Float): Float => log2(distance.clamp(1, 2 ** FARTHEST))

/**
 * Rounds to half floats, up or down as often as is right in the mean: GPUs cut digits off, frame by frame.
 *
 * @param noise - In [0, 1).
 */
function toHalf(value: Vec4, noise: Float): Vec4 {
  const unit = exp2(
    log2(value.max(2 ** -14))
      .floor()
      .sub(10)
  ).toConst()
  return value.div(unit).add(noise).floor().mul(unit)
}

/** Whether clouds at a place are those that a pixel would see that ends elsewhere. */
function fits(end: Float, { x: distance, y: otherEnd }: Vec4): Float {
  const areBeyond = end.min(otherEnd).greaterThan(distance)
  const isSame = end.sub(otherEnd).abs().lessThan(SAME)
  return areBeyond.or(isSame).select(1, 0)
}

/** Sums over the pixels marched around a pixel. */
interface Estimate {
  light: Vec4
  mean: Vec4
  deviation: Vec4
  /** log₂ of the clouds' distance. */
  distance: Float
  /** How much it counts. */
  look: Float
  steps: Float
}

/** The marched pixels around a pixel. */
const CORNERS = [
  [0, 0],
  [1, 0],
  [0, 1],
  [1, 1]
] as const

/** A marched pixel near a pixel. */
interface Neighbour {
  /** Which corner. */
  readonly step: readonly [0 | 1, 0 | 1]
  /** Texture coordinates. */
  readonly place: Vec2
  readonly color: Vec4
}

/** The marched pixels around a pixel; and where it is between them, in [0, 1). */
function neighbours(
  { frame }: SightNodes,
  marched: CloudPictures,
  pixel: Vec2
): { part: Vec2; list: Neighbour[] } {
  const at = pixel.sub(frame.jitter).div(frame.block).add(1e-3).toConst()
  const corner = at.floor().toConst()
  const list = CORNERS.map(step => {
    const index = corner.add(vec2(...step)).clamp(vec2(0), frame.marchedSize.sub(1))
    const place = index.add(0.5).div(frame.marchedSize).toConst()
    return { step, place, color: marched.light.sample(place).level(0).toConst() }
  })
  return { part: at.sub(corner).toConst(), list }
}

/** What this frame's marched pixels say about a pixel that sees as far as `end`. */
function estimate(
  { frame }: SightNodes,
  marched: CloudPictures,
  { part, list }: { part: Vec2; list: readonly Neighbour[] },
  end: Float
): Estimate {
  const squares = [part.mul(part).toConst(), part.oneMinus().mul(part.oneMinus()).toConst()]
  const spreads = squares.map(square => square.mul(-SPREADING).exp().toConst())
  const light = vec4(0).toVar() as Vec4
  const first = vec4(0).toVar() as Vec4
  const second = vec4(0).toVar() as Vec4
  /** Sums of weights; of what fits; of distances and their weights. */
  const sums = vec4(0).toVar() as Vec4
  /** Square of the distance to the nearest that fits [marched pixels²]. */
  const apart = float(100).toVar()
  const steps = float(0).toVar()
  for (const {
    step: [x, y],
    place,
    color
  } of list) {
    const about = marched.place.sample(place).level(0).toConst() as Vec4
    const fit = fits(end, about).toConst() as Float
    const weight = spreads[x].x.mul(spreads[y].y).mul(fit).toConst() as Float
    const seen = weight.mul(color.w.oneMinus().add(1e-3)).toConst()
    light.addAssign(color.mul(weight))
    first.addAssign(color.mul(fit))
    second.addAssign(color.mul(color).mul(fit))
    sums.addAssign(vec4(weight, fit, about.x.mul(seen), seen))
    const squared = squares[x].x.add(squares[y].y)
    apart.assign(apart.min(fit.greaterThan(0).select(squared, 100)))
    if (x === 0 && y === 0) steps.assign(about.w)
  }
  const isKnown = sums.y.greaterThan(0).toConst()
  // Nothing was marched as far as this pixel sees: what is in front of clouds sees none.
  const none = vec4(0, 0, 0, 1)
  const mean = isKnown.select(first.div(sums.y.max(1)), none).toConst() as Vec4
  const square = second.div(sums.y.max(1))
  const look = apart.mul(frame.block).mul(frame.block).mul(-LOOKING).exp()
  return {
    light: sums.x
      .greaterThan(1e-6)
      .select(light.div(sums.x.max(1e-7)), mean)
      .toConst(),
    mean,
    deviation: isKnown
      .select(square.sub(mean.mul(mean)), vec4(0))
      .max(0)
      .sqrt()
      .toConst(),
    distance: sums.w
      .greaterThan(0)
      .select(sums.z.div(sums.w.max(1e-9)), end)
      .toConst(),
    look: look.max(LEAST_LOOK).toConst(),
    steps
  }
}

/** How far the layers at an altitude have moved since the last frame, or all if none is there [m]. */
function driftAt(field: CloudField, { frame }: SightNodes, altitude: Float): Vec3 {
  const sum = vec4(0).toVar() as Vec4
  forLayers(field, 'driftLayer', index => {
    const { baseAltitude, thickness } = layerAt(field, index)
    const half = thickness.mul(0.5).toConst()
    // Rays that meet nothing are taken to end where they enter the layer: at its very edge.
    const isHere = altitude.sub(baseAltitude).sub(half).abs().lessThan(half.mul(1.1))
    const weight = isHere.select(1, 1e-3)
    sum.addAssign(vec4(frame.driftArray.element(index).xyz, 1).mul(weight))
  })
  return sum.xyz.div(sum.w)
}

/** What the last frame had where the clouds of a pixel were, and how many looks it is worth. */
function remembered(
  field: CloudField,
  sights: SightNodes,
  history: CloudPictures,
  pixel: Vec2,
  direction: Vec3,
  end: Float,
  distance: Float
): { light: Vec4; weight: Float; moved: Float } {
  const { frame } = sights
  const { view } = field
  const offset = direction.mul(exp2(distance)).toConst() as Vec3
  const drift = driftAt(field, sights, view.place(offset).altitude)
  const toPrevious = frame.toPrevious as unknown as Mat4
  const clipped = toPrevious.mul(vec4(offset.sub(drift), 1)).toConst() as Vec4
  const spot = clipped.xy.div(clipped.w.max(1e-6)).mul(vec2(0.5, -0.5)).add(0.5)
  const moved = spot.mul(frame.size).sub(0.5).sub(pixel).toConst() as Vec2
  const isStanding = moved.x.abs().max(moved.y.abs()).lessThan(STANDING)
  const from = pixel
    .add(isStanding.select(vec2(0), moved))
    .add(0.5)
    .toConst() as Vec2
  const isInside = from.clamp(vec2(0), frame.size).equal(from).all().and(clipped.w.greaterThan(0))
  const nearest = from.floor().add(0.5).div(frame.size)
  const about = history.place.sample(nearest).level(0).toConst() as Vec4
  const light = history.light.sample(from.div(frame.size)).level(0).toConst() as Vec4
  // How far off clouds at that distance are from where those of this one were.
  const ratio = exp2(distance.sub(about.x)).sub(1).abs()
  const way = moved.length().toConst() as Float
  const parallax = ratio.mul(way).div(PARALLAX).oneMinus().clamp()
  const valid = isInside.select(fits(end, about), 0).mul(parallax)
  const { gainChange } = frame
  return {
    light: light.mul(vec4(gainChange, gainChange, gainChange, 1)).toConst(),
    moved: way,
    weight: about.z
      .min(frame.memory.mul(way.div(FAST).oneMinus()).max(LEAST_MEMORY))
      .mul(valid)
      .toConst()
  }
}

/** Moves light towards the mean of what is around until it is not too far from there. */
function clip(light: Vec4, { mean, deviation }: Estimate, deviations: Float, slack: Float): Vec4 {
  const difference = light.sub(mean).toConst() as Vec4
  const allowed = deviation.mul(deviations).add(slack)
  const excess = difference.abs().div(allowed).toConst() as Vec4
  const most = excess.x.max(excess.y).max(excess.z.max(excess.w)).max(1)
  return mean.add(difference.div(most))
}

/**
 * Clouds in full resolution, from those marched in this frame and those of the last one: these are looked
 * up where the clouds were, clipped towards what this frame has nearby, and left out where something
 * else was seen.
 *
 * @see Karis 2014, "High quality temporal supersampling"; Salvi 2016 on variance clipping
 */
export function upscale(
  field: CloudField,
  sights: SightNodes,
  marched: CloudPictures,
  history: CloudPictures
): TwoOutputs {
  const { frame } = sights
  return twoOutputs(([light, place]) =>
    Fn(() => {
      const pixel = uv().mul(frame.size).floor().toConst() as unknown as Vec2
      const around = neighbours(sights, marched, pixel)
      const least = around.list.reduce<Float>((most, { color }) => most.min(color.w), float(1))
      const middle = pixel.add(0.5).div(frame.size).toConst() as Vec2
      const before = history.light.sample(middle).level(0).w
      const about = history.place.sample(middle).level(0).toConst() as Vec4
      const isClear = least.greaterThan(CLEAR).and(before.greaterThan(CLEAR))
      // Clear around and clear before: one more look at nothing.
      const looks = about.z.add(frame.block.mul(frame.block).reciprocal())
      light.assign(vec4(0, 0, 0, 1))
      place.assign(vec4(FARTHEST, about.y, looks.min(frame.memory), 0))
      If(isClear.and(frame.hasHistory.greaterThan(0)).not(), () => {
        const { direction, end: distanceEnd } = sightAt(sights, middle)
        const end = encodeDistance(distanceEnd).toConst() as Float
        const now = estimate(sights, marched, around, end)
        const result = now.light.toVar() as Vec4
        const weight = now.look.toVar()
        If(frame.hasHistory.greaterThan(0), () => {
          const last = remembered(field, sights, history, pixel, direction, end, now.distance)
          If(last.weight.greaterThan(0), () => {
            const standing = last.moved.oneMinus().max(0).mul(SLACK.standing)
            const slack = smoothstep(SLACK.young, SLACK.old, last.weight)
              .mul(standing)
              .max(SLACK.moving)
            const clipped = clip(last.light, now, frame.clipping, slack)
            // What is known well does not learn from marched pixels that are not its own.
            const isOwn = now.look.greaterThan(OWN_LOOK).or(last.weight.lessThan(1))
            const look = isOwn.select(now.look, 0).toConst()
            const all = last.weight.add(look).toConst()
            result.assign(mix(clipped, now.light, look.div(all)))
            weight.assign(all.min(frame.memory))
          })
        })
        const noise = interleavedNoise(pixel, frame.noiseShift)
        light.assign(toHalf(result.max(0), noise))
        place.assign(vec4(now.distance, end, weight, now.steps))
      })
      return vec4(0)
    })()
  )
}
